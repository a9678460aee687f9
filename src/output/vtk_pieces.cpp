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
    const auto array = [&](const char* type, const std::string& name, int components) {
        fmt::format_to(out, "      <PDataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n", type,
                       escaped(name), components);
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
    for (const Array& one : point_data) array(one.integer ? "Int32" : "Float64", one.name, one.components);
    fmt::format_to(out,
                   "      <PDataArray type=\"Int64\" IdType=\"1\" Name=\"{}\"/>\n"
                   "    </PPointData>\n"
                   "    <PPoints>\n",
                   point_numbers);
    array("Float64", "Points", 3);
    fmt::format_to(out, "    </PPoints>\n");
    for (const std::string& piece : pieces) fmt::format_to(out, "    <Piece Source=\"{}\"/>\n", escaped(piece));
    fmt::format_to(out, "  </PUnstructuredGrid>\n</VTKFile>\n");
    write_atomic(path, {text.data(), text.size()});
}

std::vector<std::string> pieces_of(const std::filesystem::path& folder, const std::string& file) {
    const std::filesystem::path list = file, path = folder / list;
    if (list.extension() != ".pvtu") return {};
    namespace pt = boost::property_tree;
    try {
        pt::ptree tree;
        pt::read_xml(path.string(), tree);
        std::vector<std::string> pieces;
        for (const auto& [tag, node] : tree.get_child("VTKFile.PUnstructuredGrid"))
            if (tag == "Piece")
                pieces.push_back((list.parent_path() / node.get<std::string>("<xmlattr>.Source")).generic_string());
        return pieces;
    } catch (const pt::ptree_error& error) {
        throw std::runtime_error("cannot read " + path.string() + ": " + error.what());
    }
}

} // namespace osculate::output
