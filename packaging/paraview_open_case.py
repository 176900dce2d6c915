"""Opens a case of granrun in ParaView: spheres in their size, coloured by temperature, with the walls.

In ParaView: Macros > Import new macro..., or from a shell: paraview --script=paraview_open_case.py
The case is the folder in $GRANRAD_CASE, else the working folder.
"""
import os
from paraview.simple import *

case = os.environ.get("GRANRAD_CASE", os.getcwd())
series = os.path.join(case, "run.hdf.series")
bed = OpenDataFile(series if os.path.exists(series) else os.path.join(case, "frames"))
view = GetActiveViewOrCreate("RenderView")
spheres = Glyph(Input=bed, GlyphType="Sphere", GlyphMode="All Points", ScaleArray=["POINTS", "radius"],
                ScaleFactor=2.0, OrientationArray=["POINTS", "No orientation array"])
shown = Show(spheres, view)
ColorBy(shown, ("POINTS", "temperature"))
shown.RescaleTransferFunctionToDataRange(True, False)
shown.SetScalarBarVisibility(view, True)
walls = os.path.join(case, "walls.vtp")
if os.path.exists(walls):
    faces = Show(OpenDataFile(walls), view)
    faces.Representation = "Wireframe"
view.ResetCamera()
Render()
