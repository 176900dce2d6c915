"""The same physics written in another way: each gives a scene and what its heats must be multiplied by.

A variant is (name, scene, factor of heats, map of wall names, order of particles by the first scene's)."""
import copy

from scenes import FACES, changed


def same_walls():
    return {face: face for face in FACES}


def moved(scene):
    other = copy.deepcopy(scene)
    shift = [0.125, -0.25, 0.5]
    other["low"] = [a + b for a, b in zip(scene["low"], shift)]
    for p in other["particles"]:
        p["place"] = [a + b for a, b in zip(p["place"], shift)]
    for plate in other["plates"]:
        for end in ("low", "high"):
            plate[end] = [a + b for a, b in zip(plate[end], shift)]
    if scene["region"]:
        other["region"] = [[a + b for a, b in zip(corner, shift)] for corner in scene["region"]]
    return "moved", other, 1, same_walls()


def mirrored(scene):
    other = copy.deepcopy(scene)
    middle = scene["low"][0] + scene["size"][0] / 2
    for p in other["particles"]:
        p["place"][0] = 2 * middle - p["place"][0]
        p["v"][0] = -p["v"][0]
    other["gravity"][0] = -scene["gravity"][0]
    for plate in other["plates"]:
        plate["low"][0], plate["high"][0] = 2 * middle - plate["high"][0], 2 * middle - plate["low"][0]
        if plate["axis"] == 0:
            plate["inwards"] = -plate["inwards"]
    if scene["region"]:
        first, last = other["region"]
        first[0], last[0] = 2 * middle - scene["region"][1][0], 2 * middle - scene["region"][0][0]
    walls = same_walls()
    walls["x_min"], walls["x_max"] = "x_max", "x_min"
    other["walls"] = {walls[face]: wall for face, wall in scene["walls"].items()}
    return "mirrored", other, 1, walls


def turned(scene):
    """By 90 degrees about (1, 1, 1): x to y to z to x."""
    other = copy.deepcopy(scene)
    turn = lambda v: [v[2], v[0], v[1]]
    other["low"], other["size"] = turn(scene["low"]), turn(scene["size"])
    for p in other["particles"]:
        p["place"], p["v"] = turn(p["place"]), turn(p["v"])
    other["gravity"] = turn(scene["gravity"])
    for plate in other["plates"]:
        plate["low"], plate["high"] = turn(plate["low"]), turn(plate["high"])
        plate["axis"] = (plate["axis"] + 1) % 3
    if scene["region"]:
        other["region"] = [turn(corner) for corner in scene["region"]]
    follows = {"x": "y", "y": "z", "z": "x"}
    walls = {face: follows[face[0]] + face[1:] for face in FACES}
    other["walls"] = {walls[face]: wall for face, wall in scene["walls"].items()}
    other["periodic"] = [follows[a] for a in scene["periodic"]]
    return "turned", other, 1, walls


def larger(scene):
    """Ten times in length, with c / 10 and k x 10: every heat is 100 times, every temperature the same; with ten times the
    speeds and a hundred times the stiffness every collision takes as long."""
    other = copy.deepcopy(scene)
    for key in ("low", "size"):
        other[key] = [10 * v for v in scene[key]]
    other["diameter"] *= 10
    for p in other["particles"]:
        p["place"], p["radius"] = [10 * v for v in p["place"]], 10 * p["radius"]
        p["v"] = [10 * v for v in p["v"]]
    other["gravity"] = [10 * v for v in scene["gravity"]]
    for plate in other["plates"]:
        plate["low"], plate["high"] = [10 * v for v in plate["low"]], [10 * v for v in plate["high"]]
    if scene["region"]:
        other["region"] = [[10 * v for v in corner] for corner in scene["region"]]
    for m in other["materials"]:
        m["specific_heat_J_kgK"] /= 10
        m["conductivity_W_mK"] *= 10
        m["youngs_modulus_Pa"] *= 100
        m["real_youngs_modulus_Pa"] *= 100
    if other["gas"] is not None:
        other["gas"] = dict(other["gas"], conductivity_W_mK=10 * other["gas"].get("conductivity_W_mK", 0.026),
                            minimum_gap_m=10 * other["gas"].get("minimum_gap_m", 2.75e-8))
    return "larger", other, 100, same_walls()


def doubled(scene):
    """Two periods instead of one along the first periodic axis."""
    axis = "xyz".index(scene["periodic"][0])
    other = copy.deepcopy(scene)
    other["size"][axis] *= 2
    if scene["region"]:
        other["region"][1][axis] += scene["size"][axis]
    for p in copy.deepcopy(scene["particles"]):
        p["place"][axis] += scene["size"][axis]
        other["particles"].append(p)
    other["rays"] = scene["rays"] * (2 if scene["source"] == "paths" else 1)
    if scene["engine"] == "native":  # a higher box lets spheres fall faster, and the step follows
        other["dem"] = dict(scene["dem"], step_s=scene.get("step_s", scene["every"]))
    return "doubled", other, 2, same_walls()


def slid(scene):
    """All particles along the first periodic axis, some of them given in another period."""
    axis = "xyz".index(scene["periodic"][0])
    other, period = copy.deepcopy(scene), scene["size"][axis]
    for k, p in enumerate(other["particles"]):
        p["place"][axis] += (0.37 + k % 3 - 1) * period
    return "slid", other, 1, same_walls()


def alone(scene):
    """Without the particles outside the region, which take no part."""
    low, high = scene["region"]
    inside = [p for p in scene["particles"] if all(l <= x <= h for l, x, h in zip(low, p["place"], high))]
    return "alone", changed(scene, particles=inside), 1, same_walls()


def replayed(scene):
    """The bed at rest as a recorded flow in which nothing moves."""
    return "replayed", changed(scene, engine="replay"), 1, same_walls()


def finer(scene):
    """A third of the step that the program chose, and heat at every step."""
    step = scene.get("step_s", scene["every"]) / 3  # that of the first run, where there was one
    return "finer", changed(scene, dem=dict(scene["dem"], step_s=step), every_steps=1), 1, same_walls()


def unshuttered(scene):
    """Walls that open after the end never open, and walls that are open at the start are not there."""
    other = copy.deepcopy(scene)
    for wall in list(other["walls"].values()) + [plate["wall"] for plate in other["plates"]]:
        if wall.get("opens", 0.0) > 1:
            del wall["opens"]
    other["plates"] = [plate for plate in other["plates"] if plate["wall"].get("opens") != 0]
    gone = [face for face, wall in other["walls"].items() if wall.get("opens") == 0]
    if gone:
        other["wall_style"] = "polygons"
        other["walls"] = {face: wall for face, wall in other["walls"].items() if face not in gone}
    return "unshuttered", other, 1, same_walls()


def as_solids(scene):
    return "solids", changed(scene, wall_style="solids"), 1, same_walls()


def as_walls(style):
    def variant(scene):
        return style, changed(scene, wall_style=style), 1, same_walls()
    return variant


def reordered(scene):
    return "reordered", changed(scene, wall_style="polygons", reordered=True), 1, same_walls()


def renumbered(scene):
    """The particles in another order: compared by their numbers in the first scene."""
    return "renumbered", changed(scene, particles=scene["particles"][::-1]), 1, same_walls()


def opened(scene):
    """Open faces left away: rays meet the surroundings instead."""
    warm = {w["temperature_K"] for w in scene["walls"].values() if w["role"] == "open"}
    return "opened", changed(scene, wall_style="polygons", surroundings_K=warm.pop(), drop_open=True), 1, same_walls()


def by(source, rays):
    def variant(scene):
        return source, changed(scene, source=source, rays=rays), 1, same_walls()
    return variant


def can_be_opened(scene):
    warm = {w["temperature_K"] for w in scene["walls"].values() if w["role"] == "open"}
    # A patch on an open face would end in the air: another gas lens and another contact at its edges.
    return len(warm) == 1 and not scene["plates"] and not scene["surroundings_K"] and scene["source"] not in ("lines", "correlation")


def few_bodies(scene):
    """Moving beds are chaotic, but not two or three spheres within a few collisions."""
    return 0 < len(scene["particles"]) <= 2 and scene["engine"] == "native" and scene["source"] == "none" \
        and not scene["remove"] and not scene["feed"] and scene["dem"].get("precision") is None \
        and not any("velocity_m_s" in wall for wall in scene["walls"].values())


def variants(scene):
    """Those that this scene allows. Moving beds are chaotic: only frozen ones have the same heats."""
    if few_bodies(scene):
        walls = [doubled, slid] if scene["periodic"] else [as_walls("polygons"), as_walls("halves"), as_walls("meshes"),
                                                           as_solids, reordered]
        if scene["region"]:
            walls = []
        return [make(scene) for make in [moved, mirrored, turned, larger, finer] + walls]
    if not scene["frozen"] or scene["feed"] or not scene["particles"]:
        return []
    all_of_them = [moved, mirrored, turned, larger, renumbered]
    if len(scene["materials"]) == 1 or scene["particles"]:
        all_of_them.append(replayed)
    if scene["periodic"]:
        all_of_them += periodic_ones(scene)
    else:
        all_of_them += [as_walls("polygons"), reordered, as_walls("halves")]
        if scene["source"] != "lines":
            all_of_them.append(as_walls("meshes"))
            all_of_them.append(as_solids)
    # a table is read by the solid fraction of the region, in which parts of those outside count
    if scene["region"] and alone(scene)[1]["particles"] and scene["source"] != "correlation":
        all_of_them.append(alone)
    if any(wall.get("opens", 1) in (0.0, 2.0) for wall in walls_and_plates(scene)):
        all_of_them.append(unshuttered)
    if can_be_opened(scene):
        all_of_them.append(opened)
    if scene["source"] not in ("none", "correlation"):
        others = [("paths", 10000), ("embree", 1000), ("lines", 4000)]
        if len({p["radius"] for p in scene["particles"]}) == 1 and not scene["periodic"]:
            others.append(("shading", 1000))
        all_of_them += [by(s, n) for s, n in others if s != scene["source"]]
    return [make(scene) for make in all_of_them]


def walls_and_plates(scene):
    return list(scene["walls"].values()) + [plate["wall"] for plate in scene["plates"]]


def periodic_ones(scene):
    """Where the region spans the period."""
    axis = "xyz".index(scene["periodic"][0])
    low, high = scene["region"] or (scene["low"], [l + s for l, s in zip(scene["low"], scene["size"])])
    return [doubled, slid] if high[axis] - low[axis] == scene["size"][axis] or not scene["region"] else []
