#include "osculate/output/series_reader.hpp"

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <stdexcept>

namespace osculate::output {

std::vector<SeriesEntry> read_series(const std::filesystem::path& path) {
    namespace pt = boost::property_tree;
    try {
        pt::ptree tree;
        pt::read_xml(path.string(), tree);
        std::vector<SeriesEntry> entries;
        for (const auto& [tag, node] : tree.get_child("VTKFile.Collection")) {
            if (tag != "DataSet") continue;
            const auto file = node.get<std::string>("<xmlattr>.file");
            entries.push_back(
                {node.get<double>("<xmlattr>.timestep"), node.get("<xmlattr>.name", std::string()), file});
        }
        return entries;
    } catch (const pt::ptree_error& error) {
        throw std::runtime_error("cannot read " + path.string() + ": " + error.what());
    }
}

} // namespace osculate::output
