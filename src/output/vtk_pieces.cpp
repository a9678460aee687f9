#include "osculate/output/vtk_pieces.hpp"

#include "osculate/core/escaped.hpp"
#include "output/files.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>

namespace osculate::output {

void write_pvtu(const std::filesystem::path& path, const std::vector<std::string>& pieces,
                const std::vector<Array>& point_data, double time) {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    const auto array = [&](const Array& one) { // VTK takes from here what is not a value
        std::string components;
        if (one.components == 6)
            for (std::size_t c = 0; c < voigt_names.size(); ++c)
                components += fmt::format(" ComponentName{}=\"{}\"", c, voigt_names[c]);
        fmt::format_to(out, "      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"{}",
                       one.integer ? "Int32" : "Float64", escaped(one.name), one.components, components);
        if (one.unit.empty())
            fmt::format_to(out, "/>\n");
        else
            fmt::format_to(
                out,
                ">\n        <InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{}</InformationKey>\n"
                "      </PDataArray>\n",
                escaped(one.unit));
    };
    fmt::format_to(
        out,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PUnstructuredGrid GhostLevel=\"0\">\n"
        "    <FieldData>\n"
        "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n"
        "    </FieldData>\n"
        "    <PPointData GlobalIds=\"{}\">\n",
        time, point_numbers);
    for (const Array& one : point_data) array(one);
    fmt::format_to(out,
                   "      <PDataArray type=\"Int64\" IdType=\"1\" Name=\"{}\"/>\n"
                   "    </PPointData>\n"
                   "    <PPoints>\n",
                   point_numbers);
    array({"Points", 3, {}, false, {}});
    fmt::format_to(out, "    </PPoints>\n");
    for (const std::string& piece : pieces) fmt::format_to(out, "    <Piece Source=\"{}\"/>\n", escaped(piece));
    fmt::format_to(out, "  </PUnstructuredGrid>\n</VTKFile>\n");
    write_atomic(path, {text.data(), text.size()});
}

std::vector<std::filesystem::path> pieces_in(const std::filesystem::path& path) {
    namespace pt = boost::property_tree;
    try {
        pt::ptree tree;
        pt::read_xml(path.string(), tree);
        std::vector<std::filesystem::path> pieces;
        for (const auto& [tag, node] : tree.get_child("VTKFile.PUnstructuredGrid"))
            if (tag == "Piece") pieces.push_back(path.parent_path() / node.get<std::string>("<xmlattr>.Source"));
        return pieces;
    } catch (const pt::ptree_error& error) {
        throw std::runtime_error("cannot read " + path.string() + ": " + error.what());
    }
}

} // namespace osculate::output
