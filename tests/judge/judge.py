#!/usr/bin/env python3
"""Random scenes against what must hold whatever they are. Exit code 0: no finding.

judge.py GRANRUN [--count N] [--first SEED] [--keep FOLDER]

Each scene runs; then its books, bounds and counts are looked at, it is stopped and resumed, and the same physics
written in other ways (variants.py) must give the same heats within the stated errors. A scene that fails is made
smaller as long as it fails in the same way, and kept."""
import argparse
import collections
import concurrent.futures
import copy
import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile

import scenes
import variants

SIGMAS = 5.0       # of the stated error; the joint chance of a false alarm in 10 000 scenes is below 1 %
SYSTEMATIC = 0.02  # of the heats exchanged: closure of noisy view factors
ONE_RADIOSITY = 0.25  # likewise: what one radiosity a surface costs where grey or re-radiating surfaces are lit unevenly
EXACT = 1e-6       # without radiation nothing is random


class Finding(Exception):
    def __init__(self, kind, text):
        super().__init__(text)
        self.kind = kind


class Judge:
    def __init__(self, granrun):
        self.granrun = granrun
        self.refused = collections.Counter()

    def call(self, arguments, folder):
        env = dict(os.environ, OMP_WAIT_POLICY="passive")
        try:
            done = subprocess.run([self.granrun] + arguments, cwd=folder, env=env, capture_output=True, text=True,
                                  timeout=120, errors="replace")
        except subprocess.TimeoutExpired:
            raise Finding("hang", "no end within 120 s")
        if done.returncode not in (0, 2):
            raise Finding("exit code", "exit code %d: %s" % (done.returncode, done.stderr[-400:]))
        return done

    def run(self, scene, folder, name="out", more=()):
        """The case in folder/name; None when granrun refuses the scene."""
        scenes.write(scene, folder)
        done = self.call(["run", "scene.toml", "-o", name, "-q", "--threads", "1", *more], folder)
        if done.returncode == 2:
            self.refused[done.stderr.strip().split("\n")[0][-160:]] += 1
            return None
        return Case(scene, self, os.path.join(folder, name))

    def check(self, scene, folder):
        """Throws a Finding; false when the scene was refused."""
        shutil.rmtree(folder, ignore_errors=True)
        case = self.run(scene, os.path.join(folder, "first"))
        if case is None:
            return False
        books(scene, case)
        bounds(scene, case)
        count(scene, case)
        self.resumes(scene, folder, case)
        for variant in variants.variants(scene):
            other = self.run(variant[1], os.path.join(folder, variant[0]))
            if other is not None:
                same(case, other, variant)
        return True

    def resumes(self, scene, folder, case):
        half = scene["every"] * (scene["rows"] // 2)
        where = os.path.join(folder, "first")
        for more in (["--set", "scene.end_time_s=%r" % half], ["--resume", "--threads", "2"]):
            arguments = ["run", "scene.toml", "-o", "again", "-q", *more]
            if self.call(arguments, where).returncode != 0:
                raise Finding("resume", "refused")
        for name in ("history.csv", "walls.csv"):
            with open(os.path.join(where, "again", name)) as a, open(os.path.join(case.folder, name)) as b:
                if a.read() != b.read():
                    raise Finding("resume", "%s differs after a stop" % name)


class Case:
    """Results of one run."""

    def __init__(self, scene, judge, folder):
        self.folder, self.scene = folder, scene
        with open(os.path.join(folder, "history.csv")) as text:
            self.rows = [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(text)]
        with open(os.path.join(folder, "walls.csv")) as text:
            self.wall_rows = list(csv.DictReader(text))
        if judge.call(["export", folder, "--to", "csv", "-q"], ".").returncode != 0:
            raise Finding("export", "refused")
        self.frames = []
        for name in sorted(os.listdir(os.path.join(folder, "export"))):
            with open(os.path.join(folder, "export", name)) as text:
                self.frames.append([{k: float(v) for k, v in row.items()} for row in csv.DictReader(text)])

    def wall_heat(self):
        """Mean W of each wall over the run."""
        heat = collections.defaultdict(float)
        for row in self.wall_rows:
            name = row["wall"][:-2] if row["wall"].endswith("_2") else row["wall"]
            heat[name] += sum(float(row[c]) for c in ("Q_ss_W", "Q_sfs_W", "Q_rad_W")) / len(self.rows)
        return heat

    def exchanged(self):
        """What could flow at most: the scale against which differences are judged, W."""
        return max((abs(q) for q in self.wall_heat().values()), default=0)

    def error_W(self):
        errors = [row["Q_rad_error_W"] for row in self.rows if math.isfinite(row["Q_rad_error_W"])]
        return math.sqrt(sum(e * e for e in errors)) / len(errors) if errors else 0.0


def books(scene, case):
    received_J = 0.0
    for row in case.rows:
        for name, value in row.items():
            if math.isinf(value):
                raise Finding("not finite", "%s = %r" % (name, value))
        received_J += (row["Q_ss_W"] + row["Q_sfs_W"] + row["Q_rad_W"]) * scene["every"]
        # Temperatures are doubles: heats that nearly cancel leave the rounding of what the bed holds.
        defect_J = row["energy_defect"] * abs(received_J)
        if row["energy_defect"] > 1e-9 and defect_J > 1e-13 * thermal_J(scene, row):
            raise Finding("ledger", "energy defect %g" % row["energy_defect"])


def thermal_J(scene, row):
    """m c T of the bed, about."""
    def capacity(radius, material):
        m = scene["materials"][material]
        return 4 / 3 * math.pi * radius ** 3 * m["density_kg_m3"] * m["specific_heat_J_kgK"]
    if scene["particles"]:
        return sum(capacity(p["radius"], p["material"]) * p["T"] for p in scene["particles"])
    return row["particle_count"] * capacity(scene["diameter"] / 2, 0) * scene["particle_K"]


def temperatures(scene):
    known = [scene["particle_K"]] + [p["T"] for p in scene["particles"]]
    known += [wall["temperature_K"] for wall in scene["walls"].values() if "temperature_K" in wall]
    return min(known), max(known)


def bounds(scene, case):
    low, high = temperatures(scene)
    slack = 1e-9 * high
    for frame in case.frames:
        for p in frame:
            for name, value in p.items():
                if not math.isfinite(value):
                    raise Finding("not finite", "%s of a particle" % name)
            if not low - slack <= p["temperature"] <= high + slack:
                raise Finding("maximum principle", "%r K is outside %r ... %r K" % (p["temperature"], low, high))


def count(scene, case):
    counts = [len(frame) for frame in case.frames]
    if not scene["feed"] and not scene["remove"] and set(counts) != {len(scene["particles"])}:
        raise Finding("particle count", "%s instead of %d" % (counts, len(scene["particles"])))
    feed = scene["feed"]
    if feed and feed["kind"] == "hopper" and max(counts) > feed["particle_count"]:
        raise Finding("particle count", "%d, more than %d" % (max(counts), feed["particle_count"]))


def same(case, other, variant):
    name, scene, factor, walls = variant
    first, second = case.wall_heat(), other.wall_heat()
    per_particle = len(scene["particles"]) / max(1, len(case.scene["particles"])) if name == "doubled" else 1
    scale = max(case.exchanged(), other.exchanged() / factor)
    if case.scene["source"] == "none":
        allowed = EXACT * scale
    else:
        share = ONE_RADIOSITY if resolution_matters(case, other, name) else SYSTEMATIC
        allowed = SIGMAS * math.hypot(case.error_W(), other.error_W() / factor) + share * scale + wall_noise(case, other)
    for face, heat in first.items():
        there = second.get(walls.get(face, face), 0.0) / factor
        if abs(heat - there) > allowed:
            raise Finding("variant " + name, "%s gives %.6g W, as %s %.6g W (allowed difference %.2g)"
                          % (face, heat, name, there, allowed))
    if case.scene["source"] == "none":
        compare_temperatures(case, other, name)


def resolution_matters(case, other, name):
    """View factors give each sphere and each wall one radiosity: another source, or walls in halves, resolve the light
    differently unless everything is black."""
    if {case.scene["source"], other.scene["source"]} <= {"paths"}:
        return False
    black = all(m["emissivity"] == 1 for m in case.scene["materials"])
    for wall in case.scene["walls"].values():
        emissivity = wall.get("emissivity", case.scene["materials"][0]["emissivity"])
        black = black and (wall["role"] == "open" or (wall["role"] == "isothermal" and emissivity == 1))
    return not black and (name == "halves" or case.scene["source"] != other.scene["source"])


def wall_noise(case, other):
    """Walls exchange with walls too: the noise of that is not in the error of the heat to the particles, W."""
    noise = 0.0
    for one in (case, other):
        unit = 100.0 if one.scene["size"][0] > 5 * case.scene["size"][0] else 1.0  # the larger variant
        noise = math.hypot(noise, (row_scatter(one) if one.scene["source"] == "paths" else ray_noise(one)) / unit)
    return noise


def row_scatter(case):
    """Updates of paths are independent: the scatter of a wall's rows tells its error. Few rows need a wide margin."""
    heats = collections.defaultdict(list)
    for row in case.wall_rows:
        heats[row["wall"]].append(float(row["Q_rad_W"]))
    errors = [0.0]
    for values in heats.values():
        mean = sum(values) / len(values)
        variance = sum((q - mean) ** 2 for q in values) / max(1, len(values) - 1)
        errors.append(math.sqrt(variance / len(values)))
    return 2 * SIGMAS * max(errors)


def ray_noise(case):
    """Of view factors, drawn once in a frozen bed: each ray of a wall carries its share of what the wall emits."""
    radii = [p["radius"] for p in case.scene["particles"]]
    rays_per_m2 = case.scene["rays"] / (4 * math.pi * max(radii) ** 2)
    size = case.scene["size"]
    area = max(size[0] * size[1], size[1] * size[2], size[2] * size[0])
    hottest = max((w["temperature_K"] for w in case.scene["walls"].values() if "temperature_K" in w), default=0.0)
    return SIGMAS * 5.67e-8 * hottest ** 4 * area / math.sqrt(rays_per_m2 * area)


def compare_temperatures(case, other, name):
    n = len(case.frames[-1])
    for a, b in zip(case.frames[-1], other.frames[-1][:n]):
        if abs(a["temperature"] - b["temperature"]) > EXACT * a["temperature"]:
            raise Finding("variant " + name, "particle at %r K, as %s %r K" % (a["temperature"], name, b["temperature"]))


def simpler(scene):
    """Scenes with less in them, the largest steps first."""
    particles = scene["particles"]
    for part in (len(particles) // 2, len(particles) // 4, 1):
        for start in range(0, len(particles) if part else 0, max(part, 1)):
            if part and len(particles) > part:
                yield scenes.changed(scene, particles=particles[:start] + particles[start + part:])
    for key, value in (("gas", None), ("periodic", []), ("rows", 3), ("gravity", [0.0] * 3)):
        if scene[key] != value and not (key == "periodic" and scene["periodic"]):
            yield scenes.changed(scene, **{key: value})
    if len(scene["materials"]) > 1:
        other = copy.deepcopy(scene)
        other["materials"] = other["materials"][:1]
        for p in other["particles"]:
            p["material"] = 0
        yield other
    for face, wall in scene["walls"].items():
        if wall["role"] != "adiabatic":
            other = copy.deepcopy(scene)
            other["walls"][face] = {k: v for k, v in wall.items() if k == "contact"} | {"role": "adiabatic"}
            yield other


def shrunk(judge, scene, kind, folder, tries=60):
    found = True
    while found and tries > 0:
        found = False
        for candidate in simpler(scene):
            tries -= 1
            if tries <= 0:
                break
            try:
                judge.check(candidate, folder)
            except Finding as finding:
                if finding.kind == kind:
                    scene, found = candidate, True
                    break
    return scene


def examine(granrun, seed, root, keep):
    judge = Judge(granrun)
    scene, folder = scenes.generate(seed), os.path.join(root, "scene%d" % seed)
    try:
        accepted = judge.check(scene, folder)
        return accepted, judge.refused, None
    except Finding as finding:
        small = shrunk(judge, scene, finding.kind, folder)
        place = os.path.join(keep, "%s_%d" % (finding.kind.replace(" ", "_"), seed))
        scenes.write(small, place)
        return True, judge.refused, "%d: %s: %s (smallest: %s)" % (seed, finding.kind, finding, place)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("granrun")
    options.add_argument("--count", type=int, default=100)
    options.add_argument("--first", type=int, default=1)
    options.add_argument("--keep", default="judge_findings")
    options.add_argument("--jobs", type=int, default=1)
    given = options.parse_args()
    keep, granrun = os.path.abspath(given.keep), os.path.abspath(given.granrun)
    accepted, findings, refused = 0, [], collections.Counter()
    with tempfile.TemporaryDirectory() as root, concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        waiting = [pool.submit(examine, granrun, seed, root, keep) for seed in range(given.first, given.first + given.count)]
        for done in concurrent.futures.as_completed(waiting):
            ran, said, finding = done.result()
            accepted += ran
            refused.update(said)
            if finding:
                findings.append(finding)
                print(finding, flush=True)
    print("%d scenes: %d ran, %d refused, %d findings" % (given.count, accepted, given.count - accepted, len(findings)))
    for message, times in refused.most_common(20):
        print("  refused %d times: %s" % (times, message))
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
