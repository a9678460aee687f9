#include "osculate/output/frames.hpp"

#include "osculate/output/vtk_pieces.hpp"
#include "output/files.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
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
               std::vector<SeriesEntry> kept, const Share* share)
    : directory_(std::move(directory)), body_fields_(chosen(FieldPlace::body, fields.body)),
      share_(share != nullptr && share->ranks().count() > 1 ? share : nullptr), beside_(beside && share_ == nullptr) {
    if (first()) series_.emplace(directory_, std::move(kept));
    if (!body_fields_.empty())
        for (const model::Body& body : model.bodies) {
            bodies_.push_back(body.name);
            if (share_ != nullptr) pieces_.push_back(piece_of(body, *share_));
        }
    if (!first()) return;
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
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        names.push_back(file(bodies_[b], number, share_ == nullptr ? "vtu" : "pvtu"));
        if (share_ != nullptr)
            for (const int rank : pieces_[b].processes) names.push_back(piece_file(bodies_[b], number, rank));
    }
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

std::string Frames::piece_file(const std::string& part, long number, int rank) {
    return fmt::format("frames/pieces/{}_{:05}_{}.vtu", part, number, rank);
}

bool Frames::is_piece_of(const std::string& file, const std::string& listed) {
    const fs::path list = listed;
    if (list.extension() != ".pvtu") return false;
    const std::string before = "frames/pieces/" + list.stem().string() + "_", after = ".vtu";
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
        return false;
    const auto rank = std::string_view(file).substr(before.size(), file.size() - before.size() - after.size());
    return rank.find_first_not_of("0123456789") == std::string_view::npos;
}

std::vector<Frames::File> Frames::files_of(const model::Model& model, long number) const {
    std::vector<File> files;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const model::Body& body = model.bodies[b];
        File& one = files.emplace_back(
            File{nullptr, static_cast<Index>(b), &body, nullptr, body.name, file(body.name, number, "vtu"), {}});
        if (share_ == nullptr) continue;
        one.piece = &pieces_[b];
        one.name = piece_file(body.name, number, share_->ranks().rank());
    }
    for (const Surface& surface : surfaces_)
        files.push_back(File{&surface, -1, nullptr, nullptr, surface.name, file(surface.name, number, "vtp"), {}});
    return files;
}

void Frames::take_values(File& one, const Snapshot& snapshot) const {
    if (one.surface != nullptr) {
        one.arrays.push_back(displacement_of(one.surface->nodes, snapshot.state().u));
        for (const OutputField* f : one.surface->fields)
            one.arrays.push_back(evaluate(*f, snapshot, one.surface->pair));
        return;
    }
    for (const OutputField* f : body_fields_) one.arrays.push_back(evaluate(*f, snapshot, one.number));
}

void Frames::write(const Snapshot& snapshot, long number) {
    const double time = snapshot.state().time;
    const Vec3& origin = snapshot.model().origin;
    if (share_ != nullptr) {
        Ranks& ranks = share_->ranks();
        (void)ranks.largest(0); // all wait: the first process has claimed the files by then
        std::vector<File> files;
        const auto together = [&](auto&& act) { // all end where one fails
            std::string problem;
            try {
                act();
            } catch (const std::runtime_error& error) {
                problem = error.what();
            }
            if (const auto failed = static_cast<int>(ranks.largest(problem.empty() ? -1 : ranks.rank())); failed >= 0)
                throw std::runtime_error(fmt::format("process {}: {}", failed, ranks.said_by(failed, problem)));
        };
        together([&] {
            files = files_of(snapshot.model(), number);
            const Snapshot of_pieces = snapshot.of_pieces(pieces_);
            for (File& one :
                 files) { // only one's values are held; no field is collective, so that one process may fail alone
                take_values(one, of_pieces);
                of_pieces.forget_stress();
                write_file(one, origin, time);
                for (Array& array : one.arrays) std::vector<double>().swap(array.values);
            }
        });
        return together([&] { list(files, number, time); });
    }
    std::vector<File> files = files_of(snapshot.model(), number);
    for (File& one : files) take_values(one, snapshot); // here: the state does not wait
    finish();
    const auto put = [this, files = std::move(files), origin, time, number] {
        for (const File& one : files) write_file(one, origin, time);
        list(files, number, time);
    };
    if (!beside_) return put();
    writing_ = std::async(std::launch::async, put);
}

void Frames::write_file(const File& one, const Vec3& origin, double time) const {
    if (one.surface != nullptr) {
        write_vtp(directory_ / one.name, one.surface->points, one.surface->facets, one.arrays, time);
    } else if (one.piece == nullptr) {
        std::vector<Vec3> points = one.body->mesh.nodes;
        for (Vec3& X : points) X += origin;
        write_vtu(directory_ / one.name, points, one.body->mesh.blocks, one.arrays, time);
    } else if (!one.piece->nodes.empty()) {
        std::vector<Vec3> points;
        for (const Index node : one.piece->nodes) points.push_back(one.body->mesh.nodes[node] + origin);
        write_vtu(directory_ / one.name, points, one.piece->blocks, one.arrays, time, one.piece->nodes);
    }
}

void Frames::list(const std::vector<File>& files, long number, double time) {
    if (!first()) return;
    for (const File& one : files) {
        if (one.piece == nullptr) {
            series_->add(time, one.part, one.name);
            continue;
        }
        const std::string name = file(one.part, number, "pvtu");
        std::vector<std::string> pieces;
        for (const int rank : one.piece->processes)
            pieces.push_back(
                fs::path(piece_file(one.part, number, rank)).lexically_relative("frames").generic_string());
        write_pvtu(directory_ / name, pieces, one.arrays, time);
        series_->add(time, one.part, name);
    }
    series_->flush();
}

const std::vector<SeriesEntry>& Frames::written() {
    finish();
    return series_->entries();
}

void Frames::finish() {
    if (writing_.valid()) writing_.get();
}

} // namespace osculate::output
