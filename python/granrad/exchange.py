"""View factors and total exchange factors of arrays and files, and fits to them."""
import os
import shutil
import subprocess
from dataclasses import dataclass

import h5py
import numpy as np
import scipy.sparse as sp

from . import _granrad


@dataclass
class ViewFactors:
    """Closed exchange factors of an enclosure of N particles, W walls and the surroundings, in this order.

    F               [N+W+1, N+W+1] scipy.sparse.csr_matrix: row i, column j is F_ij (grey: the fraction D_ij of what i
                    emits that j absorbs); rows of surfaces that send rays sum to 1
    standard_error  [N+W+1, N+W+1] csr_matrix, one sigma of each F_ij on the same pattern
    area_m2         [N+W+1] m^2; 0 for the surroundings; for total exchange, emissivity times area
    names           N+W+1 texts
    particles       N
    """

    F: sp.csr_matrix
    standard_error: sp.csr_matrix
    area_m2: np.ndarray
    names: list
    particles: int
    failed: str = ""

    def __post_init__(self):
        if self.F.shape[0] != self.F.shape[1]:
            raise ValueError("view factors form a square matrix")

    def to_wall(self, name):
        """F from every particle to the wall `name`: [N]."""
        column = self.names.index(name)
        return self.F[:self.particles, column].toarray().ravel()


def _square(value, column, row_begin):
    # Without the shape a matrix would end at the last column that is not empty.
    count = len(row_begin) - 1
    return sp.csr_matrix((value, column, row_begin), shape=(count, count))


def trace(centres, radii, *, box=None, walls=None, method="embree", rays=10000, error=None, emissivity=None,
          wall_emissivity=None, seed=1, threads=0):
    """Traces view factors of spheres: a ViewFactors.

    centres     [N, 3] m
    radii       [N] m, or one number
    box         [[x0, y0, z0], [x1, y1, z1]] m: six walls x_min .. z_max around the particles
    walls       dict name -> corners [n, 3] m, n >= 3: planar convex walls, counter-clockwise seen from the particles
    method      "embree", or "lines" (convex enclosures; much faster)
    rays        per particle; walls in proportion to their area
    error       instead of rays: relative rms error wanted of the particle-wall sums
    emissivity  of the particles: total exchange of grey surfaces instead of view factors (embree)
    wall_emissivity  of the walls then; default 1
    seed, threads  random numbers, cores (0: all); results do not depend on threads

    What leaves through no wall counts as "open", the last surface. Raises InputError for what cannot be traced.
    """
    raw = _granrad.trace_arrays(np.asarray(centres, float), np.asarray(radii, float), box, walls, method, rays, error,
                                emissivity, wall_emissivity, seed, threads)
    errors = raw["standard_error"] if len(raw["standard_error"]) else np.full(len(raw["value"]), np.nan)
    names = raw["names"]
    return ViewFactors(_square(raw["value"], raw["column"], raw["row_begin"]),
                       _square(errors, raw["column"], raw["row_begin"]), raw["area_m2"], names, len(raw["particle"]),
                       raw["failed"])


def read_view_factors(file):
    """A file of `vfgen trace` as a ViewFactors."""
    with h5py.File(file) as f:
        v = f["view_factors"]
        names = [n.decode() if isinstance(n, bytes) else str(n) for n in f["surfaces/name"][:]]
        return ViewFactors(_square(v["value"][:], v["column"][:], v["row_begin"][:]),
                           _square(v["standard_error"][:], v["column"][:], v["row_begin"][:]), f["surfaces/area"][:],
                           names, int(np.sum(f["surfaces/kind"][:] == 0)), str(f.attrs.get("failed", "")))


def program(name):
    """Path of granrun or vfgen: in $GRANRAD_BIN, else on the PATH."""
    beside = os.path.join(os.environ.get("GRANRAD_BIN", ""), name)
    found = beside if os.path.isfile(beside) else shutil.which(name)
    if not found:
        raise _granrad.IoError(f"{name} is not on the PATH; set GRANRAD_BIN to its folder")
    return found


def fit(files, table, *, form="transmittance", report=None):
    """Fits a correlation to files of view factors, writes `table` (TOML), and returns nothing: read it with Correlation.

    files   of vfgen trace; equal solid fractions become one row
    form    "cubic" or "transmittance"
    report  an HTML page of the fit
    """
    command = [program("vfgen"), "fit", *map(str, files), "-o", str(table), "--form", form, "-q"]
    if report:
        command += ["--report", str(report)]
    done = subprocess.run(command, capture_output=True, text=True)
    errors = {2: _granrad.InputError, 3: _granrad.IoError, 4: _granrad.ThresholdMissed}
    if done.returncode:
        raise errors.get(done.returncode, _granrad.NumericalError)(done.stderr.strip())
