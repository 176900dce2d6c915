#!/usr/bin/env python3
"""Threads beside other work: a plug and a dense bed while a competing process spins on every core, with one thread, with
as many as cores, and as the program chooses by itself. Prints a line a case and writes load.csv; exit code 4 where the
choice takes more than 1.3 times the better of the two.

load_bench.py GRANRUN SCENES OUT [--quick]"""
import os
import statistics
import subprocess
import sys
import tempfile
import time

BUSY = "while True: pass"
CASES = (("plug", "demo.toml", ["scene.end_time_s=0.05", "radiation.source=\"none\""]),
         ("plug_paths", "demo.toml", ["scene.end_time_s=0.02"]),
         ("moving_bed", "moving_bed_short.toml", ["scene.end_time_s=0.005"]))


def seconds(granrun, scene, sets, threads):
    with tempfile.TemporaryDirectory() as folder:
        arguments = [granrun, "run", scene, "-q", "-o", os.path.join(folder, "case")]
        for one in sets:
            arguments += ["--set", one]
        if threads:
            arguments += ["--threads", str(threads)]
        begin = time.monotonic()
        done = subprocess.run(arguments, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit("%s: exit code %d: %s" % (scene, done.returncode, done.stderr[-500:]))
        return time.monotonic() - begin


def main():
    granrun, scenes, out = sys.argv[1:4]
    rounds = 2 if "--quick" in sys.argv else 5
    cores = os.cpu_count()
    rivals = [subprocess.Popen([sys.executable, "-c", BUSY]) for _ in range(cores)]
    missed, lines = False, ["case,one_s,all_s,chosen_s,ratio"]
    try:
        for name, scene, sets in CASES:
            taken = {1: [], cores: [], 0: []}
            for _ in range(rounds):  # in turn, so that what changes on the machine meets all alike
                for threads in taken:
                    taken[threads].append(seconds(granrun, os.path.join(scenes, scene), sets, threads))
            one, every, chosen = (statistics.median(taken[t]) for t in (1, cores, 0))
            ratio = chosen / min(one, every)
            missed = missed or ratio > 1.3
            print("load %-10s one thread %.2f s, %d threads %.2f s, chosen %.2f s: %.2f of the better (goal 1.3)"
                  % (name, one, cores, every, chosen, ratio), flush=True)
            lines.append("%s,%.4g,%.4g,%.4g,%.4g" % (name, one, every, chosen, ratio))
    finally:
        for rival in rivals:
            rival.kill()
    with open(os.path.join(out, "load.csv"), "w") as table:
        table.write("\n".join(lines) + "\n")
    return 4 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
