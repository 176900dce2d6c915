"""What must hold whatever the scene is: each raises a Finding."""
import collections
import math

import scenes

SIGMAS = 5.0       # of the stated error; the joint chance of a false alarm in 10 000 scenes is below 1 %
SYSTEMATIC = 0.02  # of the heats exchanged: closure of noisy view factors
SHADING = 0.05     # likewise: explicit occlusion of pairs leaves neighbours of neighbours to a mean
ONE_RADIOSITY = 0.25  # likewise: what one radiosity a surface costs where grey or re-radiating surfaces are lit unevenly
STEPS = 0.02       # likewise: heat steps, and so their errors, of another length
DEM_STEPS = 0.04   # likewise: of one collision, damped at first order in the step
EXACT = 1e-6       # without radiation nothing is random
OTHER_STEPS = ("replayed", "finer")  # and shutters: frozen beds take steps of a hundredth of the time before one
WALL_RAYS = 300    # of a table, for each sphere
STEFAN_BOLTZMANN = 5.670374419e-8


class Finding(Exception):
    def __init__(self, kind, text):
        super().__init__(text)
        self.kind = kind


class Case:
    """A scene and what a run of it gave."""

    def __init__(self, scene, answer):
        self.scene, self.answer = scene, answer
        self.rows = [{k: float(v) for k, v in row.items()} for row in answer["rows"]]
        self.walls = [(w[0], *map(float, w[1:])) for w in answer["walls"]]

    def wall_heat(self):
        """Mean W of each wall over the run."""
        heat = collections.defaultdict(float)
        for name, _, solid, gas, radiation in self.walls:
            name = name.removeprefix("vessel.")  # of solids in one file
            heat[name[:-2] if name.endswith("_2") else name] += (solid + gas + radiation) / len(self.rows)
        return heat

    def error_W(self):
        errors = [row["Q_rad_error_W"] for row in self.rows if math.isfinite(row["Q_rad_error_W"])]
        return math.sqrt(sum(e * e for e in errors)) / len(errors) if errors else 0.0

    def noise_W(self):
        """Of the heat of a wall, about one standard deviation, from above: walls exchange with walls too, and that is
        not in the stated error of the heat to the particles."""
        scene = self.scene
        low, high = temperatures(scene)
        emission = STEFAN_BOLTZMANN * (high ** 4 - low ** 4)
        radii = [p["radius"] for p in scene["particles"]]
        size, spheres = scene["size"], sum(4 * math.pi * r * r for r in radii)
        areas = [size[0] * size[1], size[1] * size[2], size[2] * size[0]]
        if scene["source"] == "paths":
            return emission * (spheres + 2 * sum(areas)) / math.sqrt(scene["rays"] * len(self.rows))
        rays_per_m2 = scene["rays"] / (4 * math.pi * max(radii) ** 2)
        if scene["rays"] == 0:  # a table: its walls send rays, so many for each sphere
            rays_per_m2 = WALL_RAYS * len(radii) / (2 * sum(areas))
        return STEFAN_BOLTZMANN * high ** 4 * max(areas) / math.sqrt(rays_per_m2 * max(areas))


def books(case):
    """The ledger of the program, the heats of the walls, and our own sum of what the spheres hold."""
    scene, received_J, absolute_J = case.scene, 0.0, 0.0
    every = scene["every"]
    walls = collections.deque(case.walls)
    per_row = len(case.walls) // len(case.rows)
    for row in case.rows:
        for name, value in row.items():
            if math.isinf(value):
                raise Finding("not finite", "%s = %r" % (name, value))
        received = row["Q_ss_W"] + row["Q_sfs_W"] + row["Q_rad_W"]
        received_J += received * every
        absolute_J += abs(received) * every
        # Temperatures are doubles: heats that nearly cancel leave the rounding of what the bed holds, at every step.
        rounding = max(1e-13, 2 ** -53 * row["time_s"] / case.answer["step_s"])
        if row["energy_defect"] > 1e-9 and row["energy_defect"] * abs(received_J) > rounding * thermal_J(scene, row):
            raise Finding("ledger", "energy defect %g" % row["energy_defect"])
        now = [walls.popleft() for _ in range(per_row)]
        given, size = sum(sum(w[2:]) for w in now), sum(sum(map(abs, w[2:])) for w in now)
        leaves = scene["feed"] or scene["remove"]  # and what leaves takes its share of the held radiation with it
        if not leaves and abs(given - received) > 1e-9 * max(size, abs(received)) + 1e-13 * thermal_J(scene, row) / every:
            raise Finding("walls and spheres", "walls gave %r W, spheres received %r W" % (given, received))
    if scene["particles"] and not scene["remove"] and not scene["feed"]:
        stored_J = sum(capacity(scene, p["radius"], p["material"]) * (after - p["T"])
                       for p, after in zip(scene["particles"], case.answer["temperatures"]))
        if abs(stored_J - received_J) > 1e-9 * absolute_J + 1e-12 * thermal_J(scene, case.rows[-1]):
            raise Finding("stored heat", "spheres hold %r J more, received %r J" % (stored_J, received_J))


def capacity(scene, radius, material):
    m = scene["materials"][material]
    return 4 / 3 * math.pi * radius ** 3 * m["density_kg_m3"] * m["specific_heat_J_kgK"]


def thermal_J(scene, row):
    """m c T of the bed, about."""
    here = sum(capacity(scene, p["radius"], p["material"]) * p["T"] for p in scene["particles"])
    return here + (row["particle_count"] * capacity(scene, scene["diameter"] / 2, 0) * scene["particle_K"] if scene["feed"] else 0)


def temperatures(scene):
    known = [scene["particle_K"]] + [p["T"] for p in scene["particles"]]
    known += [wall["temperature_K"] for wall in scene["walls"].values() if "temperature_K" in wall]
    known += [plate["wall"]["temperature_K"] for plate in scene["plates"] if "temperature_K" in plate["wall"]]
    known += [scene["surroundings_K"]] if scene["surroundings_K"] else []
    return min(known), max(known)


def bounds(case):
    """Heat flows from hot to cold: nothing leaves the range of what there was. At one temperature nothing changes, to
    the bit."""
    low, high = temperatures(case.scene)
    if not case.answer["finite"]:
        raise Finding("not finite", "a column of the bed")
    coldest, hottest = map(float, case.answer["bounds"])
    slack = 0.0 if low == high else 1e-9 * high
    if case.answer["counts"][1] and not (low - slack <= coldest and hottest <= high + slack):
        raise Finding("maximum principle" if low < high else "isothermal",
                      "%r ... %r K is outside %r ... %r K" % (coldest, hottest, low, high))


def count(case):
    scene, (fewest, most), (came, left) = case.scene, case.answer["counts"], case.answer["fed"]
    first, last = case.answer["first_count"], case.rows[-1]["particle_count"]
    if first + came - left != last:
        raise Finding("particle count", "%d at first, %d came, %d left, %d now" % (first, came, left, last))
    if not scene["feed"] and not scene["remove"] and {fewest, most} != {len(scene["particles"])}:
        raise Finding("particle count", "%d to %d instead of %d" % (fewest, most, len(scene["particles"])))
    feed = scene["feed"]
    if feed and feed["kind"] == "hopper" and not scene["particles"] and most > feed["particle_count"]:
        raise Finding("particle count", "%d, more than %d" % (most, feed["particle_count"]))


def resumed(case, again):
    """What was written to a frame and read back goes on to the same bits."""
    for name in ("rows", "walls", "temperatures"):
        if case.answer[name] != again.answer[name]:
            raise Finding("resume", "%s differ after a stop" % name)


def steps_differ(scene, name):
    return name in OTHER_STEPS or (name == "unshuttered" and scene["engine"] == "none")


def half_a_step_J(case):
    """What contacts of the first moment conduct in half a DEM step: so well is the time known for which they last. From
    above: as if both bodies conducted like the better one."""
    scene, heat_J = case.scene, 0.0
    if scene["engine"] != "native" or not scene["conduction"]["solid"]:
        return heat_J
    low, high = temperatures(scene)
    for k, p in enumerate(scene["particles"]):
        overlaps = [p["radius"] - abs(p["place"][a] - scene["low"][a] - side * scene["size"][a])
                    for a in range(3) for side in (0, 1) if "xyz"[a] not in scene["periodic"]]
        overlaps += [p["radius"] + q["radius"] - scenes.distance(scene, p["place"], q["place"])
                     for q in scene["particles"][:k]]
        for m in scene["materials"]:
            softer = (m["youngs_modulus_Pa"] / m["real_youngs_modulus_Pa"]) ** scene["conduction"]["modulus_exponent"]
            for overlap in overlaps:
                radius = math.sqrt(2 * p["radius"] * max(overlap, 0.0))
                heat_J += 2 * m["conductivity_W_mK"] * radius * softer * (high - low) * case.answer["step_s"] / 2
    return heat_J


def same(case, other, variant):
    """Heats of walls, and without radiation temperatures, of the same physics written in another way."""
    name, scene, factor, walls = variant
    first, second = case.wall_heat(), other.wall_heat()
    scale = max([abs(q) for q in first.values()] + [abs(q) / factor for q in second.values()] + [0.0])
    if case.scene["source"] == "none":
        allowed = (DEM_STEPS if name == "finer" else STEPS if steps_differ(case.scene, name) else EXACT) * scale
        if name == "finer":
            allowed += half_a_step_J(case) / (len(case.rows) * case.scene["every"])
    else:
        stated = math.hypot(case.error_W(), other.error_W() / factor)
        noise = math.hypot(case.noise_W(), other.noise_W() / factor)
        allowed = SIGMAS * math.hypot(stated, noise) + (share(case, other, name) + STEPS * steps_differ(case.scene, name)) * scale
    for face, heat in first.items():
        there = second.get(walls.get(face, face), 0.0) / factor
        if name == "opened" and (face == "surroundings" or case.scene["walls"].get(face, {}).get("role") == "open"):
            continue
        if abs(heat - there) > allowed:
            raise Finding("variant " + name, "%s gives %.6g W, as %s %.6g W (allowed difference %.2g)"
                          % (face, heat, name, there, allowed))
    if case.scene["source"] == "none":
        compare_temperatures(case, other, name)


def compare_temperatures(case, other, name):
    ours, theirs = case.answer["temperatures"], other.answer["temperatures"]
    if name == "renumbered":
        theirs = theirs[::-1]
    if name == "alone":
        low, high = case.scene["region"]
        ours = [t for t, p in zip(ours, case.scene["particles"]) if all(l <= x <= h for l, x, h in zip(low, p["place"], high))]
    warmed = max([abs(a - p["T"]) for a, p in zip(case.answer["temperatures"], case.scene["particles"])] + [0.0])
    smallest = min([capacity(case.scene, p["radius"], p["material"]) for p in case.scene["particles"]] + [math.inf])
    if name == "finer":
        warmed = warmed * DEM_STEPS / STEPS + half_a_step_J(case) / smallest / STEPS
    for a, b in zip(ours, theirs):
        if abs(a - b) > EXACT * a + (STEPS * warmed if steps_differ(case.scene, name) else 0.0):
            raise Finding("variant " + name, "particle at %r K, as %s %r K" % (a, name, b))


def share(case, other, name):
    """View factors give each sphere and each wall one radiosity: another source, or walls in halves, resolve the light
    differently unless everything is black."""
    sources = {case.scene["source"], other.scene["source"]}
    if sources == {"paths"}:
        return 0.0
    least = SHADING if "shading" in sources else SYSTEMATIC
    resolved = name in ("halves", "opened") or len(sources) > 1
    return ONE_RADIOSITY if resolved and not is_black(case.scene) else least


def is_black(scene):
    if any(m["emissivity"] != 1 for m in scene["materials"]):
        return False
    for wall in list(scene["walls"].values()) + [plate["wall"] for plate in scene["plates"]]:
        emissivity = wall.get("emissivity", 1)
        if wall["role"] != "open" and (wall["role"] != "isothermal" or emissivity != 1):
            return False
    return True


class Pool:
    """Differences too small to see in one scene, over all of them: of the heat of the wall that gives most, by kind of
    variant. Only where the two are two estimates of one number."""

    def __init__(self):
        self.differences = collections.defaultdict(list)

    def add(self, case, other, variant):
        name, _, factor, walls = variant
        sources = {case.scene["source"], other.scene["source"]}
        if "none" in sources or "correlation" in sources or "shading" in sources:
            return
        if sources != {"paths"} and not is_black(case.scene):
            return
        first, second = case.wall_heat(), other.wall_heat()
        pairs = [(heat, second.get(walls.get(face, face), 0.0) / factor) for face, heat in first.items()
                 if face in case.scene["walls"] and not (name == "opened" and case.scene["walls"][face]["role"] == "open")]
        if not pairs:
            return
        a, b = max(pairs, key=lambda pair: abs(sum(pair)))
        if a + b != 0:
            # Symmetric in both, so that noise alone has no mean.
            self.differences[name].append(max(-1.0, min(1.0, 2 * (b - a) / abs(a + b) * math.copysign(1, a + b))))

    def merge(self, other):
        for name, values in other.differences.items():
            self.differences[name] += values

    def table(self):
        """(name, scenes, mean difference, its standard error)"""
        lines = []
        for name, values in sorted(self.differences.items()):
            n = len(values)
            mean = sum(values) / n
            spread = math.sqrt(sum((v - mean) ** 2 for v in values) / max(1, n - 1))
            lines.append((name, n, mean, spread / math.sqrt(n)))
        return lines

    def findings(self):
        return ["pooled: %s differs by %.2f +- %.2f %% over %d scenes" % (name, 100 * mean, 100 * error, n)
                for name, n, mean, error in self.table()
                if n >= 30 and abs(mean) > max(SIGMAS * error, 0.002)]
