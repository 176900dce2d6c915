"""No option is dead: every option that some --help lists stands in the table below, with a command in which it changes
what comes out (files, text or exit code), or with the reason why it may not; and every option is described in
docs/commands.md. Usage: options.py BIN SOURCE
Planted: an option --tilt added to vfgen trace and not used (not in the table; with an entry: nothing changes).
"""
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "page"))
from make_pages import SCENE, STUDY, TABLES  # noqa: E402

BIN, SOURCE = (pathlib.Path(p).resolve() for p in sys.argv[1:3])
ENVIRONMENT = dict(os.environ, GRANRAD_DATA=str(SOURCE / "data"), OMP_WAIT_POLICY="passive")

BED = "x,y,z,radius\n0.001,0.001,0.001,0.0004\n0.0022,0.0011,0.001,0.0004\n0.0012,0.003,0.0025,0.0004\n0.003,0.003,0.003,0.0004\n"
DUMP = "".join(f"ITEM: TIMESTEP\n{n}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n0 0.004\n0 0.004\n0 0.004\n"
               f"ITEM: ATOMS id x y z\n1 0.001 0.001 {z}\n2 0.003 0.003 0.003\n" for n, z in ((1, 0.001), (2, 0.002)))
STL = """solid lid
facet normal 0 0 -1
outer loop
vertex 0 0 0.004
vertex 0.004 0.004 0.004
vertex 0.004 0 0.004
endloop
endfacet
endsolid lid
"""

TRACE = "vfgen trace bed.csv --box 0.004,0.004,0.004 --rays 100 -o x.h5 -q"
FIT = "vfgen fit small.h5 -o t.toml -q"
MEASURE = "vfgen measure tall.csv --box 0.004,0.009,0.004 --rays 50 -o m -q"
RUN = "granrun run short.toml -o out -q"
STUDY_RUN = "granrun study study.toml -o out -q"
K = "granrun measure conductivity bed.toml --between y --rays 40 -o m -q"
REFUSED_WITHOUT = ("--resume", "--scene")  # that is what they are for
SAME = "results do not depend on it"
QUIET = {"-q": "only says less", "-v": "only says more"}

# program and command: {option: (command without it, command with it) or the reason why nothing changes}
TABLE = {
    "vfgen": QUIET,
    "vfgen trace": {
        "-o": (TRACE, TRACE.replace("x.h5", "y.h5")), "--method": (TRACE, TRACE + " --method lines"),
        "--rays": (TRACE, TRACE.replace("--rays 100", "--rays 200")),
        "--error": (TRACE, TRACE.replace("--rays 100", "--error 0.2")),
        "--hot-walls": (TRACE.replace("--rays 100", "--error 0.2"), TRACE.replace("--rays 100", "--error 0.2 --hot-walls y_min")),
        "--sampling": (TRACE, TRACE + " --sampling random"), "--memory": (TRACE, TRACE + " --memory 1KiB"),
        "--seed": (TRACE, TRACE + " --seed 2"), "--threads": SAME, "--emissivity": (TRACE, TRACE + " --emissivity 0.5"),
        "--wall-emissivity": (TRACE + " --emissivity 0.5", TRACE + " --emissivity 0.5 --wall-emissivity 0.5"),
        "--box": (TRACE, TRACE.replace("0.004,0.004,0.004", "0.005,0.004,0.004")),
        "--radius": ("vfgen trace two.dump --radius 0.0003 --rays 50 -o x.h5 -q", "vfgen trace two.dump --radius 0.0004 --rays 50 -o x.h5 -q"),
        "--step": ("vfgen trace two.dump --radius 0.0003 --rays 50 -o x.h5 -q", "vfgen trace two.dump --radius 0.0003 --rays 50 --step first -o x.h5 -q"),
        "--walls": (TRACE.replace("--box 0.004,0.004,0.004", ""), TRACE.replace("--box 0.004,0.004,0.004", "--walls lid.stl"))},
    "vfgen fit": {
        "-o": (FIT, FIT.replace("t.toml", "u.toml")), "--form": (FIT, FIT + " --form transmittance"),
        "--report": (FIT, FIT + " --report r.html"), "--cutoff": (FIT, FIT + " --cutoff 3"), "--pairs": (FIT, FIT + " --pairs visible"),
        "--fit-walls": (FIT, FIT + " --fit-walls x_min"), "--wall-distance": (FIT, FIT + " --wall-distance h_plus_r_over_d"),
        "--wall-reach": (FIT, FIT + " --wall-reach 2"), "--choices": (FIT, FIT + " --choices paper")},
    "vfgen generate": {"-o": ("vfgen generate tables.toml -o a -q", "vfgen generate tables.toml -o b -q"), "--threads": SAME},
    "vfgen check": {},
    "vfgen export": {"--to": ("vfgen export small.h5 --to csv -o e -q", "vfgen export small.h5 --to npz -o e -q"),
                     "-o": ("vfgen export small.h5 --to csv -o e -q", "vfgen export small.h5 --to csv -o f -q")},
    "vfgen keys": {"--md": "is the default", "--toml": ("vfgen keys", "vfgen keys --toml"), "--schema": ("vfgen keys", "vfgen keys --schema")},
    "vfgen curve": {"--form": ("vfgen curve xy.csv --form line", "vfgen curve xy.csv --form power"),
                    "-x": ("vfgen curve xy.csv --form line", "vfgen curve xy.csv --form line -x z"),
                    "-y": ("vfgen curve xy.csv --form line", "vfgen curve xy.csv --form line -y z"),
                    "-o": ("vfgen curve xy.csv --form line", "vfgen curve xy.csv --form line -o c.json")},
    "vfgen measure": {
        "-o": (MEASURE, MEASURE.replace("-o m", "-o n")), "--between": (MEASURE, MEASURE + " --between y"),
        "--emissivity": (MEASURE + " --between y", MEASURE + " --between y --emissivity 0.5"),
        "--rays": (MEASURE + " --between y", MEASURE.replace("--rays 50", "--rays 100") + " --between y"),
        "--box": (MEASURE, MEASURE.replace("0.004,0.009", "0.005,0.009")),
        "--radius": ("vfgen measure two.dump --radius 0.0003 -o m -q", "vfgen measure two.dump --radius 0.0004 -o m -q"),
        "--walls": ("vfgen measure bed.csv -o m -q", "vfgen measure bed.csv --walls lid.stl -o m -q"),
        "--seed": (MEASURE, MEASURE + " --seed 2"), "--threads": SAME},
    "granrun run": {
        "-o": (RUN, RUN.replace("-o out", "-o other")), "--set": (RUN, RUN + " --set material.emissivity=0.5"),
        "--unset": (RUN, RUN + " --unset radiation.rays"), "--walltime": (RUN, RUN + " --walltime 00:00:00"),
        "--resume": (RUN + " && " + RUN, RUN + " && " + RUN + " --resume"), "--threads": SAME, **QUIET},
    "granrun check": {"--set": ("granrun check short.toml", "granrun check short.toml --set material.emissivity=0.5"),
                      "--unset": ("granrun check short.toml", "granrun check short.toml --unset radiation.rays"),
                      "--defaults": ("granrun check short.toml", "granrun check short.toml --defaults"),
                      "--ranks": ("granrun check short.toml", "granrun check short.toml --ranks 2"),
                      "--slurm": ("granrun check short.toml --ranks 2", "granrun check short.toml --ranks 2 --slurm"), "--threads": SAME, **QUIET},
    "granrun validate": {
        "--emissivity": ("granrun validate frozen.toml -o v -q", "granrun validate frozen.toml -o v -q --emissivity 0.5"),
        "--max-error": ("granrun validate frozen.toml -o v -q", "granrun validate frozen.toml -o v -q --max-error 1e-9"),
        "--set": ("granrun validate frozen.toml -o v -q", "granrun validate frozen.toml -o v -q --set material.emissivity=0.5"),
        "--unset": ("granrun validate frozen.toml -o v -q", "granrun validate frozen.toml -o v -q --unset material.emissivity"),
        "-o": ("granrun validate frozen.toml -o v -q", "granrun validate frozen.toml -o w -q"), "--threads": SAME, **QUIET},
    "granrun study": {
        "-o": (STUDY_RUN + " --list", STUDY_RUN.replace("-o out", "-o other") + " --list"), "--walltime": (STUDY_RUN, STUDY_RUN + " --walltime 00:00:00"),
        "--jobs": SAME, "--case": (STUDY_RUN, STUDY_RUN + " --case emissivity-0.5"), "--list": (STUDY_RUN, STUDY_RUN + " --list"),
        "--quick": (STUDY_RUN, STUDY_RUN + " --quick"), "--any-version": "needs results of another version; granrun_study_test has them",
        "--book": (STUDY_RUN, STUDY_RUN + " --book b.md"), "--threads": SAME, **QUIET},
    "granrun measure": {},
    "granrun measure conductivity": {
        "--between": (K, K.replace("--between y", "--between x")), "--scene": ("granrun measure conductivity tall.csv --between y --rays 40 -o m -q",
                                                                             "granrun measure conductivity tall.csv --between y --scene bed.toml --rays 40 -o m -q"),
        "--temperature": (K, K + " --temperature 500"), "--rays": (K, K.replace("--rays 40", "--rays 80")),
        "--replicates": (K, K + " --replicates 3"), "--set": (K, K + " --set material.emissivity=0.5"),
        "--unset": (K, K + " --unset material.emissivity"), "-o": (K, K.replace("-o m", "-o n")), "--threads": SAME, **QUIET},
    "granrun report": {"--threads": SAME, **QUIET},
    "granrun export": {"--to": (RUN + " && granrun export out --to csv -q", RUN + " && granrun export out --to dump -q"), "--threads": SAME, **QUIET},
    "granrun render": {"-o": (RUN + " && granrun render out -o a.png -q", RUN + " && granrun render out -o b.png -q"), "--threads": SAME, **QUIET},
    "granrun new": {"--from": ("granrun new n.toml", "granrun new n.toml --from frozen")},
    "granrun keys": {"--md": "is the default", "--toml": ("granrun keys", "granrun keys --toml"), "--schema": ("granrun keys", "granrun keys --schema")},
}
TABLE["granrun sweep"] = TABLE["granrun study"]


def help_of(words):
    return subprocess.run([BIN / words[0], *words[1:], "--help"], capture_output=True, text=True, env=ENVIRONMENT).stdout


def commands(words):
    """Every command with the options its help lists: short name where there is one."""
    text = help_of(words)
    options, subs = text.partition("\nSubcommands:")[::2]
    found = re.findall(r"^  (-[\w-]+)(?:,(--[\w-]+))?", options, re.M)
    yield " ".join(words), [(a, b or a) for a, b in found if a not in ("-h", "--version", "--help-all")]
    for sub in re.findall(r"^  ([a-z]+) ", subs, re.M):
        yield from commands([*words, sub])


def inputs(folder):
    short = re.sub(r"\[validate\].*", "", SCENE, flags=re.S).replace("end_time_s = 0.2", "end_time_s = 0.02").replace("rays = 300", "rays = 50")
    frozen = SCENE[:SCENE.index("[[validate.compare]]")].replace("times_s = [0.02, 0.1]", "times_s = [0.01]") + \
        '[[validate.compare]]\nsource = "lines"\nrays = 100\n'
    study = '[study]\nscene = "short.toml"\n[[vary]]\nkey = "material.emissivity"\nvalues = [0.5, 1]\nquick = ["emissivity-1"]\n[claims]\nfile = "claims.csv"\n'
    tall = "x,y,z,radius\n" + "".join(f"{0.001 + 0.002 * (k % 2)},{0.0005 + 0.0009 * k},{0.001 + 0.002 * (k // 2 % 2)},0.0004\n" for k in range(9))
    small = "x,y,z,radius\n" + "".join(f"{0.0005 + 0.001 * i},{0.0005 + 0.001 * j},{0.0005 + 0.001 * k + 0.0001 * ((i + j) % 2)},0.0004\n"
                                        for i in range(4) for j in range(4) for k in range(4))
    tables = TABLES.replace("[0.07, 0.25]", "[0.1]").replace("count = 2", "count = 1")
    claims = "id,quantity,class,place,claim,unit,reference,uncertainty,tolerance_pct,ours,why\n1,h,A,here,h,,1,,1,{emissivity-1:h_wp_W_m2K},so\n"
    for name, text in (("bed.csv", BED), ("two.dump", DUMP), ("lid.stl", STL), ("short.toml", short), ("frozen.toml", frozen), ("bed.toml", SCENE.replace("[validate]", "#").split("#")[0]),
                       ("study.toml", study), ("tall.csv", tall), ("small.csv", small), ("tables.toml", tables), ("claims.csv", claims),
                       ("xy.csv", "x,y,z\n1,2,1\n2,3,4\n3,5,9\n4,6,15\n")):
        (folder / name).write_text(text)
    subprocess.run([BIN / "vfgen", "trace", "small.csv", "--box", "0.004,0.004,0.0041", "--rays", "200", "-o", "small.h5", "-q"], cwd=folder, check=True)


KEPT = {}


def outcome(command):
    """Exit code, text and files (by content, where no clock is in it) that a command line leaves."""
    if command in KEPT:
        return KEPT[command]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        inputs(folder)
        before = set(folder.rglob("*"))
        line = re.sub(r"(^|&& )(vfgen|granrun) ", lambda m: f"{m[1]}{BIN / m[2]} ", command)
        done = subprocess.run(["bash", "-c", line], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True)
        files = {}
        for path in sorted(set(folder.rglob("*")) - before):
            timed = path.suffix in (".html", ".json", ".log") or path.name in (".lock", "study.csv", "sweep.csv", "validation.csv") or "case" in path.name
            if path.is_file():
                files[str(path.relative_to(folder))] = "" if timed and "measure" not in path.name else hashlib.sha1(path.read_bytes()).hexdigest()
        said = re.sub(r"[\d.]+ s\b|/tmp/\S+", "", done.stdout + done.stderr)
        KEPT[command] = done.returncode, said, files
    return KEPT[command]


def main():
    faults = []
    described = (SOURCE / "docs/commands.md").read_text()
    for program in ("granrun", "vfgen"):
        for command, options in commands([program]):
            table = TABLE.get(command, None if program != command else {})
            if table is None:
                faults.append(f"{command} is not in the table")
                continue
            for short, long in options:
                entry = table.get(short, table.get(long))
                if entry is None:
                    faults.append(f"{command} {long}: not in the table: give a command in which it changes something")
                elif not isinstance(entry, str) and long not in REFUSED_WITHOUT and outcome(entry[0])[0] != 0:
                    faults.append(f"{command} {long}: {entry[0]}: exit {outcome(entry[0])[:2]}")
                elif not isinstance(entry, str) and outcome(entry[0]) == outcome(entry[1]):
                    faults.append(f"{command} {long}: {entry[1]}: nothing changes: {outcome(entry[1])[:2]}")
                if long not in described:
                    faults.append(f"{command} {long}: not in docs/commands.md; ./do docs makes it anew")
            for option in set(table) - {name for pair in options for name in pair}:
                faults.append(f"{command} {option}: in the table, but the help does not list it")
    text = (SOURCE / "do").read_text()
    for word in re.findall(r"^  ([a-z][a-z-]*(?: \| [a-z-]+)*)\)$", text, re.M):
        for one in word.split(" | "):
            if one not in ("help",) and one not in subprocess.run(["bash", SOURCE / "do", "help"], capture_output=True, text=True).stdout:
                faults.append(f"./do {one}: ./do help does not say so")
    print("\n".join(faults) or "every option changes something")
    return bool(faults)


sys.exit(main())
