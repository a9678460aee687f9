"""Picture of the half-tube while the contactor slides: deformed bodies, coloured by von Mises stress.

    half_tube.py RUN PICTURE      needs a display, such as that of xvfb-run
"""
import sys
from pathlib import Path

import vtk

FRAME = 16
RANGE = (0, 1.6)  # MPa, up to the largest stress of the frame


def read(run, part):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(Path(run) / "frames" / f"{part}_{FRAME:05d}.vtu"))
    reader.Update()
    return reader.GetOutput()


def warped(grid):
    warp = vtk.vtkWarpVector()
    warp.SetInputData(grid)
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    warp.SetScaleFactor(1)
    megapascal = vtk.vtkArrayCalculator()
    megapascal.SetInputConnection(warp.GetOutputPort())
    megapascal.AddScalarVariable("s", "von_mises", 0)
    megapascal.SetFunction("s / 1e6")
    megapascal.SetResultArrayName("megapascal")
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputConnection(megapascal.GetOutputPort())
    surface.Update()
    return surface.GetOutput()


def colours():
    """Light to dark, so that the mesh and the shading stay visible where nothing happens."""
    function = vtk.vtkColorTransferFunction()
    function.SetColorSpaceToLab()
    stops = ["#f4f1e6", "#fde3a2", "#fdb366", "#f0704a", "#c5305a", "#7a1a6c", "#2d1150"]
    for i, stop in enumerate(stops):
        rgb = [int(stop[k:k + 2], 16) / 255 for k in (1, 3, 5)]
        function.AddRGBPoint(RANGE[0] + (RANGE[1] - RANGE[0]) * i / (len(stops) - 1), *rgb)
    return function


def main(run, picture):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    table = colours()
    for part in ("tube", "contactor"):
        surface = warped(read(run, part))
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(surface)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("megapascal")
        mapper.SetLookupTable(table)
        mapper.SetUseLookupTableScalarRange(True)
        mapper.InterpolateScalarsBeforeMappingOn()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().EdgeVisibilityOn()
        actor.GetProperty().SetEdgeColor(0.25, 0.25, 0.25)
        actor.GetProperty().SetLineWidth(1)
        actor.GetProperty().SetAmbient(0.5)
        actor.GetProperty().SetDiffuse(0.6)
        renderer.AddActor(actor)

    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("von Mises stress, MPa")
    bar.SetNumberOfLabels(5)
    bar.SetMaximumNumberOfColors(256)
    bar.SetLabelFormat("%.1f")
    bar.SetOrientationToHorizontal()
    bar.SetPosition(0.63, 0.05)
    bar.SetWidth(0.34)
    bar.SetHeight(0.13)
    bar.SetVerticalTitleSeparation(8)
    bar.UnconstrainedFontSizeOn()
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontSize(20)
    renderer.AddActor2D(bar)

    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 5.6, -2.2)
    camera.SetPosition(4.5, -6.5, 9)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(30)
    renderer.ResetCamera()
    camera.Zoom(1.2)

    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(1000, 680)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(picture))
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
