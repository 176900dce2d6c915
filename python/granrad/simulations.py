"""Scenes built and run in memory."""
import os
import tempfile

import numpy as np

from . import _granrad


def _toml_value(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        value = str(value)
    if isinstance(value, str):
        if "/" in value and os.path.exists(value):  # a file named from here, while the scene is kept elsewhere
            value = os.path.abspath(value)
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{k}" = {_toml_value(v)}' for k, v in value.items()) + "}"
    return "[" + ", ".join(_toml_value(v) for v in value) + "]"


def _scene_text(scene):
    text = ""
    for key, value in scene.items():
        if not isinstance(value, dict):
            text += f"{key} = {_toml_value(value)}\n"
    for key, value in scene.items():
        if isinstance(value, dict):
            text += f"[{key}]\n" + "".join(f'"{k}" = {_toml_value(v)}\n' for k, v in value.items())
    return text


class Simulation:
    """A scene in memory, at time 0; nothing is written.

    scene      a scene file, or a dict of its tables: {"scene": {"end_time_s": 1}, "box": {...}, ...}; the keys are those
               of `granrun keys`. Files in a dict are found from the working folder or among the installed data.
    overrides  dict of single values: {"radiation.rays": 5000}
    threads    cores, 0: all; results do not depend on it

    Raises InputError with every problem of the scene.
    """

    def __init__(self, scene, overrides=None, threads=0):
        settings = [f"{key}={_toml_value(value)}" for key, value in (overrides or {}).items()]
        if not isinstance(scene, dict):
            self._of = _granrad.CompiledSimulation(str(scene), settings, threads)
            return
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "scene.toml")
            with open(file, "w", encoding="utf-8") as out:
                out.write(_scene_text(scene))
            try:
                self._of = _granrad.CompiledSimulation(file, settings, threads)
            except _granrad.InputError as error:  # the file is nobody's
                raise _granrad.InputError(str(error).replace(file, "scene")) from None

    def run(self, until_s=float("inf")):
        """Goes on until a time or the end; the rows of the history since, one dict an output interval."""
        return self._of.run(until_s)

    def row(self):
        """A row of the history up to now, as a dict (time_s, mean_temperature_K, Q_rad_W, ...)."""
        return self._of.row()

    def heats(self, draw=0):
        """Radiative heat of every particle of the bed as it is: (heat_W [N], standard_error_W [N] or empty)."""
        found = self._of.heats(draw)
        return found["heat_W"], found["standard_error_W"]

    finished = property(lambda self: self._of.finished)
    time_s = property(lambda self: self._of.time_s)
    scene = property(lambda self: self._of.scene, doc="The scene in force, TOML.")
    ids = property(lambda self: self._of.ids)
    positions_m = property(lambda self: self._of.positions_m, doc="[N, 3] m")
    velocities_m_s = property(lambda self: self._of.velocities_m_s, doc="[N, 3] m/s")
    radii_m = property(lambda self: self._of.radii_m, doc="[N] m")
    temperatures_K = property(lambda self: self._of.temperatures_K, doc="[N] K")


def heats(centres, radii, temperatures, *, box, wall_temperatures, emissivity=1.0, wall_emissivity=1.0, source="paths",
          rays=None, draw=0):
    """Radiative heat that each particle of a snapshot receives: (heat_W [N], standard_error_W [N] or empty).

    centres, radii, temperatures  [N, 3] m, [N] m or one number, [N] K or one number
    box                           [[x0, y0, z0], [x1, y1, z1]] m
    wall_temperatures             dict of walls held at a temperature, {"y_min": 1000.0}; the others re-radiate
    source                        "paths", "embree" or "lines"; rays as in [radiation]
    """
    centres = np.atleast_2d(np.asarray(centres, float))
    count = len(centres)
    low, high = np.asarray(box, float)
    columns = [centres, np.broadcast_to(radii, count)[:, None], np.broadcast_to(temperatures, count)[:, None]]
    walls = {}
    for name in ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max"):
        held = name in wall_temperatures
        walls[name] = ({"role": "isothermal", "temperature_K": float(wall_temperatures[name])} if held else
                       {"role": "adiabatic"})
        walls[name]["emissivity"] = float(wall_emissivity)
    unknown = set(wall_temperatures) - set(walls)
    if unknown:
        raise _granrad.InputError(f"wall_temperatures: {', '.join(sorted(unknown))} (no wall of a box); use x_min .. z_max")
    radiation = {"source": source}
    if rays is not None:
        radiation["rays"] = float(rays)
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "bed.csv")
        np.savetxt(file, np.hstack(columns), delimiter=",", header="x,y,z,radius,temperature", comments="", fmt="%.17g")
        scene = {"scene": {"end_time_s": 1.0}, "material": {"file": "alumina.toml", "emissivity": float(emissivity)},
                 "particles": {"file": file}, "box": {"origin_m": low, "size_m": high - low}, "walls": walls,
                 "dem": {"engine": "none"}, "conduction": {"solid": False}, "radiation": radiation}
        return Simulation(scene).heats(draw)
