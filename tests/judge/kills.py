#!/usr/bin/env python3
"""kill -9 at random moments of a coupled run with feed, radiation and conduction, and --resume until it ends: the final
frame, history.csv and walls.csv are those of the run that nobody disturbed. Exit code 0: all alike.

kills.py GRANRUN [--count N] [--seed S]"""
import argparse
import hashlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

SCENE = """
[scene]
end_time_s = 0.04
[material]
file = "alumina.toml"
emissivity = 0.7
[gas]
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
[box]
size_m = [0.004, 0.003, 0.006]
[walls]
x_min = {role = "adiabatic"}
x_max = {role = "adiabatic"}
y_min = {role = "isothermal", temperature_K = 1000}
y_max = {role = "isothermal", temperature_K = 1000}
z_min = {role = "open", temperature_K = 300}
z_max = {role = "open", temperature_K = 300}
[feed]
kind = "plug"
solid_fraction = 0.3
velocity_m_s = 0.1
transverse_velocity_std_m_s = 0.02
[dem]
step_s = 5e-6
[radiation]
source = "paths"
rays = 4000
every_s = 0.002
[output]
every_s = 0.002
frames_every_s = 0.004
"""


def state(folder):
    frames = os.path.join(folder, "frames")
    names = [os.path.join(frames, max(n for n in os.listdir(frames) if n.endswith(".hdf")))]
    names += [os.path.join(folder, n) for n in ("history.csv", "walls.csv")]
    return [os.path.basename(n) + " " + hashlib.sha256(open(n, "rb").read()).hexdigest() for n in names]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("granrun", type=os.path.abspath)
    options.add_argument("--count", type=int, default=50)
    options.add_argument("--seed", type=int, default=1)
    given = options.parse_args()
    chance, different, killed = random.Random(given.seed), 0, 0
    with tempfile.TemporaryDirectory() as root:
        scene = os.path.join(root, "scene.toml")
        with open(scene, "w") as out:
            out.write(SCENE)
        command = [given.granrun, "run", scene, "-q", "--threads", "2", "-o"]
        whole = os.path.join(root, "whole")
        begin = time.monotonic()
        subprocess.run(command + [whole], check=True)
        seconds = time.monotonic() - begin
        k = 0
        while killed < given.count:
            k += 1
            folder = os.path.join(root, "case%d" % k)
            run = subprocess.Popen(command + [folder, "--resume"], stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0, seconds))
            run.send_signal(signal.SIGKILL)
            killed += run.wait() == -signal.SIGKILL
            code = subprocess.run(command + [folder, "--resume"]).returncode
            if code != 0 or state(folder) != state(whole):
                different += 1
                print("run %d: exit code %d, ends differently" % (k, code))
    print("%d runs, %d of them killed in time, %d end differently" % (k, killed, different))
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
