#include "osculate/output/paraview_script.hpp"

#include "output/files.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <initializer_list>

namespace osculate::output {

namespace {

/// What is the same for every run; names of parts and fields stand before it.
constexpr const char* body_of_script = R"(
import glob
import os
import sys

from paraview.simple import *

try:
    folder = os.path.dirname(os.path.abspath(__file__))
except NameError:  # a shell that does not say which script it runs
    folder = os.getcwd()

view = GetActiveViewOrCreate("RenderView")
view.OrientationAxesVisibility = 1
LoadPalette("WhiteBackground")


def read(part, *readers):  # files of one process, or lists of pieces: a run may have been resumed by another number of them
    found = [(reader, sorted(glob.glob(os.path.join(folder, "frames", part + "_[0-9]*." + ending)))) for reader, ending in readers]
    found = [(reader, files) for reader, files in found if files]
    if not found:
        return None
    if len(found) > 1:
        print(part + ": frames of one and of several processes; series.pvd has them all, shown are those of the more")
        found.sort(key=lambda one: len(one[1]))
    reader, files = found[-1]
    source = reader(registrationName=part, FileName=files)
    if "TimeArray" in source.ListProperties():
        source.TimeArray = "TimeValue"
    warped = WarpByVector(registrationName=part + " deformed", Input=source)
    warped.Vectors = ["POINTS", "displacement"]
    warped.ScaleFactor = SCALE
    return warped


def range_of(field):  # one for all parts that have it
    ranges = []
    for source, part, place in sources:
        array = source.PointData[field] if place != "master" else None
        if array:
            ranges.append(array.GetRange(-1 if field in VECTORS else 0))
    low, high = min(r[0] for r in ranges), max(r[1] for r in ranges)
    return (low, high) if high > low else (low, low + 1)


def colour(display, field, unit):
    ColorBy(display, ("POINTS", field) + (("Magnitude",) if field in VECTORS else ()))
    map = GetColorTransferFunction(field)
    map.AutomaticRescaleRangeMode = "Never"
    map.RescaleTransferFunction(*range_of(field))
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(map, view)
    bar.Title = field.replace("_", " ") + (", " + unit if unit else "")
    bar.ComponentTitle = ""
    bar.TitleFontSize, bar.LabelFontSize, bar.HorizontalTitle = 12, 10, 1


def size_of(source):
    b = source.GetDataInformation().GetBounds()
    return max(b[1] - b[0], b[3] - b[2], b[5] - b[4])


VOLUMES = (XMLUnstructuredGridReader, "vtu"), (XMLPartitionedUnstructuredGridReader, "pvtu")
sources = [(read(part, *VOLUMES), part, "body") for part in BODIES]
sources += [(read(part, (XMLPolyDataReader, "vtp")), part, "slave") for part in SLAVES]
sources += [(read(part, (XMLPolyDataReader, "vtp")), part, "master") for part in MASTERS]
sources = [s for s in sources if s[0] is not None]
scene = GetAnimationScene()
scene.UpdateAnimationUsingDataTimeSteps()
scene.GoToLast()

size = 0.0
for source, part, place in sources:
    source.UpdatePipeline(view.ViewTime)
    size = max(size, size_of(source))
for source, part, place in sources:
    if place == "master":  # lies on its body: shown when asked for
        Hide(source, view)
        continue
    display = Show(source, view)
    display.Representation = "Surface With Edges" if place == "body" else "Surface"
    display.EdgeColor = [0.55, 0.55, 0.55]
    field, unit = COLOURS[place]
    if place == "body" and COLOURS["slave"][0]:
        display.Opacity = 0.25  # so that the contact shows
    if field:
        colour(display, field, unit)
    if place in ARROWS:
        force = source.PointData["contact_force"]
        largest = max(abs(v) for v in force.GetRange(-1)) if force else 0
        if largest > 0:
            arrows = Glyph(registrationName=part + " forces", Input=source, GlyphType="Arrow")
            arrows.OrientationArray = ["POINTS", "contact_force"]
            arrows.ScaleArray = ["POINTS", "contact_force"]
            arrows.GlyphMode = "All Points"
            arrows.ScaleFactor = 0.1 * size / largest
            arrows.GlyphType.TipRadius, arrows.GlyphType.ShaftRadius = 0.06, 0.02
            shown = Show(arrows, view)
            ColorBy(shown, None)
            shown.DiffuseColor = [0.1, 0.1, 0.1]

view.CameraPosition = [1.2, -1.8, 0.9]
view.CameraFocalPoint = [0, 0, 0]
view.CameraViewUp = [0, 0, 1]
view.ResetCamera()
Render()
if len(sys.argv) > 1 and sys.argv[-1].endswith(".png"):
    SaveScreenshot(sys.argv[-1], view, ImageResolution=[1400, 900])
)";

/// The first of `wanted` that is among `fields`, with its unit, as a pair of Python.
std::string first_of(FieldPlace where, std::initializer_list<const char*> wanted,
                     const std::vector<std::string>& fields) {
    for (const char* name : wanted)
        if (std::ranges::count(fields, name) > 0) return fmt::format("(\"{}\", \"{}\")", name, field(where, name).unit);
    return "(None, \"\")";
}

std::string list_of(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
    return "[" + text + "]";
}

} // namespace

void write_paraview_script(const std::filesystem::path& folder, const model::Model& model, const FrameFields& fields) {
    std::vector<std::string> bodies, slaves, masters, arrows, vectors;
    if (!fields.body.empty())
        for (const model::Body& body : model.bodies) bodies.push_back(body.name);
    for (const auto& pair : model.pairs) {
        if (!fields.slave.empty()) slaves.push_back(pair->name() + ".slave");
        if (!fields.master.empty()) masters.push_back(pair->name() + ".master");
    }
    if (std::ranges::count(fields.slave, "contact_force") > 0) arrows.emplace_back("slave");
    for (const OutputField& f : all_fields())
        if (f.components == 3 && std::ranges::count(vectors, f.name) == 0) vectors.emplace_back(f.name);
    const std::string text = fmt::format(
        "\"\"\"Shows the frames of this folder: View > Python Shell > Run Script in ParaView, or\n"
        "    pvbatch {} PICTURE.png\n\"\"\"\n"
        "SCALE = 1.0  # of displacements\n"
        "BODIES = {}\nSLAVES = {}\nMASTERS = {}\n"
        "# what each part is coloured by, and its unit\n"
        "COLOURS = {{\n    \"body\": {},\n    \"slave\": {},\n    \"master\": {},\n}}\n"
        "ARROWS = {}\nVECTORS = {}\n",
        paraview_script_file, list_of(bodies), list_of(slaves), list_of(masters),
        first_of(FieldPlace::body,
                 {"von_mises", "plastic_strain", "stress_max", "energy_density", "velocity", "displacement"},
                 fields.body),
        first_of(FieldPlace::slave, {"normal_stress", "gap", "status"}, fields.slave),
        first_of(FieldPlace::master, {"normal_stress"}, fields.master), list_of(arrows), list_of(vectors));
    write_atomic(folder / paraview_script_file, text + body_of_script);
}

} // namespace osculate::output
