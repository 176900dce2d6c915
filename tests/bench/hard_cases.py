#!/usr/bin/env python3
"""Hard cases of radiation as a table: every source on every case, its result beside the truth, or the refusal.

Usage: hard_cases.py GRANRUN TABLE.toml OUTPUT.md [--quick]

Each case is a frozen bed; the truth is a closed form, or follows from the case itself (nothing to exchange), or where
neither exists comes from traced paths with a hundred times the walks and other random numbers.
"""
import csv, math, pathlib, subprocess, sys, tempfile, time

SIGMA = 5.670374419e-8
SOURCES = ["paths", "embree", "lines", "shading", "correlation"]
REFERENCE_WALKS = 1000000
LIMIT_S, LIMIT_MANY_S = 60, 300


def box(hot_K, roles="adiabatic", size=(0.01, 0.004, 0.01), cold=None, emissivity=1.0):
    text = "[box]\nsize_m = [%g, %g, %g]\n" % size
    for name in ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]:
        text += "[walls.%s]\n" % name
        if name[0] == "y" and hot_K:
            kelvin = cold if cold and name == "y_max" else hot_K
            text += 'role = "isothermal"\ntemperature_K = %g\nemissivity = %g\n' % (kelvin, emissivity)
        else:
            text += 'role = "%s"\n' % roles
    return text


def scene(walls, particles, emissivity=1.0, end_s=0.02, every_s=0.01, extra="", radiation_s=0.01):
    return f"""# radiation every {radiation_s}
[scene]
name = "hard"
end_time_s = {end_s}
[material]
file = "alumina.toml"
emissivity = {emissivity}
[particles]
{particles}
{walls}
[dem]
engine = "none"
[conduction]
solid = false
{extra}
[output]
every_s = {every_s}
frames_every_s = {end_s}
"""


def bed(folder, spheres):
    """spheres: (x, y, z, r, T)"""
    path = folder / "bed.csv"
    path.write_text("x,y,z,radius,temperature\n" + "".join("%.9g,%.9g,%.9g,%.9g,%g\n" % s for s in spheres))
    return 'file = "bed.csv"'


def grid(nx, ny, nz, pitch, r, T, start=None):
    s = start if start is not None else pitch / 2
    return [(s + pitch * i, s + pitch * j, s + pitch * k, r, T) for k in range(nz) for j in range(ny) for i in range(nx)]


def grey_sphere_in_box(r, area_walls, e_sphere, e_wall, hot, cold):
    """Two-surface enclosure, exact where the hot walls surround a small sphere and e_wall = 1."""
    a = 4 * math.pi * r * r
    return SIGMA * (hot ** 4 - cold ** 4) / ((1 / e_sphere) / a + (1 / e_wall - 1) / area_walls)


def all_hot(hot_K, size=(0.01, 0.004, 0.01)):
    text = "[box]\nsize_m = [%g, %g, %g]\n" % size
    for name in ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"]:
        text += '[walls.%s]\nrole = "isothermal"\nemissivity = 1\ntemperature_K = %g\n' % (name, hot_K)
    return text


def cases(folder, quick):
    r, middle = 0.0004, (0.005, 0.002, 0.005, 0.0004, 300)
    lattice = lambda T: grid(11, 4, 11, 0.0009, r, T, 0.00048)
    lone = lambda e: ("W into a lone sphere", grey_sphere_in_box(r, 1, e, 1, 1000, 300), "first")
    tiny = dict(end_s=1e-4, every_s=1e-4, radiation_s=1e-4)
    heat = lambda e, **k: scene(all_hot(1000), bed(folder, [middle]), emissivity=e, **{**tiny, **k})
    yield "lone black sphere, hot box", heat(1), lone(1)
    yield "emissivity 1e-6", heat(1e-6), lone(1e-6)
    yield "emissivity 0.1", heat(0.1), lone(0.1)
    yield "bed, nothing hot: all walls adiabatic", scene(box(None), bed(folder, lattice(400))), ("heat, W", 0, "rate")
    mixed = lattice(400)
    mixed[len(mixed) // 2] = mixed[len(mixed) // 2][:4] + (300,)
    yield "one cold among hot, adiabatic box", scene(box(None), bed(folder, mixed)), ("mean T, K", sum(s[4] for s in mixed) / len(mixed), "T")
    yield "300 against 3000 K, 10 um", scene(all_hot(3000, (4e-4, 4e-4, 4e-4)), bed(folder, grid(8, 8, 8, 4.5e-5, 5e-6, 300)), end_s=0.02, every_s=0.02, radiation_s=5e-5), ("T, K", 3000, "T")
    yield "isothermal 700 K", scene(all_hot(700), bed(folder, lattice(700))), ("heat, W", 0, "rate")
    big = [(0.01, 0.01, 0.007, 0.005, 300)] + [(0.004 + 0.002 * i, 0.004 + 0.002 * j, 0.017, 5e-7, 300) for i in range(4) for j in range(4)]
    yield "1 um beside 10 mm", scene(all_hot(1000, (0.02, 0.02, 0.02)), bed(folder, big), end_s=1e-3, every_s=1e-3, radiation_s=1e-4), ("", 0, "reference")
    many = [(0.005, 0.005, 0.003, 0.0025, 300)] + [(0.001 + 0.0005 * i, 0.001 + 0.0005 * j, 0.008, 2.5e-7, 300) for i in range(16) for j in range(16)]
    yield "size ratio 1e4", scene(all_hot(1000, (0.01, 0.01, 0.01)), bed(folder, many), end_s=1e-4, every_s=1e-4, radiation_s=5e-5), ("", 0, "reference")
    yield "touching lattice", scene(box(1000), bed(folder, grid(12, 5, 6, 0.0008, r, 300, 0.0004))), ("", 0, "reference")
    yield "overlapping by 4 % of d", scene(box(1000), bed(folder, grid(12, 5, 6, 0.00077, r, 300, 0.0004))), ("", 0, "reference")
    yield "touching, jump 300/1000 K", scene(box(None), bed(folder, [s[:4] + (1000 if s[2] > 0.0025 else 300,) for s in grid(12, 5, 6, 0.0008, r, 300, 0.0004)])), ("", 0, "reference")
    yield "no particle", scene(box(1000), bed(folder, [])), ("runs", 0, "runs")
    yield "zero-area wall", scene(box(1000) + '[[polygon]]\nname = "line"\nvertices_m = [[0.002, 0.002, 0.002], [0.003, 0.002, 0.002], [0.004, 0.002, 0.002]]\nrole = "adiabatic"\n', bed(folder, [middle])), ("refused", 2, "refused")
    for count in [1000, 100000] if quick else [1000, 100000, 1000000]:
        n = round((count / 4) ** (1 / 3)) + 1
        side = 0.0009 * n
        walls = all_hot(1000, (side, side, 4 * side))
        yield f"{count} particles", scene(walls, bed(folder, grid(n, n, 4 * n, 0.0009, r, 300)[:count]), end_s=0.01), ("", 0, "reference")


def run(granrun, folder, text, source, table, extra=(), limit=LIMIT_S):
    (folder / "scene.toml").write_text(text)
    out = folder / "out"
    subprocess.run(["rm", "-rf", str(out)])
    words = [granrun, "run", "scene.toml", "-o", "out", "-q", "--set", "radiation.source=" + source, "--set", "radiation.every_s=" + text.splitlines()[0].split()[-1]]
    if source == "correlation":
        words += ["--set", "radiation.table=" + table]
    for setting in extra:
        words += ["--set", setting]
    begin = time.time()
    try:
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None, f"no end in {limit} s", limit
    rows = []
    if (out / "history.csv").exists():
        rows = list(csv.DictReader(open(out / "history.csv")))
    message = (done.stderr.strip().splitlines() or [""])[0]
    return (done.returncode, rows, out), message, time.time() - begin


def number(row, key):
    return float(row[key]) if row.get(key) else math.nan


def judge(result, truth, spheres):
    code, rows, out = result
    what, exact, kind = truth
    if kind == "refused":
        return "refused" if code == 2 else f"accepted (code {code})"
    if code != 0 or not rows:
        return ""
    if kind == "runs":
        return "runs"
    first = number(rows[0], "Q_rad_W")
    if kind == "first":
        return f"{first:.4g} W ({100 * (first / exact - 1):+.2g} %)"
    if kind == "rate":
        return f"{max(abs(number(r, 'Q_rad_W')) for r in rows):.2g} W"
    T = number(rows[-1], "mean_temperature_K")
    if kind == "T":
        return f"{T:.2f} K ({T - exact:+.2g} K)"
    return against(first, T, out, exact)


def temperatures(out):
    try:
        import h5py
    except ImportError:
        return None
    last = sorted((out / "frames").glob("*.hdf"))[-1]
    with h5py.File(last) as f:
        return f["VTKHDF/PointData/temperature"][:]


def against(heat, T, out, reference):
    """Heat and mean temperature against those of the reference, and the range of temperatures."""
    nothing_comes_in = abs(reference[0]) <= 5 * reference[2] + 1e-12
    shown = f"Q {heat:.2g} W" if nothing_comes_in else f"Q {100 * (heat / reference[0] - 1):+.2g} %"
    shown += f", T {T - reference[1]:+.2g} K"
    data = temperatures(out)
    if data is None:
        return shown
    low, high = data.min(), data.max()
    return shown + f", {low:.1f} to {high:.1f} K" + ("" if 299.99 <= low and high <= 1000.01 else " **beyond**")


def reference_of(granrun, folder, text, limit):
    """Heat, its error and mean temperature by many walks; None when it does not end."""
    result, message, _ = run(granrun, folder, text, "paths", "", [f"radiation.rays={REFERENCE_WALKS}", "radiation.seed=977"], 4 * limit)
    if not result or result[0] != 0 or not result[1]:
        return None
    row = result[1]
    return number(row[0], "Q_rad_W"), number(row[-1], "mean_temperature_K"), number(row[0], "Q_rad_error_W")


def main():
    granrun, table, output = sys.argv[1:4]
    quick = "--quick" in sys.argv
    lines = ["# Hard cases", "",
             "Made by `./do hard-cases`: every exchange source on every case, its result beside the truth, or what it says",
             "when it refuses; wall seconds in brackets. Where no closed form exists the truth is that of traced paths with a",
             "hundred times the walks. `**beyond**`: a temperature outside those of the walls and",
             "particles, which no heat exchange can give.", "",
             "| case | truth | " + " | ".join(SOURCES) + " |", "|---" * (len(SOURCES) + 2) + "|"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for label, text, truth in cases(folder, quick):
            what, exact, kind = truth
            limit = LIMIT_MANY_S if label.endswith("00000 particles") else LIMIT_S
            shown = f"{what} = {exact:.4g}" if kind in ("first", "rate", "T") else what
            if kind == "reference":
                exact = reference_of(granrun, folder, text, limit)
                if exact is None:
                    lines.append(f"| {label} | the reference does not end | " + " | ".join("" for _ in SOURCES) + " |")
                    continue
                shown = f"Q = {exact[0]:.4g} ± {exact[2]:.1g} W, T = {exact[1]:.2f} K ({REFERENCE_WALKS:.0e} walks)"
                truth = (what, exact, kind)
            cells = []
            for source in SOURCES:
                result, message, seconds = run(granrun, folder, text, source, str(pathlib.Path(table).resolve()), limit=limit)
                found = judge(result, truth, None) if result else ""
                cells.append(f"{found or 'refused: ' + message[:160] if result else message} [{seconds:.1f} s]".replace("|", "/"))
            lines.append(f"| {label} | {shown} | " + " | ".join(cells) + " |")
            print(lines[-1], flush=True)
    pathlib.Path(output).write_text("\n".join(lines).replace(str(pathlib.Path(table).resolve().parents[2]) + "/", "") + "\n")


main()
