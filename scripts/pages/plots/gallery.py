"""Runs tutorials, draws the deformed bodies of one frame of each, and writes docs/gallery.md.

    gallery.py [--keep] OSCULATE      called by scripts/pages/gallery, from the root of the repository, with a display
"""
import json
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import vtk

OUT, IMAGES, PAGE = Path("out/gallery"), Path("docs/images/gallery"), Path("docs/gallery.md")
SIZE = (640, 420)
STOPS = ("#f4f1e6", "#fde3a2", "#fdb366", "#f0704a", "#c5305a", "#7a1a6c", "#2d1150")


class Picture(NamedTuple):
    scene: str
    says: str
    towards: tuple        # from the bodies to the camera
    moment: float = 1     # of the run's time
    field: str = "von_mises"  # or displacement
    leave_out: tuple = ()     # bodies
    zoom: float = 1.25
    up: tuple = (0, 0, 1)


PICTURES = (
    Picture("contactor_in_half_tube", "A rubber contactor under pressure, which is drawn along a half-tube and swings.", (0.5, -0.9, 0.9), 0.5),
    Picture("spur_gears", "Involute gears turn against a torque, with friction between the teeth (plane strain).", (0, 0, 1), 1, zoom=1.5, up=(0, 1, 0)),
    Picture("tool_into_rubber", "A rigid ball is pressed into rubber and turned. The ball is an exact surface.", (0.6, -1, 0.7)),
    Picture("clip", "A plastic clip snaps over a round bar, and off again.", (0, 0, 1), 0.5, up=(0, 1, 0)),
    Picture("press_fit", "A hub is shrunk on a shaft, and the shaft is pressed out: a quarter.", (1, 0.8, 0.7)),
    Picture("bolted_joint", "A preloaded bolt holds two plates until the load opens the joint.", (0.7, -1, 0.5)),
    Picture("bracket", "A bracket from a CAD file, screwed down at its foot, is pulled by a pin in its hole.", (0.7, -1, 0.6)),
    Picture("ring_on_cylinder", "A rubber ring hangs on a bar and spins like a hoop.", (0.5, -1, 0.4), 0.6),
    Picture("dominoes", "Ten dominoes: the first is pushed.", (0.5, -1, 0.5), 0.62, "displacement"),
    Picture("chain", "Five links of a chain swing: general contact finds who touches whom.", (0.6, -1, 0.3), 0.6, "displacement"),
    Picture("balls_in_box", "A steel ball falls among rubber balls.", (0.6, -1, 1.0), 0.7, "displacement", ("box",)),
)


def run(osculate, picture, keep):
    folder = OUT / picture.scene
    summary = folder / "summary.json"
    if not (keep and summary.exists() and json.loads(summary.read_text()).get("status") == "done"):
        print(picture.scene, file=sys.stderr)
        subprocess.run([osculate, "run", f"configs/tutorials/{picture.scene}.yaml", "-o", str(folder), "--force", "--quiet"],
                       check=True)
    return folder, json.loads(summary.read_text())


def parts(folder, moment):
    """{name: file} of the frame nearest to a share of the run's time, the bodies alone."""
    rows = [(float(e.get("timestep")), folder / e.get("file")) for e in ElementTree.parse(folder / "series.pvd").iter("DataSet")]
    end = max(time for time, _ in rows)
    chosen = min({time for time, _ in rows}, key=lambda time: abs(time - moment * end))
    files = [path for time, path in rows if time == chosen and path.suffix == ".vtu"]
    return {path.stem.rsplit("_", 1)[0]: path for path in files}


def surface(path, field):
    """The deformed outside of a body with the array `shown`, and its values at the nodes."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    warp = vtk.vtkWarpVector()
    warp.SetInputData(reader.GetOutput())
    warp.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, "displacement")
    shown = vtk.vtkArrayCalculator()
    shown.SetInputConnection(warp.GetOutputPort())
    has = reader.GetOutput().GetPointData().HasArray(field)
    if field == "displacement":
        shown.AddVectorVariable("u", "displacement", 0, 1, 2)
        shown.SetFunction("mag(u)")
    elif has:
        shown.AddScalarVariable("s", field, 0)
        shown.SetFunction("s / 1e6")
    else:  # a rigid body
        shown.SetFunction("0")
    shown.SetResultArrayName("shown")
    outside = vtk.vtkDataSetSurfaceFilter()
    outside.SetInputConnection(shown.GetOutputPort())
    outside.Update()
    data = outside.GetOutput()
    array = data.GetPointData().GetArray("shown")
    return data, [array.GetValue(i) for i in range(array.GetNumberOfTuples())] if array else []


def colours(largest):
    function = vtk.vtkColorTransferFunction()
    function.SetColorSpaceToLab()
    for i, stop in enumerate(STOPS):
        function.AddRGBPoint(largest * i / (len(STOPS) - 1), *(int(stop[k:k + 2], 16) / 255 for k in (1, 3, 5)))
    return function


def bar(table, title):
    actor = vtk.vtkScalarBarActor()
    actor.SetLookupTable(table)
    actor.SetTitle(title)
    actor.SetNumberOfLabels(3)
    actor.SetMaximumNumberOfColors(256)
    actor.SetLabelFormat("%.3g")
    actor.SetOrientationToHorizontal()
    actor.SetPosition(0.62, 0.03)
    actor.SetWidth(0.35)
    actor.SetHeight(0.13)
    actor.SetVerticalTitleSeparation(6)
    actor.UnconstrainedFontSizeOn()
    for text in (actor.GetTitleTextProperty(), actor.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.1)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
        text.SetFontSize(14)
    return actor


def draw(folder, picture, file):
    bodies = {name: surface(path, picture.field) for name, path in parts(folder, picture.moment).items()
              if name not in picture.leave_out}
    values = sorted(v for _, shown in bodies.values() for v in shown)
    largest = values[int(0.995 * (len(values) - 1))] or 1.0  # the rest is at sharp corners
    table = colours(largest)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for data, _ in bodies.values():
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputData(data)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("shown")
        mapper.SetLookupTable(table)
        mapper.SetUseLookupTableScalarRange(True)
        mapper.InterpolateScalarsBeforeMappingOn()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        look = actor.GetProperty()
        look.EdgeVisibilityOn()
        look.SetEdgeColor(0.35, 0.35, 0.35)
        look.SetLineWidth(0.6)
        look.SetAmbient(0.5)
        look.SetDiffuse(0.6)
        renderer.AddActor(actor)
    renderer.AddActor2D(bar(table, "von Mises stress, MPa" if picture.field == "von_mises" else "displacement, m"))
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*picture.towards)
    camera.SetViewUp(*picture.up)
    renderer.ResetCamera()
    camera.Zoom(picture.zoom)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*SIZE)
    window.AddRenderer(renderer)
    window.Render()
    grab = vtk.vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(file))
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(grab.GetOutputPort())
    writer.Write()


def main(arguments):
    keep = "--keep" in arguments
    osculate = str(Path(arguments[-1]).resolve())
    IMAGES.mkdir(parents=True, exist_ok=True)
    lines = ["# Gallery", "", "`scripts/pages/gallery` writes this page: it runs the tutorials and draws one moment of each, displacements as they are.",
             "`osculate film DIR` makes a film of any run, `osculate report DIR` a page in which the bodies can be turned.", ""]
    for picture in PICTURES:
        folder, summary = run(osculate, picture, keep)
        draw(folder, picture, IMAGES / f"{picture.scene}.png")
        lines += [f"## {picture.scene.replace('_', ' ').capitalize()}",
                  f"{picture.says} [`configs/tutorials/{picture.scene}.yaml`](../configs/tutorials/{picture.scene}.yaml): "
                  f"{summary['dofs']} unknowns, {summary['steps']['accepted']} steps.", "",
                  f"![{picture.says}](images/gallery/{picture.scene}.png)", ""]
    PAGE.write_text("\n".join(lines[:-1]) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
