"""The Python package: right numbers against closed forms and against the programs, C++ errors as exceptions."""
import json
import os
import pathlib
import subprocess
import tomllib

import numpy as np
import pytest

import granrad

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ["GRANRAD_BIN"])
BOX = [[0, 0, 0], [0.01, 0.01, 0.01]]
PAIR = [[0.004, 0.005, 0.005], [0.006, 0.005, 0.005]]


def test_touching_spheres_have_the_exact_factor():
    # Catches a swapped row and column of unequal spheres, and a value that is an area: both off by more than 100 sigma.
    found = granrad.trace([[0.004, 0.005, 0.005], [0.007, 0.005, 0.005]], [0.001, 0.002], box=BOX, rays=100_000)
    assert found.F.shape == found.standard_error.shape == (9, 9)
    for i, j, r1, r2 in ((0, 1, 0.001, 0.002), (1, 0, 0.002, 0.001)):
        assert abs(found.F[i, j] - granrad.exact_two_sphere(r1, r2, 0.003)) < 5 * found.standard_error[i, j]
    assert np.allclose(np.asarray(found.F.sum(axis=1)).ravel()[:8], 1, atol=1e-9)
    assert found.to_wall("x_min")[0] > found.to_wall("x_max")[0]


def test_lines_and_rays_agree_and_repeat():
    a = granrad.trace(PAIR, 0.001, box=BOX, rays=50_000, seed=3)
    b = granrad.trace(PAIR, 0.001, box=BOX, rays=50_000, seed=3, threads=1)
    assert (a.F != b.F).nnz == 0
    c = granrad.trace(PAIR, 0.001, box=BOX, rays=50_000, method="lines")
    assert abs(a.F[0, 1] - c.F[0, 1]) < 5 * np.hypot(a.standard_error[0, 1], c.standard_error[0, 1])


def test_an_open_bed_ends_in_the_surroundings():
    found = granrad.trace(PAIR, 0.001, rays=20_000)
    assert found.names[-1] == "open" and found.F.shape == (3, 3)
    assert found.F[0, 2] == pytest.approx(1 - granrad.exact_two_sphere(0.001, 0.001, 0.002), abs=0.005)


@pytest.mark.parametrize("call", [
    lambda: granrad.trace([[0, 0, 0]], -1),
    lambda: granrad.trace([[0, 0]], 0.001),
    lambda: granrad.trace(PAIR, [0.001] * 3),
    lambda: granrad.trace(PAIR, 0.001, method="rays"),
    lambda: granrad.Simulation({"scene": {"end_time_s": -1}}),
    lambda: granrad.Correlation(SOURCE / "data/correlations/li_2024_printed.toml", 0.7),
    lambda: granrad.Case(SOURCE),
    lambda: granrad.heats(PAIR, 0.001, 300, box=BOX, wall_temperatures={"left": 1000}),
])
def test_errors_are_exceptions(call):
    with pytest.raises(granrad.InputError) as caught:
        call()
    assert isinstance(caught.value, ValueError) and isinstance(caught.value, granrad.GranradError)
    assert str(caught.value)


def test_every_problem_of_a_scene_is_named_at_once():
    with pytest.raises(granrad.InputError) as caught:
        granrad.Simulation({"scene": {"end_time_s": -1, "nmae": "x"}, "material": {"file": "alumina.toml", "emissivity": 2}})
    for what in ("scene.end_time_s", "nmae", "material.emissivity"):
        assert what in str(caught.value)


def test_no_heat_flows_at_one_temperature_and_none_is_lost():
    rng = np.random.default_rng(1)
    centres = np.array([[x, y, z] for x in (2, 5, 8) for y in (2, 5, 8) for z in (2, 5, 8)]) * 1e-3 + rng.uniform(-5e-4, 5e-4, (27, 3))
    heat, _ = granrad.heats(centres, 0.0008, 700.0, box=BOX, wall_temperatures={"z_min": 700.0}, emissivity=0.6)
    assert np.abs(heat).max() < 1e-12
    hot, error = granrad.heats(centres, 0.0008, 300.0, box=BOX, wall_temperatures={"z_min": 1000.0})
    assert (hot > 0).all() and hot[centres[:, 2] < 0.003].sum() > hot[centres[:, 2] > 0.007].sum()


def test_a_scene_in_memory_is_the_scene_of_the_program(tmp_path):
    scene = SOURCE / "data/scenes/static_phi007.toml"
    changes = {"scene.end_time_s": 0.1, "output.every_s": 0.05}
    rows = granrad.Simulation(scene, changes).run()
    subprocess.run([BIN / "granrun", "run", scene, "-o", tmp_path / "case", "-q", "--set", "scene.end_time_s=0.1",
                    "--set", "output.every_s=0.05"], check=True)
    history = granrad.Case(tmp_path / "case").history()
    assert len(rows) == len(history) > 0
    for name in ("mean_temperature_K", "Q_rad_W"):
        assert np.allclose([row[name] for row in rows], np.asarray(history[name]), rtol=1e-10)
    frame = granrad.Case(tmp_path / "case").frame()
    assert frame["position_m"].shape == (len(frame["radius"]), 3)


def test_a_table_stays_within_its_bounds():
    table = granrad.Correlation(SOURCE / "data/correlations/granrad_hard_spheres.toml", 0.25)
    d = np.linspace(1, table.cutoff - 1e-6, 200)
    f = table.pp(d)
    assert (f >= 0).all() and (f <= granrad.exact_two_sphere(0.5, 0.5, d) * (1 + 1e-4)).all() and table.pp(table.cutoff + 1) == 0


def test_files_of_vfgen_are_square_and_fits_are_read_back(tmp_path):
    bed = tmp_path / "bed.csv"
    rng = np.random.default_rng(2)
    points = np.array([[x, y, z] for x in range(6) for y in range(6) for z in range(6)]) * 1.6e-3 + 1e-3 + rng.uniform(-2e-4, 2e-4, (216, 3))
    np.savetxt(bed, np.c_[points, np.full(216, 4e-4)], delimiter=",", header="x,y,z,radius", comments="")
    subprocess.run([BIN / "vfgen", "trace", bed, "--box", "0.01,0.01,0.01", "--rays", "3000", "-o", tmp_path / "vf.h5", "-q"], check=True)
    found = granrad.read_view_factors(tmp_path / "vf.h5")
    assert found.F.shape == (216 + 6 + 1,) * 2 and found.particles == 216
    granrad.fit([tmp_path / "vf.h5"], tmp_path / "table.toml")
    phi = 216 * np.pi / 6 * 0.8e-3**3 / 1e-6
    fitted = granrad.Correlation(tmp_path / "table.toml", phi)
    assert fitted.pp(1.0) == pytest.approx(granrad.exact_two_sphere(1, 1, 2), rel=0.05)
    with pytest.raises(granrad.IoError):
        granrad.fit([bed], tmp_path / "none.toml")


def test_the_schema_knows_every_example():
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads(subprocess.run([BIN / "granrun", "keys", "--schema"], check=True, capture_output=True, text=True).stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    scenes = sorted((SOURCE / "data/scenes").glob("*.toml"))
    assert scenes
    for scene in scenes:
        jsonschema.validate(tomllib.loads(scene.read_text()), schema)
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({"scene": {"end_time_s": 1, "nmae": "x"}}, schema)


def test_a_scene_of_a_dict_is_called_scene_and_errors_say_what_they_are():
    with pytest.raises(granrad.InputError) as raised:
        granrad.Simulation({"scene": {"ends": 1}})
    assert "/tmp" not in str(raised.value) and str(raised.value).startswith("scene")
    for error in (granrad.GranradError, granrad.InputError, granrad.IoError, granrad.NumericalError, granrad.ThresholdMissed):
        assert "Unspecified" not in error.__doc__


def test_the_table_of_a_study_is_read(tmp_path):
    (tmp_path / "study.csv").write_text("case,phi,h_wp_W_m2K,h_wp_W_m2K_stderr\na,0.07,52,0.3\nb,0.25,99,0.3\n")
    table = granrad.read_study(tmp_path)
    assert list(table["phi"]) == [0.07, 0.25] and table["h_wp_W_m2K_stderr"][1] == 0.3
    with pytest.raises(granrad.IoError):
        granrad.read_study(tmp_path / "none")


def test_every_public_name_has_a_docstring():
    assert all(getattr(granrad, name).__doc__ for name in granrad.__all__)
