"""What `granrun check` foresees beside what `granrun run` took, by part, for shipped scenes.

Usage: forecast.py GRANRUN SCENES FOLDER [--quick]
Prints a Markdown table and writes forecast.csv. Seconds are elapsed: on a machine with other work they mean nothing.
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

PARTS = ("flow", "conduction", "radiation", "output")
SCENES = [  # scene, what is set, which --quick leaves out
    ("plug_phi025.toml", ["scene.end_time_s=1"], True),
    ("plug_phi043.toml", ["scene.end_time_s=0.5", "radiation.source=lines", "radiation.rays=2400"], False),
    ("static_phi025.toml", ["scene.end_time_s=5", "radiation.source=embree", "radiation.rays=2000",
                            "material.emissivity=0.7"], True),
    ("moving_bed_short.toml", ["scene.end_time_s=0.3"], False),
    ("demo.toml", [], True),
    ("static_phi043.toml", ["scene.end_time_s=2", "radiation.source=paths", "radiation.rays=20000"], False),
]
UNIT = {"s": 1, "min": 60, "h": 3600, "days": 86400}


def numbers(text, pattern):
    found = re.search(pattern, text)
    if not found:
        sys.exit(f"no line like {pattern!r} in\n{text}")
    line = found.group(0)
    return {part: float(value) * UNIT[unit] for part, value, unit in
            re.findall(r"(\w+) ([\d.e+-]+) (s|min|h|days)\b", line) if part in PARTS}


def main():
    granrun, scenes, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    print("| scene | part | foreseen, s | taken, s | ratio |\n|---|---|--:|--:|--:|")
    for name, settings, quick in SCENES:
        if "--quick" in sys.argv and not quick:
            continue
        options = [word for one in settings for word in ("--set", one)]
        check = subprocess.run([granrun, "check", scenes / name, *options], capture_output=True, text=True, check=True)
        foreseen = numbers(check.stdout, r"flow .*: about")
        with tempfile.TemporaryDirectory() as out:
            subprocess.run([granrun, "run", scenes / name, "-q", "-o", out + "/case", *options], check=True)
            seconds = json.loads(pathlib.Path(out, "case", "run.json").read_text())["computing_seconds"]
            taken = {part: seconds[part] for part in PARTS}
        foreseen["all"], taken["all"] = sum(foreseen.values()), sum(taken.values())
        for part in (*PARTS, "all"):
            a, b = foreseen.get(part, 0), taken.get(part, 0)
            if b < 0.05 * taken["all"] and a < 0.05 * foreseen["all"]:
                continue
            rows.append([name, part, a, b])
            print(f"| {name} | {part} | {a:.3g} | {b:.3g} | {a / b if b > 0 else float('nan'):.2f} |", flush=True)
    with open(folder / "forecast.csv", "w", newline="") as file:
        csv.writer(file).writerows([["scene", "part", "foreseen_s", "taken_s"], *rows])


main()
