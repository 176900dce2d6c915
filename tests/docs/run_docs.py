"""What README and docs say is so: every file they name exists, every command and every Python block they show runs, and
the references made of the programs are up to date. Usage: run_docs.py BIN SOURCE [PYTHONPATH]
Planted, seen to fail: a definition of equations.md taken out. Meant to catch: a link to a page that is not there; an option that does not exist; a renamed key in scene.md.
"""
import csv
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

BIN, SOURCE = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
PYTHON = sys.argv[3] if len(sys.argv) > 3 else ""
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *sorted((SOURCE / "docs").glob("*.md"))]
# Made elsewhere or needing more than a test may take: set-up, installation, shell plumbing.
NOT_RUN = ("./do", "cmake", "apt", "export", "docker", "pkg-config", "paraview")
faults = []


def blocks(page, language):
    return re.findall(rf"^```{language}\n(.*?)^```", page.read_text(), re.S | re.M)


def check_links():
    for page in PAGES:
        text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.S | re.M)
        for link in re.findall(r"\]\(([^)#\s]+)", text):
            if not link.startswith(("http:", "https:")) and not (page.parent / link).exists():
                faults.append(f"{page.name}: {link} does not exist")
        for name in re.findall(r"`((?:data|dem|raytrace|fit|coupling|tests|packaging|docs|cmake)/[\w./-]*[\w/])`", text):
            if not (SOURCE / name).exists():
                faults.append(f"{page.name}: {name} does not exist")


def run_commands(folder):
    environment = dict(os.environ, PATH=f"{BIN}:{os.environ['PATH']}", GRANRAD_DATA=str(SOURCE / "data"), OMP_WAIT_POLICY="passive")
    (folder / "data").symlink_to(SOURCE / "data")
    for page in PAGES:
        for block in blocks(page, "sh"):
            for line in block.splitlines():
                command = line.split("  #")[0].strip()
                if not command or command.startswith(("#", *NOT_RUN)):
                    continue
                words = shlex.split(command)
                if words[:2] == ["granrun", "run"] and "--set" not in words and "--resume" not in words:
                    command += " --set scene.end_time_s=0.05 -q"  # shortened
                done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True)
                if done.returncode:
                    faults.append(f"{page.name}: {command}: exit {done.returncode}: {done.stderr.strip()[-300:]}")
    return folder


def run_python(folder):
    if not PYTHON:
        print("no Python package in this build: its blocks are not run")
        return
    environment = dict(os.environ, PYTHONPATH=PYTHON, GRANRAD_BIN=str(BIN), GRANRAD_DATA=str(SOURCE / "data"))
    for page in PAGES:
        for block in blocks(page, "python"):
            done = subprocess.run([os.environ.get("PYTHON", "/usr/bin/python3"), "-c", block], cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode:
                faults.append(f"{page.name}: python: {done.stderr.strip()[-300:]}")


def check_promises(folder):
    """Numbers that the tutorials tell, within their errors."""
    results = json.loads((folder / "exchanger/out/run.json").read_text())["results"]["means"]
    if not 92 <= results["h_wp_W_m2K"] <= 102:
        faults.append(f"tutorial_exchanger.md: h = {results['h_wp_W_m2K']}")
    with open(folder / "exchanger/sweep/study.csv") as table:
        h = {row["case"]: float(row["h_wp_W_m2K"]) for row in csv.DictReader(table)}
    for case, told in (("phi-0.07_eps-0.4", 20), ("phi-0.25_eps-0.4", 47), ("phi-0.43_eps-0.4", 97), ("phi-0.07_eps-1", 52), ("phi-0.25_eps-1", 99), ("phi-0.43_eps-1", 152)):
        if abs(h[case] / told - 1) > 0.04:
            faults.append(f"tutorial_exchanger.md: {case}: h = {h[case]}")
    dump = json.loads((folder / "dump/out/results.json").read_text())
    for name, told in (("wedge.heaters", 10.6), ("surroundings", -2.3)):
        if abs(dump["walls"][name]["Q_W"]["mean"] / told - 1) > 0.03:
            faults.append(f"tutorial_dump.md: {name} gives {dump['walls'][name]['Q_W']}")


def check_versions():
    """A package's name and the version asked of find_package are those of this source."""
    version = re.search(r"project\(granrad VERSION (\d+\.\d+)(\.\d+)", (SOURCE / "CMakeLists.txt").read_text())
    for page in [*PAGES, SOURCE / "packaging/example/CMakeLists.txt"]:
        text = page.read_text()
        for named in re.findall(r"find_package\(granrad (\S+) ", text):
            if named != version[1]:
                faults.append(f"{page.name}: version {named} in place of {version[1]}")
        for named in re.findall(r"granrad(?:-\w+)?_(\d[\d.]*)_amd64", text):
            if named != version[1] + version[2]:
                faults.append(f"{page.name}: a package of version {named}")


def check_definitions(folder):
    """Every quantity of history.csv, walls.csv and results.json is defined in the page of equations, and nothing else is."""
    page = (SOURCE / "docs/equations.md").read_text()
    defined = set(re.findall(r"`(\w+)`", page[page.index("## Results, defined"):]))
    case = folder / "exchanger/out"
    names = {name for table in ("history.csv", "walls.csv") for name in (case / table).read_text().splitlines()[0].split(",")}
    results = json.loads((case / "results.json").read_text())
    of_files = {"format", "format_version", "scene", "radiation"}
    names |= set(results) - of_files | set(results["window"]) | set(results["means"])
    names |= {key for entries in (results["means"], results["walls"]) for entry in entries.values() for key in entry}
    faults.extend(f"equations.md: {name} has no definition" for name in sorted(names - defined))
    faults.extend(f"equations.md: {name} is in no file" for name in sorted(defined - names - {"q_ss", "q_sfs", "q_rad", "note"}))


def check_references():
    for page, command in (("scene.md", ["granrun", "keys"]), ("study_keys.md", ["granrun", "keys", "study"]), ("tables.md", ["granrun", "keys", "table"]), ("generate.md", ["vfgen", "keys"])):
        made = subprocess.run([BIN / command[0], *command[1:]], capture_output=True, text=True, check=True).stdout
        if not (SOURCE / "docs" / page).read_text().endswith(made):
            faults.append(f"docs/{page} is not what {' '.join(command)} says; ./do docs makes it anew")


check_links()
check_versions()
check_references()
with tempfile.TemporaryDirectory() as name:
    folder = run_commands(pathlib.Path(name))
    check_promises(folder)
    check_definitions(folder)
    run_python(folder)
print("\n".join(faults) or "all true")
sys.exit(bool(faults))
