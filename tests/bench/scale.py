#!/usr/bin/env python3
"""What each part of a coupled run takes on one and on two ranks, beside LIGGGHTS' flow alone, and what a model fitted
to that says of more ranks.

Usage: scale.py [--quick | --full] GRANRUN FOLDER

Beds of touching spheres on a lattice, pushed and under gravity; conduction every 100 DEM steps, rays (as many walks as
spheres) every 1000. One thread a rank. "alone" is LIGGGHTS through the same plug-in with no heat at all: the difference of two
fifths and one fifth of the steps, each in one go, so that neither start nor hand-over counts. "gather" is what the coupled flow
takes beyond that and its start: what goes between LIGGGHTS and the bed at the heat steps. --full: a million spheres as well.
"""
import csv, json, math, os, pathlib, shutil, subprocess, sys

STEP_S, HEAT_STEPS, RAY_STEPS, DIAMETER_M = 1e-5, 100, 1000, 8e-4
PARTS = ["flow", "gather", "conduction", "rays", "reduce", "output"]
NETWORK_DELAY_S = 5e-5  # of one step of an exchange between nodes; the machine measured on has none


def write_bed(file, side):
    d = 0.999 * DIAMETER_M
    with open(file, "w") as out:
        out.write("x,y,z,radius,temperature,vx,vy,vz\n")
        for k in range(side**3):
            i, j, l = k % side, k // side % side, k // side**2
            out.write("%.9g,%.9g,%.9g,%g,%g,%.3g,%.3g,0\n" % (d * (i + 0.5), d * (j + 0.5), d * (l + 0.5), DIAMETER_M / 2,
                                                               300 + k % 7, 0.01 * math.sin(k), 0.01 * math.cos(k)))


def scene(side, engine, steps, heat_steps, heat, walks):
    size = 0.999 * DIAMETER_M * side
    end = steps * STEP_S
    walls = "".join('[walls.%s]\nrole = "isothermal"\ntemperature_K = 1000\n' % (a + s) for a in "xyz" for s in ("_min", "_max"))
    radiation = f'[radiation]\nsource = "paths"\nrays = {walks}\nevery_s = {min(RAY_STEPS, steps) * STEP_S}\n' if heat else ""
    return f"""[scene]
name = "scale"
end_time_s = {end:.9g}
gravity_m_s2 = [0, 0, -9.81]
[material]
file = "alumina.toml"
{"[gas]" if heat else ""}
[particles]
file = "bed_{side}.csv"
[box]
size_m = [{size}, {size}, {size}]
{walls}[dem]
engine = "{engine}"
step_s = {STEP_S}
[conduction]
solid = {"true" if heat else "false"}
every_steps = {heat_steps}
{radiation}[output]
every_s = {end:.9g}
frames_every_s = {end:.9g}
"""


class Machine:
    def __init__(self, granrun, folder):
        self.granrun, self.folder = granrun, folder
        self.environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                OMPI_MCA_rmaps_base_oversubscribe="1",
                                OMPI_MCA_btl_vader_single_copy_mechanism="none")

    def seconds(self, text, ranks, threads=1):
        file, case = self.folder / "scale.toml", self.folder / "case"
        file.write_text(text)
        shutil.rmtree(case, ignore_errors=True)
        launcher = ["mpirun", "-n", str(ranks), "--bind-to", "core"] if ranks > 1 else []
        subprocess.run(launcher + [self.granrun, "run", str(file), "-q", "--threads", str(threads), "-o", str(case)],
                       check=True, env=self.environment, stdout=subprocess.DEVNULL)
        return json.loads((case / "run.json").read_text())["computing_seconds"]


def measure(machine, side, ranks, engine, steps):
    """Seconds of each part for `steps` DEM steps; and of LIGGGHTS alone."""
    alone, gather = None, 0.0
    spent = machine.seconds(scene(side, engine, steps, HEAT_STEPS, True, side**3), ranks)
    flow = spent["flow"]
    if engine == "liggghts":
        less, more = (machine.seconds(scene(side, engine, n, n, False, 0), ranks)["flow"] for n in (steps // 5, 2 * steps // 5))
        flow = alone = max(1e-9, 5 * (more - less))
        start = max(0.0, less - alone / 5)  # with one hand-over
        hand_overs = steps // HEAT_STEPS
        gather = max(0.0, spent["flow"] - alone - start) * hand_overs / (hand_overs - 1)
    reduce = min(spent["between_ranks"], spent["radiation"])
    return {"engine": engine, "spheres": side**3, "ranks": ranks, "steps": steps, "flow": flow,
            "gather": gather, "conduction": spent["conduction"], "rays": spent["radiation"] - reduce, "reduce": reduce,
            "output": spent["output"], "alone": alone}


def print_row(row):
    total = sum(row[p] for p in PARTS)
    shares = "  ".join(f"{p} {row[p]:.2f} s ({100 * row[p] / total:.0f} %)" for p in PARTS)
    print(f"{row['engine']:9} {row['spheres']:>8} spheres, {row['ranks']} ranks, {row['steps']} steps: {shares}", flush=True)
    if row["alone"]:
        over = 100 * (total / row["alone"] - 1)
        print(f"scale_{row['spheres']}_{row['ranks']} ours {total:.2f} s liggghts {row['alone']:.2f} s ratio "
              f"{row['alone'] / total:.3f}   (heat and hand-over cost {over:.0f} % of its flow)", flush=True)


def model(one, two, ranks, spheres):
    """Seconds of each part on `ranks` for `spheres`, from measurements of one bed on one and two ranks.

    a part that is shared (rays; with LIGGGHTS gather and conduction): t(R) = repeated + shared / R, both from R = 1 and 2; all
    in proportion to the spheres;
    the flow of LIGGGHTS: shared, with what two ranks lost to each other growing as the surface of a rank's part,
    (R / N)^(1/3); one exchange of heats a radiation update: the measured time, and a delay for log2 R steps."""
    size = spheres / one["spheres"]
    seconds = {}
    for part in PARTS:
        first, second = one[part] * size, two[part] * size
        if part == "rays" or (part in ("gather", "conduction") and one["engine"] == "liggghts"):
            repeated = min(max(0.0, 2 * second - first), first)
            seconds[part] = repeated + (first - repeated) / ranks
        elif part == "flow" and one["engine"] == "liggghts":
            lost = max(0.0, 2 * second / first - 1)
            seconds[part] = first / ranks * (1 + (lost * (ranks / 2 / size) ** (1 / 3) if ranks > 1 else 0))
        elif part == "reduce":
            updates = max(1, one["steps"] // RAY_STEPS)
            seconds[part] = (second + updates * NETWORK_DELAY_S * math.ceil(math.log2(ranks))) if ranks > 1 else 0
        else:
            seconds[part] = first
    return seconds


def print_model(rows, engine, out):
    fitting = [r for r in rows if r["engine"] == engine]
    largest = max(r["spheres"] for r in fitting)
    one, two = (next(r for r in fitting if r["spheres"] == largest and r["ranks"] == k) for k in (1, 2))
    for kind in ("strong", "weak"):
        print(f"\n{kind} scaling of {engine}, a model fitted to {largest} spheres "
              f"({'the same bed' if kind == 'strong' else f'{largest} spheres for each rank'}); seconds for {one['steps']} steps")
        print(f"{'ranks':>6} " + " ".join(f"{p:>10}" for p in PARTS) + f" {'total':>10} {'efficiency':>10}")
        base = None
        for power in range(11):
            ranks = 2**power
            t = model(one, two, ranks, largest * (1 if kind == "strong" else ranks))
            total = sum(t.values())
            base = base or total
            efficiency = base / total / (ranks if kind == "strong" else 1)
            print(f"{ranks:>6} " + " ".join(f"{t[p]:>10.3g}" for p in PARTS) + f" {total:>10.3g} {efficiency:>10.2f}")
            out.writerow([kind, engine, ranks] + [f"{t[p]:.5g}" for p in PARTS] + [f"{total:.5g}", f"{efficiency:.4f}"])


def print_cores(machine, beds):
    """The native flow on the cores of one node, from one and two threads.

    Threads have slabs along the longest axis. Pairs across a cut, a third of one of `side` layers, are worked on both sides.
    What two threads do not share beside that is serial in the largest bed, a part of the step that stays; what it is more in
    the smallest is waiting, a time a step that grows with log2 of the threads."""
    def share(threads, side): return (1 + (threads - 1) / (3 * side)) / threads
    lost, times = [], []
    for one in beds:
        side = round(one["spheres"] ** (1 / 3))
        t2 = machine.seconds(scene(side, "native", one["steps"], HEAT_STEPS, True, side**3), 1, threads=2)["flow"]
        times.append((side, one["flow"], t2))
        lost.append(max(0.0, (t2 / one["flow"] - share(2, side)) / (1 - share(2, side))))
    serial, wait_s = lost[-1], max(0.0, lost[0] - lost[-1]) * times[0][1] / beds[0]["steps"]
    print(f"\nnative flow on the cores of one node: serial {100 * serial:.1f} %, waiting {1e6 * wait_s:.1f} us a step; a model")
    for (side, t1, t2), one in zip(times, beds):
        grown = {2**k: serial + (1 - serial) * share(2**k, side) + k * wait_s * one["steps"] / t1 for k in range(1, 7)}
        print(f"{one['spheres']:>8} spheres: two threads {t1 / t2:.2f} x one; " +
              "  ".join(f"{n}: {1 / t:.1f}" for n, t in grown.items() if side / n >= 1.5))


def main():
    sides = (16,) if "--quick" in sys.argv else (27, 58, 100) if "--full" in sys.argv else (27, 58)
    granrun, folder = [a for a in sys.argv[1:] if not a.startswith("--")]
    folder = pathlib.Path(folder) / "scale"
    folder.mkdir(parents=True, exist_ok=True)
    machine = Machine(granrun, folder)
    print("CPU:", next((l.split(":")[1].strip() for l in open("/proc/cpuinfo") if l.startswith("model name")), "unknown"),
          f"x {os.cpu_count()}, load {os.getloadavg()[0]:.1f}")
    rows = []
    for side in sides:
        write_bed(folder / f"bed_{side}.csv", side)
        for engine in ("liggghts", "native"):
            for ranks in (1, 2):
                rows.append(measure(machine, side, ranks, engine, 1000))
                print_row(rows[-1])
    with open(folder / "scale.csv", "w") as file:
        out = csv.DictWriter(file, rows[0].keys())
        out.writeheader()
        out.writerows(rows)
    with open(folder / "scale_model.csv", "w") as file:
        out = csv.writer(file)
        out.writerow(["scaling", "engine", "ranks"] + PARTS + ["total", "efficiency"])
        for engine in ("liggghts", "native"):
            print_model(rows, engine, out)
    print_cores(machine, [r for r in rows if r["engine"] == "native" and r["ranks"] == 1])
    for side in sides: (folder / f"bed_{side}.csv").unlink()
    print("\nThe model's assumptions: one rank a node with one thread, as measured; a network as fast as this machine's memory "
          f"but for {1e6 * NETWORK_DELAY_S:.0f} us a step; beds cut evenly; native flow and conduction, temperatures and output as on one rank.")


main()
