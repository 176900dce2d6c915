#!/usr/bin/env python3
"""Random scenes against what must hold whatever they are. Exit code 0: no finding.

judge.py JUDGE_RUNNER GRANRUN [--count N] [--first SEED] [--keep FOLDER]

Each scene runs; then its books, bounds and counts are looked at, it is written to a frame and read back, and the same
physics written in other ways (variants.py) must give the same heats within the stated errors (oracles.py). A scene
that fails is made smaller as long as it fails in the same way, and kept. JUDGE_RUNNER runs the scenes in one process;
some are run by the program as well, stopped and resumed."""
import argparse
import collections
import concurrent.futures
import copy
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import threading

import oracles
import scenes
import variants
from oracles import Finding

SECONDS = 120  # no scene takes as many
BY_PROGRAM = 20  # every so many scenes are run by the program too


class Runner:
    """The process that runs scenes; a new one after a crash or a hang."""

    def __init__(self, program):
        self.program, self.process = program, None

    def ask(self, line):
        if self.process is None:
            self.process = subprocess.Popen([self.program], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                            stderr=subprocess.DEVNULL, env=dict(os.environ, OMP_WAIT_POLICY="passive"))
        self.process.stdin.write((line + "\n").encode())
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], SECONDS)
        answer = self.process.stdout.readline() if ready else None
        if answer:
            return json.loads(answer)
        self.close()
        raise Finding("hang", "no end within %d s" % SECONDS) if answer is None else Finding("crash", "the process ended")

    def close(self):
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


class Judge:
    def __init__(self, runner, granrun):
        self.runner, self.granrun = runner, granrun
        self.refused = collections.Counter()
        self.pool = oracles.Pool()

    def run(self, scene, folder, kind="first", frame=""):
        """What the scene gave; None when it is refused."""
        answer = self.runner.ask(scenes.write(scene, folder) + frame)
        if answer["code"] == 2:
            self.refused["%s: %s" % (kind, answer["error"].split("\n")[0][-160:])] += 1
            return None
        if answer["code"] != 0:
            raise Finding("exit code", "exit code %d: %s" % (answer["code"], answer["error"][-400:]))
        return oracles.Case(scene, answer)

    def check(self, scene, folder):
        """Throws a Finding; false when the scene was refused."""
        shutil.rmtree(folder, ignore_errors=True)
        first = os.path.join(folder, "first")
        case = self.run(scene, first)
        if case is None:
            return False
        scene = dict(scene, step_s=case.answer["step_s"])
        oracles.books(case)
        oracles.bounds(case)
        oracles.count(case)
        threads = 2 if scene["seed"] % 10 == 0 else 1
        again = self.run(scene, first, frame=" %s %d" % (os.path.join(folder, "frame.hdf"), threads))
        if again is None:
            raise Finding("resume", "refused")
        oracles.resumed(case, again)
        if scene["seed"] % BY_PROGRAM == 0:
            self.by_program(scene, first, case)
        for variant in variants.variants(scene):
            other = self.run(variant[1], os.path.join(folder, variant[0]), variant[0])
            if other is not None:
                oracles.same(case, other, variant)
                self.pool.add(case, other, variant)
        return True

    def by_program(self, scene, folder, case):
        """The program writes the same history, whole or in two parts."""
        def call(*arguments):
            try:
                done = subprocess.run([self.granrun, *arguments, "-q"], cwd=folder, capture_output=True, text=True,
                                      timeout=SECONDS, env=dict(os.environ, OMP_WAIT_POLICY="passive"))
            except subprocess.TimeoutExpired:
                raise Finding("hang", "granrun has no end within %d s" % SECONDS)
            if done.returncode != 0:
                raise Finding("exit code", "granrun: exit code %d: %s" % (done.returncode, done.stderr[-400:]))

        half = scene["every"] * (scene["rows"] // 2)
        call("run", "scene.toml", "-o", "whole", "--threads", "1")
        call("run", "scene.toml", "-o", "parts", "--set", "scene.end_time_s=%r" % half)
        call("run", "scene.toml", "-o", "parts", "--resume", "--threads", "2")
        call("export", "whole", "--to", "csv")
        for name in ("history.csv", "walls.csv"):
            with open(os.path.join(folder, "whole", name)) as a, open(os.path.join(folder, "parts", name)) as b:
                whole = a.read()
                if whole != b.read():
                    raise Finding("resume", "%s differs after a stop" % name)
                if name == "history.csv" and len(whole.splitlines()) - 1 != len(case.rows):
                    raise Finding("history", "%d rows, not %d" % (len(whole.splitlines()) - 1, len(case.rows)))


def simpler(scene):
    """Scenes with less in them, the largest steps first."""
    particles = scene["particles"]
    for part in (len(particles) // 2, len(particles) // 4, 1):
        for start in range(0, len(particles) if part else 0, max(part, 1)):
            if part and len(particles) > part:
                yield scenes.changed(scene, particles=particles[:start] + particles[start + part:])
    for key, value in (("gas", None), ("rows", 3), ("gravity", [0.0] * 3), ("plates", []), ("blocks", []), ("remove", []), ("dem", {}),
                       ("region", None), ("every_steps", None),
                       ("wall_style", "box"), ("radiation_every", scene["every"])):
        if scene.get(key, value) != value:
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


here = threading.local()


def examine(given, seed, root):
    if not hasattr(here, "runner"):
        here.runner = Runner(given.judge_runner)
    judge = Judge(here.runner, given.granrun)
    scene, folder = scenes.generate(seed), os.path.join(root, "scene%d" % seed)
    try:
        accepted = judge.check(scene, folder)
        return accepted, judge, None
    except Finding as finding:
        small = shrunk(Judge(here.runner, given.granrun), scene, finding.kind, folder)
        place = os.path.join(given.keep, "%s_%d" % (finding.kind.replace(" ", "_"), seed))
        scenes.write(small, place)
        return True, judge, "%d: %s: %s (smallest: %s)" % (seed, finding.kind, finding, place)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def arguments():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("judge_runner", type=os.path.abspath)
    options.add_argument("granrun", type=os.path.abspath)
    options.add_argument("--count", type=int, default=100)
    options.add_argument("--first", type=int, default=1)
    options.add_argument("--keep", type=os.path.abspath, default="judge_findings")
    options.add_argument("--jobs", type=int, default=1)
    return options.parse_args()


def main():
    given = arguments()
    accepted, findings, refused, pool = 0, [], collections.Counter(), oracles.Pool()
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    seeds = range(given.first, given.first + given.count)
    with tempfile.TemporaryDirectory(dir=memory) as root, concurrent.futures.ThreadPoolExecutor(given.jobs) as workers:
        for ran, judge, finding in workers.map(lambda seed: examine(given, seed, root), seeds):
            accepted += ran
            refused.update(judge.refused)
            pool.merge(judge.pool)
            if finding:
                findings.append(finding)
                print(finding, flush=True)
    for line in pool.findings():
        findings.append(line)
        print(line)
    print("%d scenes: %d ran, %d refused, %d findings" % (given.count, accepted, given.count - accepted, len(findings)))
    for name, n, mean, error in pool.table():
        print("  %-10s %5d pairs, largest wall heat differs by %+.3f +- %.3f %%" % (name, n, 100 * mean, 100 * error))
    for message, times in refused.most_common(20):
        print("  refused %d times: %s" % (times, message))
    return 1 if findings else 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)  # the runners end with their pipes
