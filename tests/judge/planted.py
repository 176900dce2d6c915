#!/usr/bin/env python3
"""Every oracle of the judge sees a wrong answer: answers of the runner are altered on their way, and the finding must be
of the kind expected. Exit code 0: all were seen.

planted.py JUDGE_RUNNER [KIND...]"""
import math
import os
import sys
import tempfile

import judge
import oracles
import scenes
import variants

MOST_SCENES = 60  # in which an error must show
HALF_AS_MUCH_AGAIN = 1.5
VARIANTS = ("moved", "mirrored", "turned", "larger", "renumbered", "polygons", "reordered", "halves", "meshes", "doubled",
            "opened", "paths", "embree", "lines", "shading", "slid", "alone", "replayed", "unshuttered", "solids", "finer")


class Altered(judge.Runner):
    """Hands on answers of scenes in folders called `where`, altered."""

    def __init__(self, program, where, alter):
        super().__init__(program)
        self.where, self.alter = where, alter

    def ask(self, line):
        answer = super().ask(line)
        words = line.split()
        folder = "again" if len(words) > 1 else os.path.basename(os.path.dirname(words[0]))
        if answer["code"] == 0 and folder == self.where:
            self.alter(answer)
        return answer


def rows(name, value):
    def alter(answer):
        for row in answer["rows"]:
            row[name] = value
    return alter


def wall_heats(factor):
    def alter(answer):
        for wall in answer["walls"]:
            for column in (2, 3, 4):
                wall[column] *= factor
    return alter


def put(key, value):
    def alter(answer):
        answer[key] = value
    return alter


def warmer(factor):
    def alter(answer):
        answer["temperatures"] = [t * factor for t in answer["temperatures"]]
    return alter


def hotter(answer):
    """By the least that a number can be."""
    answer["bounds"][1] = math.nextafter(float(answer["bounds"][1]), math.inf) if answer["counts"][1] else 0.0


def beyond(answer):
    answer["bounds"][1] = 1e4


ERRORS = [("ledger", "first", rows("energy_defect", 1e-3)),
          ("not finite", "first", put("finite", False)),
          ("not finite", "first", rows("h_wp_W_m2K", "inf")),
          ("walls and spheres", "first", wall_heats(1.0001)),
          ("stored heat", "first", warmer(1.0001)),
          ("maximum principle", "first", beyond),
          ("isothermal", "first", hotter),
          ("particle count", "first", lambda answer: put("first_count", answer["first_count"] + 1)(answer)),
          ("resume", "again", warmer(1 + 1e-15)),
          ("exit code", "first", lambda answer: answer.update(code=1, error="planted"))]
ERRORS += [("variant " + name, name, wall_heats(HALF_AS_MUCH_AGAIN)) for name in VARIANTS]


def kind_found(runner, seeds, root):
    """Kinds of finding over these scenes, the first of each."""
    pool, kinds = oracles.Pool(), set()
    for seed in seeds:
        one = judge.Judge(runner, None)
        try:
            one.check(scenes.generate(seed), os.path.join(root, "scene"))
        except oracles.Finding as finding:
            kinds.add(finding.kind)
        pool.merge(one.pool)
        yield kinds, pool


def main():
    blind = []
    judge.BY_PROGRAM = 10 ** 9
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.access("/dev/shm", os.W_OK) else None) as root:
        for kind, where, alter in [e for e in ERRORS if not sys.argv[2:] or e[0] in sys.argv[2:]]:
            runner = Altered(os.path.abspath(sys.argv[1]), where, alter)
            suited = [s for s in range(1, 20000) if where not in VARIANTS or
                      where in [v[0] for v in variants.variants(scenes.generate(s))]][:MOST_SCENES]
            seen = any(kind in kinds for kinds, _ in kind_found(runner, suited, root))
            print("%-20s %s" % (kind, "seen" if seen else "NOT SEEN"), flush=True)
            if not seen:
                blind.append(kind)
            runner.close()
    return 1 if blind else 0


if __name__ == "__main__":
    sys.exit(main())
