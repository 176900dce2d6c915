"""A mistyped subcommand or option is answered with the one that was meant, for every one there is; a value that is no
choice with the choices; messages within 80 columns, on a terminal within its width. Usage: manners.py BIN
Planted, seen to fail: suggestions looked up among the options of the program alone (options of subcommands: no guess);
messages not broken on a terminal.
"""
import os
import pathlib
import pty
import re
import subprocess
import sys

BIN = pathlib.Path(sys.argv[1]).resolve()
faults = []


def run(*words, usage=True):
    done = subprocess.run([BIN / words[0], *words[1:]], capture_output=True, text=True)
    for line in [] if not usage else done.stderr.splitlines():
        if len(line) > 80 and " " in line.strip():
            faults.append(f"{' '.join(words)}: {len(line)} columns: {line}")
    return done


def commands(words):
    options, subs = run(*words, "--help").stdout.partition("\nSubcommands:")[::2]
    names = re.findall(r"^  ([a-z]+) ", subs, re.M)
    yield words, names, [b for b in re.findall(r"^  (?:-\w,)?(--[\w-]+)", options, re.M) if b not in ("--help", "--version", "--help-all")]
    for name in names:
        yield from commands([*words, name])


def mistyped(word):
    """Two letters exchanged: one edit."""
    k = next(k for k in range(len(word) - 2, 0, -1) if word[k] != word[k + 1] and word[k] != "-")
    return word[:k] + word[k + 1] + word[k] + word[k + 2:]


def check_suggestions():
    count = 0
    for program in ("granrun", "vfgen"):
        for words, names, options in commands([program]):
            for meant in [*names, *options]:
                typed = mistyped(meant)
                if typed in names + options:
                    continue
                done = run(*words, typed)
                count += 1
                if done.returncode != 2 or f"did you mean {meant}?" not in re.sub(r"\s+", " ", done.stderr) or "--help" not in done.stderr:
                    faults.append(f"{' '.join(words)} {typed}: {done.returncode}: {done.stderr}")
    if count < 100:
        faults.append(f"only {count} words were tried")


def check_choices():
    for words, said in ((("granrun", "keys", "stdy"), "must be scene, study or table"), (("granrun", "keys", "stdy"), "did you mean study?"),
                        (("granrun", "export", "out", "--to", "vtk"), "must be vtp, dump, csv or npz"),
                        (("granrun",), "granrun needs a subcommand: run"), (("vfgen",), "vfgen needs a subcommand: trace"),
                        (("granrun", "simulate"), "it has run, check"), (("granrun", "new", "x.toml", "--from", "plg"), "did you mean plug?"),
                        (("granrun", "run", "x.toml"), "--output is required")):
        done = run(*words)
        if done.returncode != 2 or said not in re.sub(r"\s+", " ", done.stderr):
            faults.append(f"{' '.join(words)}: {done.returncode}: {done.stderr}")


def on_terminal(columns, *words):
    """What a program says on a terminal of so many columns."""
    import fcntl
    import struct
    import termios
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 40, columns, 0, 0))
    process = subprocess.Popen([BIN / words[0], *words[1:]], stdout=subprocess.DEVNULL, stderr=its)
    os.close(its)
    text = b""
    try:
        while part := os.read(ours, 4096):
            text += part
    except OSError:  # the other end is closed
        pass
    process.wait()
    return text.decode().replace("\r\n", "\n")


def check_terminal():
    words = ("granrun", "report", "nowhere_to_be_found")
    whole = run(*words, usage=False).stderr  # one line in a pipe
    for columns in (40, 60):
        text = on_terminal(columns, *words)
        if max(map(len, text.splitlines())) > columns or text.split() != whole.split():
            faults.append(f"on a terminal of {columns} columns: {text}")


check_suggestions()
check_choices()
check_terminal()
print("\n".join(faults) or "well mannered")
sys.exit(bool(faults))
