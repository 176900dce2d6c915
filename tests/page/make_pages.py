"""One page of each command, small: granrun report, validate, study, measure; vfgen fit, generate, measure.
Usage: make_pages.py BIN SOURCE FOLDER. Prints the pages."""
import os
import pathlib
import subprocess
import sys

SCENE = """[scene]
name = "small frozen bed"
end_time_s = 0.2
[material]
file = "alumina.toml"
emissivity = 0.8
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
[box]
size_m = [0.004, 0.007, 0.004]
[walls.x_min]
role = "adiabatic"
[walls.x_max]
role = "adiabatic"
[walls.y_min]
role = "isothermal"
temperature_K = 1000
[walls.y_max]
role = "isothermal"
temperature_K = 1000
[walls.z_min]
role = "adiabatic"
[walls.z_max]
role = "adiabatic"
[feed]
kind = "plug"
solid_fraction = 0.2
velocity_m_s = 0.1
seed = 1
[dem]
engine = "none"
[conduction]
solid = false
[radiation]
source = "paths"
rays = 300
[output]
every_s = 0.01
frames_every_s = 0.1
[validate]
times_s = [0.02, 0.1]
[validate.reference]
source = "paths"
rays = 2000
[[validate.compare]]
source = "embree"
ladder = [100, 400, 1600]
[[validate.compare]]
source = "lines"
ladder = [200, 2000]
[[validate.compare]]
source = "paths"
ladder = [50, 500]
[[validate.compare]]
source = "correlation"
table = "tables/transmittance.toml"
"""

TABLES = """title = "Small packings"
[snapshots]
solid_fractions = [0.07, 0.25]
size_m = [0.006, 0.004, 0.006]
diameter_m = "0.8 mm"
count = 2
sweeps = 20
[trace]
method = "lines"
rays = 1000
[fit]
form = "both"
"""

STUDY = """[study]
title = "Emissivity and wall temperature"
scene = "bed.toml"
set = ["radiation.rays=100"]
seeds = [1, 2]
seed_key = "radiation.seed"
[[vary]]
key = "material.emissivity"
values = [0.4, 0.7, 1]
[[vary]]
keys = ["walls.y_min.temperature_K", "walls.y_max.temperature_K"]
name = "Tw"
values = [700, 1000]
[[fit]]
name = "h of emissivity"
x = "material.emissivity"
y = "h_rad_W_m2K"
form = "power"
[[case]]
name = "impossible"
set = ["material.emissivity=2"]
[claims]
file = "claims.csv"
"""

CLAIMS = """id,quantity,class,place,claim,unit,reference,uncertainty,tolerance_pct,ours,why
1,coefficient,P,"Example (2024), figure 3","radiative coefficient of the bed at emissivity 1 and 1000 K walls",W/m2K,150,,5,{emissivity-1_Tw-1000:h_rad_W_m2K},"a made-up number, so that the page shows a difference and the words that explain it at some length"
2,ratio,A,here,"h beside itself",,1,,0.1,{emissivity-1_Tw-1000:h_rad_W_m2K} / {emissivity-1_Tw-1000:h_rad_W_m2K},
"""


def make(bin, source, folder):
    environment = dict(os.environ, GRANRAD_DATA=str(source.resolve() / "data"), OMP_WAIT_POLICY="passive")

    def run(*command, codes=(0,)):
        done = subprocess.run([str(c) for c in command], cwd=folder, env=environment, capture_output=True, text=True)
        if done.returncode not in codes:
            raise SystemExit(f"{command}: exit {done.returncode}: {done.stderr}")

    bin, source, folder = bin.resolve(), source.resolve(), folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in (("bed.toml", SCENE), ("tables.toml", TABLES), ("study.toml", STUDY), ("claims.csv", CLAIMS)):
        (folder / name).write_text(text)
    run(bin / "vfgen", "generate", "tables.toml", "-o", "tables", "-q", codes=(0, 4))
    run(bin / "granrun", "run", "bed.toml", "-o", "case", "-q")
    run(bin / "granrun", "report", "case", "-q")
    run(bin / "granrun", "validate", "bed.toml", "-o", "validate", "-q")
    run(bin / "granrun", "study", "study.toml", "-o", "study", "-q", codes=(0, 2))
    run(bin / "granrun", "measure", "conductivity", "bed.toml", "--between", "y", "--rays", 100, "-o", "measure", "-q")
    frame = sorted((folder / "case/frames").glob("*.hdf"))[-1]
    run(bin / "vfgen", "measure", frame, "--between", "y", "--rays", 200, "-o", "bed", "-q")
    return [folder / name for name in ("case/report.html", "validate/report.html", "study/report.html", "measure/report.html",
                                       "bed/report.html", "tables/cubic.html", "tables/transmittance.html")]


if __name__ == "__main__":
    print("\n".join(str(page) for page in make(*map(pathlib.Path, sys.argv[1:4]))))
