"""The macro opens a case in ParaView, in one step: spheres in their places and sizes, at the last time, in colours.
Skipped without ParaView and Xvfb. Usage: paraview.py BIN SOURCE
Planted, seen to fail: spheres scaled by the radius for a diameter; the first frame in place of the last.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

BIN, SOURCE = (pathlib.Path(p).resolve() for p in sys.argv[1:3])

LOOK = """
import os
exec(open(os.environ["MACRO"]).read())
bed.UpdatePipeline(scene.AnimationTime)
spheres.UpdatePipeline(scene.AnimationTime)
low, high = shown.Input.PointData.GetArray("temperature").GetRange()
print("SEEN", bed.GetDataInformation().GetNumberOfPoints(), *spheres.GetDataInformation().GetBounds(), low, high, scene.AnimationTime)
print("NAMES", *[bed.PointData.GetArray(k).Name for k in range(bed.PointData.GetNumberOfArrays())])
SaveScreenshot(os.environ["PICTURE"], view, ImageResolution=[600, 600])
"""


def main():
    if not shutil.which("pvpython") or not shutil.which("xvfb-run"):
        print("no ParaView or no Xvfb: skipped")
        return 77
    import h5py
    environment = dict(os.environ, GRANRAD_DATA=str(SOURCE / "data"), OMP_WAIT_POLICY="passive")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([BIN / "granrun", "run", SOURCE / "data/scenes/static_phi007.toml", "-o", folder / "case", "--set", "scene.end_time_s=0.1",
                        "--set", "output.frames_every_s=0.05", "--set", "radiation.source=paths", "--set", "radiation.rays=300", "-q"], check=True, env=environment)
        (folder / "look.py").write_text(LOOK)
        # hwloc's look for displays, by way of MPI, leaves VTK without one.
        environment.update(GRANRAD_CASE=str(folder / "case"), MACRO=str(SOURCE / "packaging/paraview_open_case.py"), PICTURE=str(folder / "bed.png"),
                           HWLOC_COMPONENTS="-gl,-opencl", LIBGL_ALWAYS_SOFTWARE="1")
        said = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 800x800x24 -noreset", "pvpython", folder / "look.py"], capture_output=True, text=True, env=environment)
        line = [words.split()[1:] for words in said.stdout.splitlines() if words.startswith("SEEN")]
        assert line, said.stdout[-500:] + said.stderr[-1500:]
        seen = [float(word) for word in line[0]]
        with h5py.File(sorted((folder / "case/frames").glob("*.hdf"))[-1]) as frame:
            points, radius = frame["VTKHDF/Points"][:], frame["VTKHDF/PointData/radius"][:]
            temperature = frame["VTKHDF/PointData/temperature"][:]
        assert seen[0] == len(points)
        for k in range(3):  # a sphere of 16 corners around reaches nearly its radius
            low, high = (points[:, k] - radius).min(), (points[:, k] + radius).max()
            assert abs(seen[1 + 2 * k] - low) < 0.1 * radius[0] and abs(seen[2 + 2 * k] - high) < 0.1 * radius[0], (k, seen, low, high)
        assert abs(seen[7] - temperature.min()) < 1e-3 and abs(seen[8] - temperature.max()) < 1e-3, (seen, temperature.min(), temperature.max())
        names = next(words for words in said.stdout.splitlines() if words.startswith("NAMES"))
        assert all(name in names.split() for name in ("q_rad", "q_ss", "q_sfs", "material", "v")), names
        assert (folder / "bed.png").stat().st_size > 10000
    return 0


sys.exit(main())
