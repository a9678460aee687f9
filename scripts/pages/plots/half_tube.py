"""Picture of the half-tube while the contactor slides: deformed bodies, coloured by von Mises stress.

    half_tube.py RUN PICTURE      needs a display, such as that of xvfb-run
"""
import sys
from pathlib import Path

import vtk

import picture

FRAME = 16
LARGEST = 1.6  # MPa, of the frame


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


def main(run, image):
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    table = picture.colours(LARGEST)
    for part in ("tube", "contactor"):
        renderer.AddActor(picture.body(warped(read(run, part)), "megapascal", table))
    renderer.AddActor2D(picture.bar(table, "von Mises stress, MPa", (0.63, 0.05), (0.34, 0.13), 5, "%.1f", 20, 8))
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 5.6, -2.2)
    camera.SetPosition(4.5, -6.5, 9)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(30)
    renderer.ResetCamera()
    camera.Zoom(1.2)
    picture.save(renderer, (1000, 680), image)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
