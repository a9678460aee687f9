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

import picture

OUT, IMAGES, PAGE = Path("out/gallery"), Path("docs/images/gallery"), Path("docs/gallery.md")
SIZE = (640, 420)


class Moment(NamedTuple):
    scene: str
    says: str
    towards: tuple        # from the bodies to the camera
    at: float = 1     # of the run's time
    field: str = "von_mises"  # or displacement
    zoom: float = 1.25
    up: tuple = (0, 0, 1)


MOMENTS = (
    Moment("contactor_in_half_tube", "A rubber contactor under pressure, which is drawn along a half-tube and swings.", (0.5, -0.9, 0.9), 0.5),
    Moment("spur_gears", "Involute gears turn against a torque, with friction between the teeth (plane strain).", (0, 0, 1), 1, zoom=1.5, up=(0, 1, 0)),
    Moment("tool_into_rubber", "A rigid ball is pressed into rubber and turned. The ball is an exact surface.", (0.6, -1, 0.7)),
    Moment("clip", "A plastic clip snaps over a round bar, and off again.", (0, -1, 0), 0.27, zoom=1.5),
    Moment("press_fit", "A hub is shrunk on a shaft, and the shaft is pressed out: a quarter.", (1, 0.8, 0.7)),
    Moment("bolted_joint", "A preloaded bolt holds two plates until the load opens the joint.", (0.7, -1, 0.5), zoom=0.9),
    Moment("bracket", "A bracket from a CAD file, screwed down at its foot, is pulled by a pin in its hole.", (0.7, -1, 0.6), zoom=1.1),
    Moment("ring_on_cylinder", "A rubber ring hangs on a bar and spins like a hoop.", (0.5, -1, 0.4), 0.6),
    Moment("dominoes", "Ten dominoes: the first is pushed.", (0.5, -1, 0.5), 0.62, "displacement"),
)


def run(osculate, moment, keep):
    folder = OUT / moment.scene
    summary = folder / "summary.json"
    if not (keep and summary.exists() and json.loads(summary.read_text()).get("status") == "done"):
        print(moment.scene, file=sys.stderr)
        fields = ["--set", "output.body_fields=[displacement, von_mises]"] if moment.field == "von_mises" else []
        subprocess.run([osculate, "run", f"configs/tutorials/{moment.scene}.yaml", "-o", str(folder), "--force", "--quiet", *fields],
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


def draw(folder, moment, file):
    bodies = {name: surface(path, moment.field) for name, path in parts(folder, moment.at).items()}
    values = sorted(v for _, shown in bodies.values() for v in shown)
    largest = values[int(0.995 * (len(values) - 1))] or 1.0  # the rest is at sharp corners
    table = picture.colours(largest)
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    for data, _ in bodies.values():
        renderer.AddActor(picture.body(data, "shown", table, (0.35, 0.35, 0.35), 0.6))
    title = "von Mises stress, MPa" if moment.field == "von_mises" else "displacement, m"
    renderer.AddActor2D(picture.bar(table, title, (0.62, 0.03), (0.35, 0.15), 3, "%.3g", 14, 14))
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*moment.towards)
    camera.SetViewUp(*moment.up)
    renderer.ResetCamera()
    camera.Zoom(moment.zoom)
    picture.save(renderer, SIZE, file)


def main(arguments):
    keep = "--keep" in arguments
    osculate = str(Path(arguments[-1]).resolve())
    IMAGES.mkdir(parents=True, exist_ok=True)
    lines = ["# Gallery", "", "`scripts/pages/gallery` writes this page: it runs the tutorials and draws one moment of each, displacements as they are.",
             "`osculate film DIR` makes a film of any run, `osculate report DIR` a page in which the bodies can be turned.", ""]
    for moment in MOMENTS:
        folder, summary = run(osculate, moment, keep)
        draw(folder, moment, IMAGES / f"{moment.scene}.png")
        lines += [f"## {moment.scene.replace('_', ' ').capitalize()}",
                  f"{moment.says} [`configs/tutorials/{moment.scene}.yaml`](../configs/tutorials/{moment.scene}.yaml): "
                  f"{summary['dofs']} unknowns, {summary['steps']['accepted']} steps.", "",
                  f"![{moment.says}](images/gallery/{moment.scene}.png)", ""]
    PAGE.write_text("\n".join(lines[:-1]) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
