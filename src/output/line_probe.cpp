/// Probes at points of bodies, and along lines through them.

#include "osculate/contact/facet_patch.hpp"
#include "output/locate_point.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace osculate::output {

namespace {

class PointProbe final : public Probe {
public:
    PointProbe(Index body, Between place, const FieldNames& fields)
        : body_(body), places_{std::move(place)}, fields_(FieldPlace::body, fields) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        std::vector<ProbeColumn> columns;
        fields_.append_columns(columns);
        return columns;
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        std::vector<std::vector<double>> rows(1);
        fields_.append_rows(snapshot, body_, places_, rows);
        return rows;
    }
    [[nodiscard]] bool reads(const std::string& field) const override { return fields_.has(field); }
    [[nodiscard]] double places() const override { return 1; }

private:
    Index body_;
    std::vector<Between> places_;
    ProbeFields fields_;
};

class LineProbe final : public Probe {
public:
    struct Sample {
        double s;
        Vec3 X;
    };
    LineProbe(FieldPlace where, Index part, std::vector<Sample> samples, std::vector<Between> places,
              const FieldNames& fields)
        : part_(part), body_(where == FieldPlace::body), samples_(std::move(samples)), places_(std::move(places)),
          fields_(where, fields) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        std::vector<ProbeColumn> columns{{"s", "m"}, {"X", "m"}, {"Y", "m"}, {"Z", "m"}};
        fields_.append_columns(columns);
        return columns;
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        std::vector<std::vector<double>> rows;
        for (const Sample& sample : samples_) rows.push_back({sample.s, sample.X.x(), sample.X.y(), sample.X.z()});
        fields_.append_rows(snapshot, part_, places_, rows);
        return rows;
    }
    [[nodiscard]] bool reads(const std::string& field) const override { return body_ && fields_.has(field); }
    [[nodiscard]] double places() const override { return static_cast<double>(samples_.size()); }

private:
    Index part_;
    bool body_;
    std::vector<Sample> samples_;
    std::vector<Between> places_;
    ProbeFields fields_;
};

/// Positions in the scene's coordinates.
std::vector<LineProbe::Sample> samples_of(const Vec3& from, const Vec3& to, int count) {
    std::vector<LineProbe::Sample> samples;
    const double length = (to - from).norm();
    for (int i = 0; i < count; ++i) {
        const double t = static_cast<double>(i) / (count - 1);
        samples.push_back({t * length, (1 - t) * from + t * to});
    }
    return samples;
}

} // namespace

std::unique_ptr<Probe> make_point_probe(const model::Model& model, Index body, const Vec3& X,
                                        const FieldNames& fields) {
    LocatedPoint found = locate_point(model.bodies[static_cast<std::size_t>(body)], X - model.origin);
    if (found.place.points.empty())
        throw std::invalid_argument(
            fmt::format("a point outside of it, {:.3g} m from the box of its closest element", found.distance));
    return std::make_unique<PointProbe>(body, std::move(found.place), fields);
}

std::unique_ptr<Probe> make_line_probe(const model::Model& model, Index body, const Vec3& from, const Vec3& to,
                                       int samples, const FieldNames& fields) {
    std::vector<LineProbe::Sample> line = samples_of(from, to, samples);
    std::vector<Between> places;
    for (const LineProbe::Sample& sample : line)
        places.push_back(locate_point(model.bodies[static_cast<std::size_t>(body)], sample.X - model.origin).place);
    if (std::ranges::all_of(places, [](const Between& place) { return place.points.empty(); }))
        throw std::invalid_argument("a line without a sample in it");
    return std::make_unique<LineProbe>(FieldPlace::body, body, std::move(line), std::move(places), fields);
}

std::unique_ptr<Probe> make_contact_line_probe(const model::Model& model, Index pair, const Vec3& from, const Vec3& to,
                                               int samples, const FieldNames& fields) {
    const model::SlaveNodes& slaves = model.pairs[static_cast<std::size_t>(pair)]->slaves();
    std::vector<Index> slave_of(model.X.size(), -1);
    for (std::size_t j = 0; j < slaves.node.size(); ++j)
        slave_of[static_cast<std::size_t>(slaves.node[j])] = static_cast<Index>(j);
    const mesh::HalfEdgeSurface surface(slaves.facets, model.X);
    std::vector<Vec3> X;
    for (const Index node : surface.vertex_nodes()) X.push_back(model.X[static_cast<std::size_t>(node)]);
    contact::FacetSearch search(surface);
    search.build(X);
    std::vector<LineProbe::Sample> line = samples_of(from, to, samples);
    std::vector<Between> places;
    for (LineProbe::Sample& sample : line) {
        const contact::FacetHit hit = search.global(sample.X - model.origin, X);
        if (hit.distance > (to - from).norm())
            throw std::invalid_argument(fmt::format("a line {:.3g} m away from its slave surface", hit.distance));
        const auto vertices = surface.facet_vertices(hit.facet);
        const contact::FacetPatch patch(static_cast<int>(vertices.size()));
        Between place{{}, Vector::Zero(patch.size())};
        contact::MatrixX2 gradients(patch.size(), 2);
        patch.weights(hit.u, place.weights, gradients);
        sample.X = model.origin;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            const Index node = surface.vertex_nodes()[static_cast<std::size_t>(vertices[k])];
            if (slave_of[static_cast<std::size_t>(node)] < 0)
                throw std::invalid_argument("a line on a slice, whose facets have slaves at one side alone");
            place.points.push_back(slave_of[static_cast<std::size_t>(node)]);
            sample.X += place.weights(static_cast<Index>(k)) * model.X[static_cast<std::size_t>(node)];
        }
        places.push_back(std::move(place));
    }
    return std::make_unique<LineProbe>(FieldPlace::slave, pair, std::move(line), std::move(places), fields);
}

} // namespace osculate::output
