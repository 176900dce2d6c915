"""Opens a case of granrun in ParaView: spheres in their size at the last time, coloured by temperature, with the walls.

From a shell, in the folder of the case:  paraview --script=/usr/share/granrad/paraview_open_case.py
In ParaView: Macros > Import new macro... The case is the folder in $GRANRAD_CASE, else the working folder.
Frames also hold q_rad, q_ss, q_sfs (W received by radiation, contacts, gas), material, v and omega to colour by.
"""
import os

from paraview.simple import *

case = os.environ.get("GRANRAD_CASE", os.getcwd())
series = os.path.join(case, "run.hdf.series")
if not os.path.exists(series):
    raise SystemExit(f"{case} is not the folder of a case: run.hdf.series is missing; go there, or set GRANRAD_CASE")
view = GetActiveViewOrCreate("RenderView")

bed = OpenDataFile(series)
bed.UpdatePipelineInformation()
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.AnimationTime = max(bed.TimestepValues)
spheres = Glyph(registrationName="spheres", Input=bed, GlyphType="Sphere", GlyphMode="All Points", ScaleArray=["POINTS", "radius"],
                ScaleFactor=2.0, OrientationArray=["POINTS", "No orientation array"])
spheres.GlyphType.Radius = 0.5
spheres.GlyphType.ThetaResolution = spheres.GlyphType.PhiResolution = 16
shown = Show(spheres, view)
ColorBy(shown, ("POINTS", "temperature"))
colours = GetColorTransferFunction("temperature")
colours.ApplyPreset("Plasma (matplotlib)", True)
shown.RescaleTransferFunctionToDataRange(False, True)
shown.SetScalarBarVisibility(view, True)
bar = GetScalarBar(colours, view)
bar.Title, bar.ComponentTitle = "T, K", ""

walls = os.path.join(case, "walls.vtp")
if os.path.exists(walls):
    faces = Show(OpenDataFile(walls), view)
    faces.Representation = "Wireframe"

view.CameraViewUp = [0, 0, 1]
view.CameraPosition, view.CameraFocalPoint = [1, -2.2, 0.6], [0, 0, 0]
view.ResetCamera(False)
Render()
