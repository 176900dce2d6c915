"""No key of a scene is dead: every key that `granrun keys` lists stands in the table below, with a scene in which it
changes what comes out (history, results, particles, or what check says), or with the reason why it may not.
Usage: scene_keys.py BIN SOURCE
Planted: gas.minimum_gap_m replaced by its default after reading; two_sided read but not done (seen by mesh and polygon).
This found: [mesh.solid] and the box of [[remove]] missing from the keys, every_s listed for compared sources, which refuse
it, and rows of validation.csv broken by the comma in "traced walls".
"""
import concurrent.futures
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

BIN, SOURCE = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
ENVIRONMENT = dict(os.environ, GRANRAD_DATA=str(SOURCE / "data"), OMP_WAIT_POLICY="passive", OMP_NUM_THREADS="1")

MATERIAL = """density_kg_m3 = 2500
specific_heat_J_kgK = 800
conductivity_W_mK = 1.5
youngs_modulus_Pa = 1e6
poisson_ratio = 0.3
restitution = 0.6
friction = 0.4
emissivity = 0.8
"""
WALLS = "".join(f'[walls.{a}_{e}]\nrole = "{r}"\n' for a, r in (("x", "adiabatic"), ("z", "adiabatic")) for e in ("min", "max")) + \
    "".join(f'[walls.y_{e}]\nrole = "isothermal"\ntemperature_K = {t}\n' for e, t in (("min", 900), ("max", 1000)))
HEAT = """[conduction]
solid = true
[gas]
conductivity_W_mK = 0.05
[radiation]
source = "paths"
rays = 200
"""
END = "[output]\nevery_s = 0.005\n"

# Six grains that fall on the floor of a box; one of them rolls along it.
BED = "id,x,y,z,radius,vx,material\n" + "".join(
    f"{k},{x},{y},{z},0.0005,{v},0\n" for k, (x, y, z, v) in enumerate(
        [(.001, .001, .0005, .05), (.003, .001, .00052, 0), (.0011, .003, .0005, 0), (.003, .003, .0006, 0), (.003, .00199, .0005, 0), (.001, .00398, .0005, 0)], 1))
FALLING = f"""[scene]
name = "falling"
end_time_s = 0.02
gravity_m_s2 = [0, 0, -9.81]
[material]
name = "one"
{MATERIAL}
[particles]
file = "bed.csv"
temperature_K = 400
[box]
size_m = [0.004, 0.005, 0.006]
{WALLS}
[dem]
step_s = 2e-5
{HEAT}{END}"""

PLUG = f"""[scene]
end_time_s = 0.03
[material]
{MATERIAL}
[particles]
diameter_m = 0.001
temperature_K = 400
[box]
size_m = [0.004, 0.005, 0.006]
{WALLS}
[feed]
kind = "plug"
solid_fraction = 0.2
velocity_m_s = 0.1
[dem]
step_s = 2e-5
{HEAT}{END}"""

HOPPER = f"""[scene]
end_time_s = 0.12
gravity_m_s2 = [0, 0, -9.81]
[material]
{MATERIAL}
[particles]
diameter_m = 0.001
temperature_K = 400
[box]
size_m = [0.004, 0.005, 0.012]
{WALLS}
[feed]
kind = "hopper"
particle_count = 20
remove_below_m = -0.001
[surroundings]
temperature_K = 300
[feed.fill_region]
min_m = [0, 0, 0.004]
max_m = [0.004, 0.005, 0.012]
[dem]
step_s = 2e-5
{HEAT}{END}"""

# A frozen bed in a box of its own walls, with a plate across it and a block of two solids on the floor.
FROZEN = f"""[scene]
end_time_s = 0.05
[material]
name = "one"
{MATERIAL}
[particles]
file = "bed.csv"
temperature_K = 400
[box]
size_m = [0.004, 0.005, 0.006]
{WALLS}
[[polygon]]
name = "plate"
vertices_m = [[0, 0, 0.004], [0.004, 0, 0.004], [0.004, 0.003, 0.004], [0, 0.003, 0.004]]
role = "isothermal"
temperature_K = 700
two_sided = true
[[mesh]]
name = "lids"
file = "lids.stl"
role = "isothermal"
temperature_K = 600
two_sided = true
[dem]
engine = "none"
[gas]
conductivity_W_mK = 0.05
[radiation]
source = "paths"
rays = 2000
{END}"""


def square(name, x0, x1, turn=False):
    corners = [(x0, 0.0035, 0.005), (x1, 0.0035, 0.005), (x1, 0.005, 0.005), (x0, 0.005, 0.005)]
    faces = [(0, 2, 1), (0, 3, 2)] + ([(0, 1, 2), (0, 2, 3)] if turn else [])
    text = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*corners[k]) for k in face) + "endloop\nendfacet\n" for face in faces)
    return f"solid {name}\n{text}endsolid {name}\n"


def edited(text, changes):
    for table, lines in changes:
        head = f"\n[{table}]\n"
        if head not in "\n" + text:
            text += head[1:]
        at = ("\n" + text).index(head) + len(head) - 1
        end = re.compile(r"^\[", re.M).search(text, at)
        body, after = text[at:end.start() if end else len(text)], text[end.start() if end else len(text):]
        if not lines:
            text = text[:at - len(head) + 1] + after
            continue
        for line in lines.split("\n"):
            key = line.split("=")[0].strip()
            body = re.sub(rf"^{key} = .*\n", "", body, flags=re.M) + ("" if line.endswith("= ") else line + "\n")
        text = text[:at] + body + after
    return text


HOPPER = edited(HOPPER, [("walls.z_min", "opens_at_s = 0.06")])
STILL = edited(FALLING, [("scene", "gravity_m_s2 = "), ("dem", 'engine = "none"\nstep_s = '), ("conduction", "solid = false")])
BEDS = {"still": STILL, "falling": FALLING, "plug": PLUG, "hopper": HOPPER, "frozen": FROZEN}
TABLES = SOURCE / "data/correlations"
TABLE = ("radiation", f'source = "correlation"\ntable = "{TABLES}/granrad_hard_spheres.toml"\nrays = ')
REFIT = f'table = "{TABLES}/li_2024_refit.toml"'
LINES = ("radiation", 'source = "lines"\nrays = 2000')
ROUGH = ("conduction", 'contact_law = "rough"\nmicrohardness_Pa = 1e9\nroughness_m = 1e-6\nasperity_slope = 0.1')
TWO = ("[materials]", 'name = "two"\n' + MATERIAL)
MIXED = [TWO, ("particles", 'file = "mixed.csv"')]
TYPED = [TWO, ("[materials]", "density_kg_m3 = 3000"), ("particles", 'file = "types.dump"\ntypes = ["one", "two"]')]
POURED = [("feed", "rate_1_s = 400")]
RECORDED = [("dem", 'engine = "replay"\nfiles = "flow.*.dump"\nstep_s = '), ("scene", "end_time_s = 0.02"), ("particles", "file = "), ("particles", "diameter_m = 0.001")]
LADDER = [("validate", "times_s = [0.01]"), ("validate.reference", 'source = "paths"\nrays = 500'), ("[validate.compare]", 'source = "paths"\nrays = 100')]

# table and key: (scene, what is needed besides, what changes), or why nothing needs to change. A change is (table, lines);
# "[name]" is [[name]]; a line "key = " takes the key away.
KEYS = {
    "scene.name": ("falling", [], [("scene", 'name = "another"')]),
    "scene.end_time_s": ("falling", [], [("scene", "end_time_s = 0.01")]),
    "scene.gravity_m_s2": ("falling", [], [("scene", "gravity_m_s2 = [0, 1, -9.81]")]),
    "material.file": ("plug", [], [("material", 'file = "alumina.toml"\ndensity_kg_m3 = ')]),
    "material.name": ("falling", TYPED, [("material", 'name = "two"'), ("[materials]", 'name = "one"')]),
    "material.emissivity": ("falling", [], [("material", "emissivity = 0.3")]),
    "material.real_youngs_modulus_Pa": ("falling", [], [("material", "real_youngs_modulus_Pa = 1e10")]),
    "materials[].file": ("falling", MIXED, [("[materials]", 'file = "alumina.toml"\ndensity_kg_m3 = ')]),
    "materials[].name": ("falling", TYPED, [("[materials]", 'name = "one"'), ("material", 'name = "two"')]),
    "feed.kind": ("plug", [], [("feed.fill_region", "min_m = [0, 0, 0]\nmax_m = [0.004, 0.005, 0.006]"), ("feed", 'kind = "hopper"\nsolid_fraction = \nvelocity_m_s = \nparticle_count = 5')]),
    "feed.mass_flow_kg_s": ("plug", [], [("feed", "mass_flow_kg_s = 0.002\nvelocity_m_s = ")]),
    "feed.start_filled": ("plug", [], [("feed", "start_filled = false")]),
    "feed.refill": ("hopper", [], [("feed", "refill = false")]),
    "feed.rate_1_s": ("hopper", POURED, [("feed", "rate_1_s = 200")]),
    "feed.rate_kg_s": ("hopper", [("feed", "rate_kg_s = 1e-3")], [("feed", "rate_kg_s = 5e-4")]),
    "feed.mass_kg": ("hopper", [("feed", "particle_count = \nmass_kg = 2e-5")], [("feed", "mass_kg = 1e-5")]),
    "feed.remove_below_m": ("hopper", [], [("feed", "remove_below_m = -0.004")]),
    "feed.fill_region.min_m": ("hopper", [], [("feed.fill_region", "min_m = [0.0005, 0, 0.004]")]),
    "feed.fill_region.max_m": ("hopper", [], [("feed.fill_region", "max_m = [0.0035, 0.005, 0.012]")]),
    "dem.engine": ("falling", [], [("dem", 'engine = "none"\nstep_s = ')]),
    "dem.precision": ("falling", [], [("dem", 'precision = "mixed"')]),
    "dem.files": ("falling", RECORDED, [("dem", 'files = "other.*.dump"')]),
    "dem.between": ("falling", RECORDED, [("dem", 'between = "interpolated"')]),
    "particles.file": ("falling", [], [("particles", 'file = "one.csv"')]),
    "particles.types": ("falling", TYPED, [("particles", 'types = ["two", "one"]')]),
    "radiation.source": ("falling", [], [("radiation", 'source = "embree"')]),
    "radiation.table": ("plug", [TABLE], [("radiation", REFIT)]),
    "radiation.wall_rows": ("plug", [TABLE], [("radiation", 'wall_rows = "traced"')]),
    "radiation.order": ("still", [LINES], [("radiation", "order = 2")]),
    "radiation.wall_patches": ("still", [LINES], [("radiation", 'wall_patches = "whole"')]),
    "radiation.error": ("still", [("radiation", 'rays = "auto"\nerror = 0.05')], [("radiation", "error = 0.3")]),
    "radiation.closure": ("still", [LINES], [("radiation", 'closure = "row_sum"')]),
    "box.origin_m": ("plug", [], [("box", "origin_m = [0.001, 0, 0]")]),
    "box.size_m": ("plug", [], [("box", "size_m = [0.005, 0.005, 0.006]")]),
    "box.periodic": ("plug", [("walls.x_min", ""), ("walls.x_max", ""), ("radiation", 'source = "none"')], [("box", 'periodic = ["x"]')]),
    "box.walls": ("frozen", [("radiation", 'source = "none"'), *[(f"walls.{a}_{e}", "") for a in "xyz" for e in ("min", "max")]], [("box", "walls = false")]),
    "walls.*.role": ("frozen", [], [("walls.x_min", 'role = "isothermal"\ntemperature_K = 500')]),
    "walls.*.emissivity": ("frozen", [], [("walls.y_min", "emissivity = 0.2")]),
    "walls.*.contact": ("falling", [], [("walls.z_min", "contact = false")]),
    "walls.*.velocity_m_s": ("falling", [], [("walls.z_min", "velocity_m_s = [0.1, 0, 0]")]),
    "walls.*.opens_at_s": ("hopper", [], [("walls.z_min", "opens_at_s = 0.08")]),
    "walls.*.temperature_K": ("frozen", [], [("walls.y_min", "temperature_K = 500")]),
    "polygon[].name": ("frozen", [], [("[polygon]", 'name = "sheet"')]),
    "polygon[].vertices_m": ("frozen", [], [("[polygon]", "vertices_m = [[0, 0, 0.004], [0.004, 0, 0.004], [0.004, 0.002, 0.004], [0, 0.002, 0.004]]")]),
    "polygon[].flip": ("frozen", [("[polygon]", "two_sided = false")], [("[polygon]", "flip = true")]),
    "polygon[].role": ("frozen", [], [("[polygon]", 'role = "adiabatic"\ntemperature_K = ')]),
    "polygon[].emissivity": ("frozen", [], [("[polygon]", "emissivity = 0.2")]),
    "polygon[].two_sided": ("frozen", [], [("[polygon]", "two_sided = false")]),
    "polygon[].temperature_K": ("frozen", [], [("[polygon]", "temperature_K = 500")]),
    "mesh[].name": ("frozen", [], [("[mesh]", 'name = "covers"')]),
    "mesh[].scale": ("frozen", [], [("[mesh]", "scale = 0.99")]),
    "mesh[].file": ("frozen", [], [("[mesh]", 'file = "one_lid.stl"')]),
    "mesh[].flip": ("frozen", [("[mesh]", "two_sided = false")], [("[mesh]", "flip = true")]),
    "mesh[].role": ("frozen", [], [("[mesh]", 'role = "adiabatic"\ntemperature_K = ')]),
    "mesh[].emissivity": ("frozen", [], [("[mesh]", "emissivity = 0.2")]),
    "mesh[].two_sided": ("frozen", [], [("[mesh]", "two_sided = false")]),
    "mesh[].temperature_K": ("frozen", [], [("[mesh]", "temperature_K = 500")]),
    "mesh[].solid.NAME.role": ("frozen", [], [("mesh.solid.left", 'role = "adiabatic"')]),
    "mesh[].solid.NAME.emissivity": ("frozen", [], [("mesh.solid.left", "emissivity = 0.2")]),
    "mesh[].solid.NAME.temperature_K": ("frozen", [], [("mesh.solid.left", "temperature_K = 500")]),
    "region.min_m": ("still", [("surroundings", "temperature_K = 300")], [("region", "min_m = [0.0015, 0, 0]")]),
    "region.max_m": ("still", [("surroundings", "temperature_K = 300")], [("region", "max_m = [0.0025, 0.005, 0.006]")]),
    "remove[].min_m": ("falling", [("[remove]", "min_m = [0.0026, 0, 0]\nmax_m = [0.004, 0.0015, 0.002]")], [("[remove]", "min_m = [0, 0, 0]")]),
    "remove[].max_m": ("falling", [("[remove]", "min_m = [0.0026, 0, 0]\nmax_m = [0.004, 0.0015, 0.002]")], [("[remove]", "max_m = [0.004, 0.005, 0.002]")]),
    "remove[].below_m.axis": ("falling", [("[remove]", 'below_m = {axis = "x", value = 0.0012}')], [("[remove]", 'below_m = {axis = "y", value = 0.0012}')]),
    "remove[].below_m.value": ("falling", [("[remove]", 'below_m = {axis = "x", value = 0.0012}')], [("[remove]", 'below_m = {axis = "x", value = 0.00105}')]),
    "conduction.solid": ("falling", [], [("conduction", "solid = false")]),
    "conduction.modulus_exponent": ("falling", [("material", "real_youngs_modulus_Pa = 1e10")], [("conduction", "modulus_exponent = 0.5")]),
    "conduction.contact_law": ("falling", [], [ROUGH]),
    "conduction.every_steps": ("falling", [], [("conduction", "every_steps = 2")]),
    "conduction.microhardness_Pa": ("falling", [ROUGH], [("conduction", "microhardness_Pa = 5e9")]),
    "conduction.roughness_m": ("falling", [ROUGH], [("conduction", "roughness_m = 5e-6")]),
    "conduction.asperity_slope": ("falling", [ROUGH], [("conduction", "asperity_slope = 0.2")]),
    "conduction.accommodation": ("falling", [ROUGH], [("conduction", "accommodation = 0.5")]),
    "conduction.mean_free_path_m": ("falling", [ROUGH], [("conduction", "mean_free_path_m = 5e-7")]),
    "gas.conductivity_W_mK": ("falling", [], [("gas", "conductivity_W_mK = 0.1")]),
    "gas.lens_radius_ratio": ("falling", [], [("gas", "lens_radius_ratio = 1.4")]),
    "gas.minimum_gap_m": ("falling", [], [("gas", "minimum_gap_m = 1e-6")]),
    "surroundings.temperature_K": ("still", [("surroundings", "temperature_K = 300"), ("region", "min_m = [0.0015, 0, 0]")],
                                   [("surroundings", "temperature_K = 600")]),
    "output.every_s": ("falling", [], [("output", "every_s = 0.004")]),
    "output.frames_every_s": ("falling", [], [("output", "frames_every_s = 0.005")]),
    "output.average_from_s": ("falling", [], [("output", "average_from_s = 0.005")]),
    "validate.times_s": ("still", LADDER, [("validate", "times_s = [0.02]")]),
    "validate.snapshot[].file": ("still", LADDER + [("[validate.snapshot]", 'file = "bed.csv"')], [("[validate.snapshot]", 'file = "one.csv"')]),
    "validate.compare[].ladder": ("still", LADDER, [("[validate.compare]", "rays = \nladder = [100, 200]")]),
}


def add_rows_that_are_alike():
    for name, value in (("density_kg_m3", 2000), ("specific_heat_J_kgK", 500), ("conductivity_W_mK", 0.7), ("youngs_modulus_Pa", 2e6), ("poisson_ratio", 0.2),
                        ("restitution", 0.3), ("friction", 0.1), ("rolling_friction", 0.2), ("emissivity", 0.2), ("real_youngs_modulus_Pa", 1e10)):
        KEYS.setdefault(f"material.{name}", ("falling", [], [("material", f"{name} = {value}")]))
        KEYS[f"materials[].{name}"] = ("falling", MIXED, [("[materials]", f"{name} = {value}")])
    for name, value in (("seed", 2), ("solid_fraction", 0.1), ("velocity_m_s", 0.2), ("transverse_velocity_std_m_s", 0.05)):
        KEYS[f"feed.{name}"] = ("plug", [], [("feed", f"{name} = {value}")])
    KEYS["feed.particle_count"] = ("hopper", [], [("feed", "particle_count = 10")])
    KEYS["dem.step_s"] = ("falling", [], [("dem", "step_s = 1e-5")])
    for name, value in (("temperature_K", 350), ("diameter_m", 0.0009)):
        KEYS[f"particles.{name}"] = ("plug", [], [("particles", f"{name} = {value}")])
    for name, value in (("rays", 100), ("seed", 5), ("every_s", 0.005)):
        KEYS[f"radiation.{name}"] = ("plug", [], [("radiation", f"{name} = {value}")])
    for kind, table in (("polygon[]", "[polygon]"), ("mesh[]", "[mesh]"), ("mesh[].solid.NAME", "mesh.solid.left")):
        for name, value in (("contact", "false"), ("velocity_m_s", "[0.2, 0, 0]"), ("opens_at_s", "0.001")):
            low = [("[polygon]", "vertices_m = [[0, 0, 0.00002], [0.004, 0, 0.00002], [0.004, 0.005, 0.00002], [0, 0.005, 0.00002]]"), ("[mesh]", 'file = "floor.stl"'),
                   ("dem", 'engine = "native"\nstep_s = 2e-5'), ("scene", "gravity_m_s2 = [0, 0, -9.81]\nend_time_s = 0.02"), ("radiation", 'source = "none"')]
            KEYS[f"{kind}.{name}"] = ("frozen", low[:1] + low[2:] if kind == "polygon[]" else low[1:], [(table, f"{name} = {value}")])
    for kind, table in (("walls.*", "walls.y_min"), ("polygon[]", "[polygon]"), ("mesh[]", "[mesh]"), ("mesh[].solid.NAME", "mesh.solid.left")):
        warming = [(table, "temperature_K = \ntimes_s = [0, 0.1]\ntemperatures_K = [900, 1000]")]
        for name, value in (("times_s", "[0, 0.01]"), ("temperatures_K", "[900, 1500]")):
            KEYS[f"{kind}.{name}"] = ("frozen", warming, [(table, f"{name} = {value}")])
    for which, table in (("reference", "validate.reference"), ("compare[]", "[validate.compare]")):
        for name, needed, change in (("source", "", 'source = "embree"'), ("rays", "", "rays = 200"), ("seed", "", "seed = 7"),
                                     ("order", 'source = "lines"\nrays = 500', "order = 1"), ("closure", 'source = "lines"\nrays = 500', 'closure = "row_sum"'),
                                     ("wall_patches", 'source = "lines"\nrays = 500', 'wall_patches = "whole"'),
                                     ("table", TABLE[1], REFIT), ("wall_rows", TABLE[1], 'wall_rows = "traced"')):
            plug = name in ("table", "wall_rows")  # a bed of stated solid fraction
            besides = LADDER + ([(table, needed)] if needed else []) + ([("dem", 'engine = "none"\nstep_s = '), ("conduction", "solid = ")] if plug else [])
            KEYS[f"validate.{which}.{name}"] = ("plug" if plug else "still", besides, [(table, change)])
        KEYS[f"validate.{which}.error"] = "with rays = \"auto\" only, which is refused there"


add_rows_that_are_alike()


def inputs(folder):
    rows = BED.splitlines()
    files = {"bed.csv": BED, "one.csv": "\n".join(rows[:2]) + "\n", "mixed.csv": "\n".join(r[:-1] + "1" if k and k % 2 else r for k, r in enumerate(rows)) + "\n",
             "lids.stl": square("left", 0, 0.002) + square("right", 0.002, 0.004), "one_lid.stl": square("left", 0, 0.002)}
    files["floor.stl"] = re.sub(r"0\.005\n", "0.00002\n", files["lids.stl"].replace("0.0035", "0"))
    for name, step in (("flow", 1e-4), ("other", 2e-4)):
        for k in range(3):
            files[f"{name}.{k}.dump"] = f"ITEM: TIMESTEP\n{k * 500}\nITEM: TIME\n{k * 0.01}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 0.004\n0 0.005\n0 0.006\n" \
                f"ITEM: ATOMS id type x y z radius\n1 1 0.001 0.001 {0.002 + k * step} 0.0005\n2 1 0.003 0.003 0.003 0.0005\n"
    files["types.dump"] = files["flow.0.dump"].replace("\n2 1 ", "\n2 2 ")
    for name, text in files.items():
        (folder / name).write_text(text)


def outcome(scene, validate):
    """Exit code and everything a scene gives but the time it took."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        inputs(folder)
        (folder / "s.toml").write_text(scene)
        command = [BIN / "granrun", "validate" if validate else "run", "s.toml", "-o", "out", "-q"]
        done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True)
        if done.returncode:
            return done.returncode, done.stdout + done.stderr
        if validate:
            rows = list(csv.DictReader(open(folder / "out/validation.csv")))
            assert all(None not in row for row in rows), (folder / "out/validation.csv").read_text()
            return 0, [{k: v for k, v in row.items() if "seconds" not in k} for row in rows]
        subprocess.run([BIN / "granrun", "export", "out", "--to", "csv", "-q"], cwd=folder, env=ENVIRONMENT, check=True, capture_output=True)
        particles = {str(p.relative_to(folder)): p.read_text() for p in folder.glob("out/**/*.csv") if p.name != "walls.csv"}
        return 0, particles, json.loads((folder / "out/results.json").read_text())


def listed():
    """Keys as `granrun keys --schema` has them: table.key, [] for a list, * for a face, NAME for a name."""
    schema = json.loads(subprocess.run([BIN / "granrun", "keys", "--schema"], capture_output=True, text=True, check=True).stdout)

    def walk(path, node):
        for name, value in node.get("properties", {}).items():
            items = value.get("items", {})
            if "properties" in value or "additionalProperties" in value and value.get("type") == "object":
                yield from walk([*path, name], value)
            elif value.get("type") == "array" and "properties" in items:
                yield from walk([*path, name + "[]"], items)
            else:
                yield ".".join([*path, name])
        if isinstance(node.get("additionalProperties"), dict):
            yield from walk([*path, "NAME" if path and path[-1] == "solid" else "*"], node["additionalProperties"])

    return sorted(set(walk([], schema)))


def fault_of(key):
    entry = KEYS.get(key)
    if entry is None:
        return f"{key}: not in the table of {pathlib.Path(__file__).name}: give a scene in which it changes something"
    if isinstance(entry, str):
        return None
    scene, besides, change = entry
    before = edited(BEDS[scene], besides)
    after = edited(before, change)
    validate = key.startswith("validate.")
    first, second = outcome(before, validate), outcome(after, validate)
    if (first[0] or second[0]) and not key.endswith(("flip", "two_sided")):  # a sheet seen from behind is refused
        return f"{key}: exit {first[0]} and {second[0]}: {first[1] if first[0] else ''}{second[1] if second[0] else ''}"
    return f"{key}: nothing changes" if first == second else None


def main():
    keys = [k for k in listed() if len(sys.argv) < 4 or re.search(sys.argv[3], k)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        faults = [fault for fault in pool.map(fault_of, keys) if fault]
    if len(sys.argv) < 4:
        faults += [f"{key}: in the table, but no scene has it" for key in set(KEYS) - set(keys)]
    print("\n".join(faults) or f"each of {len(keys)} keys changes something")
    return bool(faults)


sys.exit(main())
