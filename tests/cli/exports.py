"""What the programs export is read by numpy and scipy as the HDF5 files hold it. Usage: exports.py BIN SOURCE
Planted, seen to fail: rows and columns exchanged in mtx; indices of 1 in npz; the height of a wall taken
from its back; positions of a frame left outside the period.
"""
import csv
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import scipy.io
import scipy.sparse as sp

BIN, SOURCE = map(pathlib.Path, sys.argv[1:3])
ENVIRONMENT = dict(os.environ, GRANRAD_DATA=str(SOURCE / "data"), OMP_WAIT_POLICY="passive")


def run(*command, code=0):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=ENVIRONMENT)
    assert done.returncode == code, (command, done.returncode, done.stderr)
    return done.stderr


def stored(file):
    with h5py.File(file) as f:
        v = f["view_factors"]
        pattern = v["column"][:], v["row_begin"][:]
        n = len(pattern[1]) - 1
        matrices = [sp.csr_matrix((v[name][:], *pattern), shape=(n, n)) for name in ("value", "standard_error")]
        return *matrices, {name: f[name][:] for name in ("surfaces/area", "snapshot/centre", "snapshot/radius")}


def same(ours, theirs):
    """Equal to the last digit or so: what is read from a file is multiplied by the area and divided again."""
    ours, theirs = (m.toarray() if sp.issparse(m) else np.asarray(m) for m in (ours, theirs))
    return np.allclose(ours, theirs, rtol=1e-14, atol=0)


def view_factors(folder):
    bed = folder / "bed.csv"
    bed.write_text("x,y,z,radius\n0.002,0.002,0.002,0.0004\n0.0032,0.0021,0.002,0.0004\n0.0009,0.001,0.0035,0.0003\n")
    traced = folder / "bed.h5"
    run(BIN / "vfgen", "trace", bed, "--box", "0.004,0.004,0.005", "--rays", 2000, "-o", traced, "-q")
    F, error, more = stored(traced)
    for kind in ("npz", "mtx"):
        run(BIN / "vfgen", "export", traced, "--to", kind, "-q")
    run(BIN / "vfgen", "export", traced, "--to", "csv", "-o", folder / "pairs.csv", "-q")
    assert same(sp.load_npz(folder / "bed.npz"), F)
    with np.load(folder / "bed.npz") as arrays:
        assert same(arrays["standard_error"], error.data)
        assert np.array_equal(arrays["area_m2"], more["surfaces/area"])
        assert np.array_equal(arrays["centre_m"], more["snapshot/centre"])
        assert np.array_equal(arrays["radius_m"], more["snapshot/radius"])
        assert list(arrays["name"].astype(str)[-2:]) == ["z_max", "open"]
    assert same(scipy.io.mmread(folder / "bed.mtx"), F)
    assert same(scipy.io.mmread(folder / "bed.standard_error.mtx"), error)
    heights = {"x_min": (0, 0), "x_max": (0, 0.004), "y_min": (1, 0), "y_max": (1, 0.004), "z_min": (2, 0), "z_max": (2, 0.005)}
    rows = list(csv.DictReader(open(folder / "pairs.csv")))
    assert len(rows) == F.nnz
    centres = more["snapshot/centre"]
    for row in rows:
        i, j = int(row["from"]), int(row["to"])
        assert same(float(row["factor"]), F[i, j]) and same(float(row["standard_error"]), error[i, j])
        first, second = sorted((i, j))
        if second < 3:
            assert np.isclose(float(row["distance_m"]), np.linalg.norm(centres[i] - centres[j]), rtol=1e-12)
        elif first < 3:
            axis, plane = heights[row["to_name"] if j > i else row["from_name"]]
            assert np.isclose(float(row["distance_m"]), abs(centres[first][axis] - plane), rtol=1e-9)
        else:
            assert row["distance_m"] == ""
    assert "not published" in run(BIN / "vfgen", "export", traced, "--to", "aspherix", code=2)
    run(BIN / "vfgen", "export", folder / "none.h5", "--to", "npz", code=3)
    run(BIN / "vfgen", "export", traced, "--to", "npz", "-o", "/proc/none/x.npz", code=3)
    first = (folder / "bed.npz").read_bytes()
    run(BIN / "vfgen", "export", traced, "--to", "npz", "-q")
    assert (folder / "bed.npz").read_bytes() == first, "equal content, equal bytes"


SCENE = """[scene]
end_time_s = 0.02
[material]
file = "alumina.toml"
[particles]
file = "flying.csv"
temperature_K = 500
[box]
size_m = [0.004, 0.004, 0.005]
periodic = ["x"]
[conduction]
solid = false
[output]
every_s = 0.01
frames_every_s = 0.01
"""


def frames(folder):
    (folder / "flying.csv").write_text("x,y,z,radius,vx,vy,vz\n0.0035,0.001,0.002,0.0004,0.1,0,0\n0.001,0.003,0.002,0.0004,0,0.01,0\n")
    walls = "".join(f'[walls.{face}]\nrole = "adiabatic"\n' for face in ("y_min", "y_max", "z_min", "z_max"))
    (folder / "flying.toml").write_text(SCENE + walls)
    run(BIN / "granrun", "run", folder / "flying.toml", "-o", folder / "case", "-q")
    run(BIN / "granrun", "export", folder / "case", "--to", "npz", "-q")
    files = sorted((folder / "case/export").glob("*.npz"))
    assert len(files) == 3
    wrapped = 0
    for file in files:
        with np.load(file) as arrays, h5py.File(folder / "case/frames" / (file.stem + ".hdf")) as frame:
            data, low, high = frame["granrad/particles"], *arrays["box_m"]
            for name in data:
                if name != "position_m":
                    assert np.array_equal(arrays[name], data[name][:]), name
            at = arrays["position_m"]
            wrapped += np.any(at != data["position_m"][:])
            moved = (at - data["position_m"][:]) / (high - low)
            assert np.allclose(moved, np.round(moved), atol=1e-9) and np.all(moved[:, arrays["periodic"] == 0] == 0)
            inside = arrays["periodic"] == 1
            assert np.all((at >= low - 1e-12)[:, inside] & (at <= high + 1e-12)[:, inside])
            assert float(arrays["time_s"]) == frame["granrad"].attrs["time_s"]
    assert wrapped, "a particle leaves the period in this test"


with tempfile.TemporaryDirectory() as name:
    view_factors(pathlib.Path(name))
    frames(pathlib.Path(name))
print("read back as written")
