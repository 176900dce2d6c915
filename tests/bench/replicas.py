#!/usr/bin/env python3
"""A settled bed of up to ten million spheres on one node, made of replicas of data/reference/liggghts_bench: native flow,
conduction, global lines and traced paths, frames, and going on from one. Time and memory a sphere, small against large.

Usage: replicas.py [--quick | --full] GRANRUN FOLDER

Each bed is 100 DEM steps with one update of its source; then the run with paths goes on for 100 more. --quick: 50 000 and
200 000 spheres; the default: 200 000 and a million; --full: ten million as well (22 GB of memory, 6 GB of disk).
"""
import os, pathlib, shutil, subprocess, sys

import h5py
import numpy as np

STEPS, STEP_S, UNIT_M, RADIUS_M, LINES = 100, 1e-5, 0.018, 4e-4, 50  # LINES: rays a sphere of global lines


def scene(replicas, file, source, rays):
    end = STEPS * STEP_S
    return f"""[scene]
name = "replicas"
end_time_s = {end}
gravity_m_s2 = [0, 0, -9.81]
[material]
file = "alumina.toml"
[gas]
[particles]
file = "{file}"
temperature_K = 300
[box]
size_m = [{UNIT_M * replicas:.9g}, {UNIT_M * replicas:.9g}, 0.045]
periodic = ["x", "y"]
[walls]
z_min = {{role = "isothermal", temperature_K = 1000}}
z_max = {{role = "isothermal", temperature_K = 1000}}
[dem]
step_s = {STEP_S}
[conduction]
every_steps = {STEPS}
[radiation]
source = "{source}"
rays = {rays}
every_s = {end}
[output]
every_s = {end}
frames_every_s = {end}
"""


def run(granrun, *arguments):
    """Seconds of computing and bytes at most."""
    process = subprocess.Popen([granrun, "run", *map(str, arguments), "-q"])
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode: sys.exit(f"{arguments[0]} ended with {process.returncode}")
    return used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss


def write_replicas(unit, replicas, file):
    """A frame of replicas side by side, from the frame of one."""
    with h5py.File(unit) as one, h5py.File(file, "w") as out:
        one.copy("granrad", out)
        count = replicas**2
        shift = np.array([(UNIT_M * i, UNIT_M * j, 0) for i in range(replicas) for j in range(replicas)])
        for name, column in one["granrad/particles"].items():
            values = column[:]
            if name == "id": values = np.arange(1, count * len(values) + 1)
            elif name == "position_m": values = (values[None] + shift[:, None]).reshape(-1, 3)
            else: values = np.concatenate([values] * count)
            del out["granrad/particles"][name]
            out["granrad/particles"][name] = values
        del out["granrad/box"]
        out["granrad/box"] = np.array([[0, 0, 0], [UNIT_M * replicas, UNIT_M * replicas, 0.045]])
        spheres = len(out["granrad/particles/id"])
        out["granrad"].attrs["next_id"] = np.int64(spheres + 1)
    return spheres


def measure(granrun, folder, unit, replicas):
    spheres = write_replicas(unit, replicas, folder / "replicas.hdf")
    case, file = folder / "case", folder / "replicas.toml"
    for source, rays in (("lines", LINES), ("paths", spheres)):
        file.write_text(scene(replicas, "replicas.hdf", source, rays))
        shutil.rmtree(case, ignore_errors=True)
        told = [(source, run(granrun, file, "-o", case))]
        if source == "paths":
            told.append(("resumed", run(granrun, file, "-o", case, "--resume", "--set", f"scene.end_time_s={2 * STEPS * STEP_S}")))
        for what, (seconds, most) in told:
            print(f"{spheres:>9} spheres, {what:8} {seconds:8.1f} s of computing, {1e6 * seconds / spheres:7.2f} us a sphere, "
                  f"{most / 1e9:6.2f} GB, {most / spheres:6.0f} bytes a sphere", flush=True)
    shutil.rmtree(case, ignore_errors=True)
    (folder / "replicas.hdf").unlink()


def main():
    granrun, folder = [a for a in sys.argv[1:] if not a.startswith("--")]
    folder = pathlib.Path(folder) / "replicas"
    folder.mkdir(parents=True, exist_ok=True)
    data = pathlib.Path(__file__).resolve().parents[2] / "data/reference/liggghts_bench/bed12k.data"
    points = np.loadtxt(data, skiprows=11)[:, 4:7]
    np.savetxt(folder / "unit.csv", np.c_[points, np.full(len(points), RADIUS_M)], delimiter=",", fmt="%.17g",
               header="x,y,z,radius", comments="")
    (folder / "unit.toml").write_text(scene(1, "unit.csv", "paths", 1000))
    shutil.rmtree(folder / "unit", ignore_errors=True)
    run(granrun, folder / "unit.toml", "-o", folder / "unit")
    for replicas in (2, 4) if "--quick" in sys.argv else (4, 9, 28) if "--full" in sys.argv else (4, 9):
        measure(granrun, folder, folder / "unit/frames/f_000000000.hdf", replicas)


main()
