"""Results of granrun, read back."""
import json
from pathlib import Path

import h5py
import numpy as np

from . import _granrad


def _table(file):
    if not file.is_file():
        raise _granrad.IoError(f"{file}: cannot be read")
    try:
        import pandas
    except ImportError:
        return np.genfromtxt(file, delimiter=",", names=True, dtype=None, encoding="utf-8")
    return pandas.read_csv(file)


def read_study(folder):
    """Table of `granrun study` in its folder, one row a point: case, status, the varied keys, means and their errors
    (NAME_stderr), SI units. A pandas.DataFrame, or a structured array without pandas."""
    folder = Path(folder)
    return _table(next((folder / name for name in ("study.csv", "sweep.csv") if (folder / name).is_file()), folder / "study.csv"))


class Case:
    """The folder of a run: Case("out/plug")."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "scene.toml").is_file():
            raise _granrad.InputError(f"{folder}: is not a case of granrun (it has no scene.toml)")

    def history(self):
        """history.csv, one row an output: a pandas.DataFrame, or a structured array without pandas. SI units."""
        return _table(self.folder / "history.csv")

    def walls(self):
        """walls.csv, one row an output and wall: heats received from each wall by each way, W."""
        return _table(self.folder / "walls.csv")

    def results(self):
        """Means with their standard errors, as a dict."""
        for name in ("results.json", "run.json"):
            if (self.folder / name).is_file():
                return json.loads((self.folder / name).read_text())
        return {}

    def frames(self):
        """Files of the frames, by step."""
        return sorted((self.folder / "frames").glob("*.hdf"))

    def frame(self, number=-1):
        """One frame as a dict of arrays: position_m [N, 3], and every column by its name: id, material, radius (m),
        temperature (K), v (m/s), omega (rad/s), q_rad, q_ss, q_sfs (W received by radiation, contacts, gas)."""
        with h5py.File(self.frames()[number]) as f:
            data = f["VTKHDF/PointData"]
            out = {name: data[name][:] for name in data}
            out["position_m"] = f["VTKHDF/Points"][:]
            return out
