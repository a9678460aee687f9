#include "osculate/output/frames.hpp"

#include "output/files.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <unordered_map>
#include <utility>

namespace osculate::output {

namespace fs = std::filesystem;

namespace {

std::vector<const OutputField*> chosen(FieldPlace where, const std::vector<std::string>& names) {
    std::vector<const OutputField*> fields;
    for (const std::string& name : names) fields.push_back(&field(where, name));
    return fields;
}

Array displacement_of(const std::vector<Index>& nodes, const std::vector<Vec3>& u) {
    Array array{"displacement", 3, {}, false, "m"};
    for (const Index node : nodes) array.values.insert(array.values.end(), u[node].data(), u[node].data() + 3);
    return array;
}

} // namespace

Frames::Frames(fs::path directory, const FrameFields& fields, const model::Model& model, bool beside,
               std::vector<SeriesEntry> kept)
    : directory_(std::move(directory)), body_fields_(chosen(FieldPlace::body, fields.body)),
      series_(directory_, std::move(kept)), beside_(beside) {
    if (!body_fields_.empty())
        for (const model::Body& body : model.bodies) bodies_.push_back(body.name);
    const auto slave = chosen(FieldPlace::slave, fields.slave), master = chosen(FieldPlace::master, fields.master);
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        const model::ContactPair& pair = *model.pairs[p];
        const auto number = static_cast<Index>(p);
        add_surface(model, pair.name() + ".slave", number, pair.slaves().node, pair.slaves().facets, slave);
        if (master.empty()) continue;
        std::vector<mesh::Facet> own; // without mirror images
        for (const mesh::Facet& facet : pair.surface().facets())
            if (std::all_of(facet.begin(), facet.end(), [&](Index node) { return node < model.nodes(); }))
                own.push_back(facet);
        add_surface(model, pair.name() + ".master", number, pair.master_nodes(), own, master);
    }
}

std::vector<std::string> Frames::files(long number) const {
    std::vector<std::string> names;
    for (const std::string& body : bodies_) names.push_back(file(body, number, "vtu"));
    for (const Surface& surface : surfaces_) names.push_back(file(surface.name, number, "vtp"));
    return names;
}

void Frames::add_surface(const model::Model& model, std::string name, Index pair, const std::vector<Index>& nodes,
                         const std::vector<mesh::Facet>& facets, std::vector<const OutputField*> fields) {
    if (fields.empty()) return;
    Surface surface{std::move(name), pair, nodes, {}, facets, std::move(fields)};
    std::unordered_map<Index, Index> point_of;
    for (const Index node : nodes) {
        point_of.emplace(node, static_cast<Index>(surface.points.size()));
        surface.points.push_back(model.X[node] + model.origin);
    }
    for (mesh::Facet& facet : surface.facets) { // of a slice with the nodes of its plane alone, as lines
        mesh::Facet own;
        for (const Index node : facet)
            if (const auto at = point_of.find(node); at != point_of.end())
                own.nodes[static_cast<std::size_t>(own.count++)] = at->second;
        facet = own;
    }
    std::erase_if(surface.facets, [](const mesh::Facet& facet) { return facet.count < 2; });
    surfaces_.push_back(std::move(surface));
}

std::string Frames::file(const std::string& part, long number, const char* extension) {
    return fmt::format("frames/{}_{:05}.{}", part, number, extension);
}

void Frames::write(const Snapshot& snapshot, long number) {
    const double time = snapshot.state().time;
    const model::Model& model = snapshot.model();
    std::vector<File> files; // values are taken here: the state does not wait
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const model::Body& body = model.bodies[b];
        File& one = files.emplace_back(File{nullptr, &body, body.name, file(body.name, number, "vtu"), {}});
        for (const OutputField* f : body_fields_) one.arrays.push_back(evaluate(*f, snapshot, static_cast<Index>(b)));
    }
    for (const Surface& surface : surfaces_) {
        File& one = files.emplace_back(File{&surface, nullptr, surface.name, file(surface.name, number, "vtp"), {}});
        one.arrays.push_back(displacement_of(surface.nodes, snapshot.state().u));
        for (const OutputField* f : surface.fields) one.arrays.push_back(evaluate(*f, snapshot, surface.pair));
    }
    finish();
    if (!beside_) return write_files(files, model.origin, time);
    writing_ = std::async(std::launch::async, [this, files = std::move(files), origin = model.origin, time] {
        write_files(files, origin, time);
    });
}

void Frames::write_files(const std::vector<File>& files, const Vec3& origin, double time) {
    for (const File& one : files) {
        if (one.surface != nullptr) {
            write_vtp(directory_ / one.name, one.surface->points, one.surface->facets, one.arrays, time);
        } else {
            std::vector<Vec3> points = one.body->mesh.nodes;
            for (Vec3& X : points) X += origin;
            write_vtu(directory_ / one.name, points, one.body->mesh.blocks, one.arrays, time);
        }
        series_.add(time, one.part, one.name);
    }
    series_.flush();
}

void Frames::finish() {
    if (writing_.valid()) writing_.get();
}

} // namespace osculate::output
