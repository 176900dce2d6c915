"""Random valid scenes, as plain data, and how they are written for granrun."""
import copy
import math
import os
import random

FACES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")
SOURCES = ("none", "paths", "embree", "lines", "shading", "correlation")
ALUMINA = {"density_kg_m3": 3984.0, "specific_heat_J_kgK": 755.0, "conductivity_W_mK": 33.0,
           "youngs_modulus_Pa": 5e6, "real_youngs_modulus_Pa": 414e9, "poisson_ratio": 0.23,
           "restitution": 0.45, "friction": 0.4, "emissivity": 1.0}


TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/correlations/granrad_hard_spheres.toml")


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"%s"' % value
    if isinstance(value, dict):
        return "{" + ", ".join("%s = %s" % (k, toml(v)) for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return repr(value)


def corners(low, high, face):
    """The four corners of a face of a box, its right-hand normal inwards."""
    axis, upper = "xyz".index(face[0]), face.endswith("max")
    a, b = [k for k in range(3) if k != axis]
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points = []
    for i, j in square:
        p = [0.0, 0.0, 0.0]
        p[axis] = high[axis] if upper else low[axis]
        p[a] = high[a] if i else low[a]
        p[b] = high[b] if j else low[b]
        points.append(p)
    # (a, b) is right-handed about +axis for x and z, left-handed for y.
    outwards = upper if axis != 1 else not upper
    return points[::-1] if outwards else points


def generate(seed):
    """One scene; the same seed gives the same scene."""
    r = random.Random(seed)
    d = 10 ** r.uniform(-4, -2.3)
    frozen = r.random() < 0.6
    feed = "file" if frozen else r.choices(["file", "plug", "hopper"], [6, 2, 2])[0]
    size = [d * r.uniform(2.5, 7) for _ in range(3)]
    if feed == "plug":
        size[2] = d * r.uniform(8, 16)
    if feed == "hopper":
        size[2] = d * r.uniform(12, 20)
    low = [0.0] * 3 if r.random() < 0.6 else [r.uniform(-1, 1) for _ in range(3)]
    periodic = [a for a in ("xyz" if feed == "file" else "xy") if r.random() < 0.2]
    source = r.choices(SOURCES, [3, 5, 2, 2, 0, 0] if periodic else [3, 5, 2, 2, 1, 1])[0]
    isothermal = r.random() < 0.15
    first_K = r.choice([300.0, r.uniform(200, 1500)])
    scene = {"seed": seed, "frozen": frozen, "diameter": d, "low": low, "size": size, "periodic": periodic,
             "isothermal": isothermal, "particle_K": first_K, "source": source, "feed": None, "wall_style": "box",
             "gravity": [0.0, 0.0, 0.0], "materials": [dict(ALUMINA)], "gas": None, "particles": [], "remove": [],
             "plates": [], "engine": "none" if frozen else "native", "dem": {}, "surroundings_K": None, "region": None,
             "drop_open": False, "every_steps": None, "recorded": None}
    material(r, scene)
    walls(r, scene)
    if feed == "file":
        plates(r, scene)
        particles(r, scene)
    else:
        scene["feed"] = inflow(r, scene, feed)
        if feed == "hopper" and r.random() < 0.3:  # poured onto a bed of other sizes and materials
            particles(r, scene)
    if r.random() < 0.2:
        region(r, scene)
    if r.random() < 0.15:
        shutter(r, scene)
    if not frozen and feed != "plug":
        scene["gravity"] = r.choice([[0.0, 0.0, 0.0], [0.0, 0.0, -9.81], [1.0, -2.0, -9.0]])
    if not frozen:
        motion(r, scene)
    if r.random() < 0.5:
        scene["gas"] = r.choice([{}, {"conductivity_W_mK": r.uniform(.01, .5), "lens_radius_ratio": r.uniform(1.05, 1.9),
                                      "minimum_gap_m": 10 ** r.uniform(-9, -7)}])
    steps(r, scene)
    return scene


def steps(r, scene):
    frozen, source = scene["frozen"], scene["source"]
    every = 10 ** r.uniform(-3.6, -2) if frozen else 10 ** r.uniform(-4, -3)
    if not frozen:  # so many steps that a scene takes no longer than others
        every = min(every, 300 * scene["diameter"] * math.sqrt(1e-3 / 1))
    scene["every"], scene["rows"] = every, r.randrange(3, 7)
    if not frozen and scene["gas"] is not None and source == "none":
        scene["every_steps"] = 1  # gas lenses are followed at heat steps alone
    scene["conduction"] = {"solid": r.random() < 0.8, "modulus_exponent": r.choice([0.2, 1 / 3])}
    scene["rays"] = {"none": 0, "paths": r.choice([2000, 10000]), "embree": 400, "lines": 2000, "shading": 400,
                     "correlation": 0}[source]
    scene["ray_seed"] = r.randrange(1000)
    scene["radiation_every"] = r.choice([every, every, every / 2, 2 * every, "auto"])
    if not scene["gas"] and not scene["conduction"]["solid"] and source == "none" and frozen:
        scene["conduction"]["solid"] = True


def motion(r, scene):
    """What only moving beds have."""
    if not scene["periodic"] and not scene["plates"]:
        scene["wall_style"] = r.choice(["box", "box", "polygons", "halves", "meshes", "solids"])
    if r.random() < 0.1:
        scene["dem"]["precision"] = "mixed"
    if r.random() < 0.2:
        scene["every_steps"] = 1
    if r.random() < 0.05 and not scene["feed"]:
        scene["engine"] = "liggghts"
    if scene["feed"]:
        return
    faces = [f for f in scene["walls"] if scene["walls"][f].get("contact", True)]
    if faces and r.random() < 0.2:
        face = r.choice(faces)
        speed = [r.uniform(-.1, .1) for _ in range(3)]
        speed["xyz".index(face[0])] = 0.0
        scene["walls"][face]["velocity_m_s"] = speed
    if "z_min" in faces and r.random() < 0.2:  # the floor is open to particles; what falls through is taken out
        scene["walls"]["z_min"]["contact"] = False
        scene["remove"] = [{"below_m": {"axis": "z", "value": scene["low"][2] - r.choice([0.1, 1]) * scene["diameter"]}}]
    elif r.random() < 0.1:
        high = [l + s for l, s in zip(scene["low"], scene["size"])]
        high[0] -= r.uniform(.3, .9) * scene["size"][0]
        scene["remove"] = [{"min_m": list(scene["low"]), "max_m": high}]


def plates(r, scene):
    """A thin plate in the bed, or a patch on a wall, as rectangles across an axis."""
    kind = r.choices(["none", "plate", "patch", "block"], [7, 1, 1, 1])[0]
    if kind == "none" or scene["periodic"]:
        return
    if kind == "block":
        return block(r, scene)
    axis = r.randrange(3)
    low, high = list(scene["low"]), [l + s for l, s in zip(scene["low"], scene["size"])]
    size = scene["size"]
    a, b = [k for k in range(3) if k != axis]
    for k in (a, b):
        low[k], high[k] = low[k] + r.uniform(.1, .3) * size[k], high[k] - r.uniform(.1, .3) * size[k]
    plate = wall_values(r, scene, r.choice(["isothermal", "adiabatic"]))
    if kind == "plate":
        low[axis] = high[axis] = scene["low"][axis] + r.uniform(.3, .7) * size[axis]
        plate["two_sided"] = True
        inwards = 1
    else:
        inwards = r.choice([-1, 1])
        low[axis] = high[axis] = scene["low"][axis] + (0 if inwards > 0 else size[axis])
    scene["plates"] = [{"axis": axis, "inwards": inwards, "low": low, "high": high, "wall": plate}]


def block(r, scene):
    """A closed body among the particles, in the air or on the floor, as six rectangles that face outwards."""
    low, size = scene["low"], scene["size"]
    bottom = [l + r.uniform(.2, .4) * s for l, s in zip(low, size)]
    top = [b + r.uniform(.15, .35) * s for b, s in zip(bottom, size)]
    if r.random() < 0.5:
        bottom[2] = low[2]
    wall = wall_values(r, scene, r.choice(["isothermal", "adiabatic"]))
    for axis in range(3):
        for inwards, place in ((-1, bottom[axis]), (1, top[axis])):
            one = {"axis": axis, "inwards": inwards, "low": list(bottom), "high": list(top), "wall": dict(wall), "solid": True}
            one["low"][axis] = one["high"][axis] = place
            scene["plates"].append(one)
    scene["blocks"] = [(bottom, top)]


def region(r, scene):
    """Heat in a part of the box alone."""
    low, high = list(scene["low"]), [l + s for l, s in zip(scene["low"], scene["size"])]
    for k in range(3):
        if r.random() < 0.5:
            low[k] += r.uniform(0, .4) * scene["size"][k] * r.choice([0, 1])
            high[k] -= r.uniform(0, .4) * scene["size"][k] * r.choice([0, 1])
    scene["region"] = [low, high]
    if scene["source"] != "none":
        scene["surroundings_K"] = around(r, scene)


def around(r, scene):
    return scene["particle_K"] if scene["isothermal"] else r.choice([300.0, r.uniform(100, 1500)])


def shutter(r, scene):
    """A wall that is taken away in the middle, at the start or after the end; s as part of the run."""
    walls = [w for w in list(scene["walls"].values()) + [p["wall"] for p in scene["plates"] if not p.get("solid")]]
    if not walls or not scene["frozen"]:
        return
    wall = r.choice(walls)
    wall["opens"] = r.choice([0.0, r.uniform(0, 1), r.uniform(0, 1), 2.0])
    if scene["source"] != "none":
        scene["surroundings_K"] = scene["surroundings_K"] or around(r, scene)


def rectangle(plate):
    """Corners, counter-clockwise about +axis when inwards > 0, else about -axis."""
    axis = plate["axis"]
    a, b = (axis + 1) % 3, (axis + 2) % 3
    points = []
    for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
        p = list(plate["low"])
        p[a] = plate["high"][a] if i else plate["low"][a]
        p[b] = plate["high"][b] if j else plate["low"][b]
        points.append(p)
    return points if plate["inwards"] > 0 else points[::-1]


def far_from(plate, place, radius):
    apart = [max(l - x, 0.0, x - h) for l, x, h in zip(plate["low"], place, plate["high"])]
    return math.sqrt(sum(v * v for v in apart)) > radius * 1.001


def material(r, scene):
    m = scene["materials"][0]
    m["emissivity"] = r.choice([1.0, 1.0, 1.0, r.uniform(.05, 1), r.uniform(.05, 1), 0.1, 0.0])
    m["restitution"] = r.choice([.45, .1, 1.0, r.uniform(.1, 1)])
    m["friction"] = r.choice([0.0, 0.4, r.random()])
    m["conductivity_W_mK"] = r.choice([33.0, 0.2, 400.0])
    if r.random() < 0.3:
        second = dict(m, name="second", density_kg_m3=r.choice([1000.0, 8000.0]), emissivity=r.uniform(.05, 1),
                      youngs_modulus_Pa=r.choice([1e6, 5e7]), specific_heat_J_kgK=r.uniform(100, 2000))
        scene["materials"].append(second)


def walls(r, scene):
    scene["walls"] = {}
    for face in FACES:
        if face[0] in scene["periodic"]:
            continue
        roles = ["isothermal", "adiabatic", "open"] if scene["source"] != "none" else ["isothermal", "adiabatic"]
        scene["walls"][face] = wall_values(r, scene, r.choice(roles))


def wall_values(r, scene, role):
    wall = {"role": role}
    if role != "adiabatic":
        wall["temperature_K"] = scene["particle_K"] if scene["isothermal"] else r.choice([1000.0, r.uniform(100, 2000)])
    if role != "open" and r.random() < 0.5:
        wall["emissivity"] = r.choice([1.0, .1, r.uniform(.05, 1), 0.0])
    return wall


def particles(r, scene):
    d, low, size = scene["diameter"], scene["low"], scene["size"]
    ratio = 1 if scene["source"] == "shading" else r.choice([1, 1, 1.5, 3, 10])
    wanted = r.choice([1, 2, 3, 8, 8, 20, 40])
    placed = []
    for _ in range(1000):
        if len(placed) == wanted:
            break
        radius = d / 2 * ratio ** r.uniform(-1, 0)
        place = [r.uniform(low[k] + (0 if "xyz"[k] in scene["periodic"] else radius),
                           low[k] + size[k] - (0 if "xyz"[k] in scene["periodic"] else radius)) for k in range(3)]
        if r.random() < 0.6:  # heat by contact needs contacts
            place = touching(r, scene, place, radius, placed)
            if place is None:
                continue
        if not all(far_from(plate, place, radius) for plate in scene["plates"] if plate["wall"].get("two_sided")):
            continue
        if not all(far_from({"low": a, "high": b}, place, radius) for a, b in scene.get("blocks", [])):
            continue
        if any(distance(scene, place, p["place"]) < (radius + p["radius"]) * 0.9994 for p in placed):
            continue
        placed.append({"place": place, "radius": radius, "material": r.randrange(len(scene["materials"])),
                       "T": scene["particle_K"] if scene["isothermal"] else r.choice([scene["particle_K"], r.uniform(250, 1500)]),
                       "v": [r.gauss(0, .02) for _ in range(3)] if not scene["frozen"] and r.random() < .5 else [0.0] * 3})
    scene["particles"] = placed


def touching(r, scene, place, radius, placed):
    """The place moved until it touches a wall or another particle, overlapping by a thousandth; None outside."""
    faces = [face for face in scene["walls"] if scene["walls"][face].get("contact", True)]
    if faces and (not placed or r.random() < 0.5):
        face = r.choice(faces)
        k = "xyz".index(face[0])
        place[k] = scene["low"][k] + (0.999 * radius if face.endswith("min") else scene["size"][k] - 0.999 * radius)
        return place
    if not placed:
        return place
    other = r.choice(placed)
    way = [a - b for a, b in zip(place, other["place"])]
    length = math.sqrt(sum(w * w for w in way)) or 1.0
    apart = 0.9995 * (radius + other["radius"])
    place = [b + w / length * apart for b, w in zip(other["place"], way)]
    for k, axis in enumerate("xyz"):
        room = 0.0 if axis in scene["periodic"] else radius
        if not scene["low"][k] + room <= place[k] <= scene["low"][k] + scene["size"][k] - room:
            return None
    return place


def distance(scene, a, b):
    total = 0
    for k, axis in enumerate("xyz"):
        apart = a[k] - b[k]
        if axis in scene["periodic"]:
            apart = math.remainder(apart, scene["size"][k])
        total += apart * apart
    return math.sqrt(total)


def inflow(r, scene, kind):
    d, low, size = scene["diameter"], scene["low"], scene["size"]
    if kind == "plug":
        for face in ("z_min", "z_max"):
            scene["walls"][face]["contact"] = False
        return {"kind": "plug", "solid_fraction": r.uniform(.02, .45), "velocity_m_s": 10 ** r.uniform(-2, 0),
                "seed": r.randrange(1000), "start_filled": r.random() < 0.7}
    for face in ("z_min", "z_max"):
        scene["walls"][face]["contact"] = False
    feed = {"kind": "hopper", "particle_count": r.choice([1, 5, 30, 60]), "velocity_m_s": r.uniform(0, .5),
            "remove_below_m": low[2] - d * r.choice([1, 3]), "seed": r.randrange(100), "refill": r.random() < .7,
            "fill_region": {"min_m": [low[0], low[1], low[2] + size[2] / 2], "max_m": [low[k] + size[k] for k in range(3)]}}
    if r.random() < 0.4:
        feed["rate_1_s"] = 10 ** r.uniform(2, 4)
    return feed


def write(scene, folder):
    """scene.toml and the files it names."""
    os.makedirs(folder, exist_ok=True)
    lines = []

    def table(name, values):
        lines.append(name)
        lines.extend("%s = %s" % (k, toml(v)) for k, v in values.items())
        lines.append("")

    table("[scene]", {"name": "judge %s" % scene["seed"], "end_time_s": scene["every"] * scene["rows"],
                      "gravity_m_s2": scene["gravity"]})
    table("[material]", scene["materials"][0])
    for extra in scene["materials"][1:]:
        table("[[materials]]", extra)
    if scene["gas"] is not None:
        table("[gas]", scene["gas"])
    first = {"temperature_K": scene["particle_K"]}
    if scene["engine"] != "replay" and (scene["particles"] or not scene["feed"]):
        first["file"] = "bed.csv"
        bed(scene, os.path.join(folder, "bed.csv"))
    if scene["feed"]:
        first["diameter_m"] = scene["diameter"]
    table("[particles]", first)
    if scene["feed"]:
        table("[feed]", scene["feed"])
    box = {"size_m": scene["size"], "origin_m": scene["low"]}
    if scene["periodic"]:
        box["periodic"] = scene["periodic"]
    if scene["wall_style"] != "box":
        box["walls"] = False
    table("[box]", box)
    walls_of(scene, folder, table)
    for k, plate in enumerate(scene["plates"]):
        table("[[polygon]]", dict(properties(scene, plate["wall"]), name="plate%d" % k, vertices_m=rectangle(plate)))
    if scene["region"]:
        table("[region]", {"min_m": scene["region"][0], "max_m": scene["region"][1]})
    for where in scene["remove"]:
        table("[[remove]]", where)
    if scene["surroundings_K"]:
        table("[surroundings]", {"temperature_K": scene["surroundings_K"]})
    if scene["engine"] == "replay":
        table("[dem]", recording(scene, folder))
    else:
        table("[dem]", dict(scene["dem"], engine=scene["engine"]))
    table("[conduction]", dict(scene["conduction"], **({"every_steps": scene["every_steps"]} if scene["every_steps"] else {})))
    if scene["source"] != "none":
        radiation = {"source": scene["source"], "every_s": scene["radiation_every"], "seed": scene["ray_seed"]}
        if scene["source"] == "correlation":
            radiation["table"] = TABLE
        else:
            radiation["rays"] = scene["rays"]
        table("[radiation]", radiation)
    table("[output]", {"every_s": scene["every"], "frames_every_s": scene["every"] * scene["rows"]})
    path = os.path.join(folder, "scene.toml")
    with open(path, "w") as out:
        out.write("\n".join(lines))
    return path


def bed(scene, path):
    with open(path, "w") as out:
        out.write("x,y,z,radius,temperature,vx,vy,vz,material\n")
        for p in scene["particles"]:
            out.write(",".join(repr(float(v)) for v in p["place"] + [p["radius"], p["T"]] + p["v"]) + ",%d\n" % p["material"])


def recording(scene, folder):
    """The bed that rests as a recorded flow of two snapshots; particles in another order in each."""
    end = scene["every"] * scene["rows"]
    faces = ["pp" if axis in scene["periodic"] else "ff" for axis in "xyz"]
    rows = ["%d %d %s" % (k + 1, p["material"] + 1, " ".join(repr(float(v)) for v in p["place"] + [p["radius"], p["T"]]))
            for k, p in enumerate(scene["particles"])]
    for step in (0, 1000):
        with open(os.path.join(folder, "flow.%d.dump" % step), "w") as out:
            out.write("ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS %s\n" % (step, len(rows), " ".join(faces)))
            for low, size in zip(scene["low"], scene["size"]):
                out.write("%r %r\n" % (low, low + size))
            out.write("ITEM: ATOMS id type x y z radius temp\n" + "\n".join(rows) + "\n")
        rows.reverse()
    return {"engine": "replay", "files": "flow.*.dump", "step_s": end / 1000}


def properties(scene, wall):
    """Keys of a wall; its shutter in seconds."""
    keys = {k: v for k, v in wall.items() if k != "opens"}
    if "opens" in wall:
        keys["opens_at_s"] = wall["opens"] * scene["every"] * scene["rows"]
    return keys


def facets(out, name, triangles):
    out.write("solid %s\n" % name)
    for t in triangles:
        out.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %r %r %r\n" % tuple(p) for p in t) +
                  "endloop\nendfacet\n")
    out.write("endsolid %s\n" % name)


def walls_of(scene, folder, table):
    high = [l + s for l, s in zip(scene["low"], scene["size"])]
    order = list(scene["walls"])
    if scene.get("reordered"):
        order.reverse()
    order = [face for face in order if not (scene["drop_open"] and scene["walls"][face]["role"] == "open")]
    if scene["wall_style"] == "solids":
        return solids(scene, folder, table, order, high)
    for face in order:
        wall = properties(scene, scene["walls"][face])
        if scene["wall_style"] == "box":
            table("[walls.%s]" % face, wall)
        elif scene["wall_style"] == "polygons":
            table("[[polygon]]", dict(wall, name=face, vertices_m=corners(scene["low"], high, face)))
        elif scene["wall_style"] == "halves":
            a, b, c, e = corners(scene["low"], high, face)
            ab, ce = [(x + y) / 2 for x, y in zip(a, b)], [(x + y) / 2 for x, y in zip(c, e)]
            table("[[polygon]]", dict(wall, name=face, vertices_m=[a, ab, ce, e]))
            table("[[polygon]]", dict(wall, name=face + "_2", vertices_m=[ab, b, c, ce]))
        else:
            name = face + ".stl"
            a, b, c, e = corners(scene["low"], high, face)
            with open(os.path.join(folder, name), "w") as out:
                facets(out, face, ((a, b, c), (a, c, e)))
            table("[[mesh]]", dict(wall, name=face, file=name))


def solids(scene, folder, table, order, high):
    """All faces as solids of one file, each with its own role."""
    with open(os.path.join(folder, "vessel.stl"), "w") as out:
        for face in order:
            a, b, c, e = corners(scene["low"], high, face)
            facets(out, face, ((a, b, c), (a, c, e)))
    table("[[mesh]]", {"name": "vessel", "file": "vessel.stl", "role": "adiabatic"})
    for face in order:
        table('[mesh.solid."%s"]' % face, properties(scene, scene["walls"][face]))


def changed(scene, **values):
    other = copy.deepcopy(scene)
    other.update(values)
    return other
