/// Probes at points of bodies, and along lines through them.

#include "output/line_probe.hpp"

#include "output/locate_point.hpp"

#include <algorithm>
#include <cmath>
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

} // namespace

std::vector<LineProbe::Sample> LineProbe::line(const Vec3& from, const Vec3& to, int count) {
    std::vector<Sample> samples;
    const double length = (to - from).norm();
    for (int i = 0; i < count; ++i) {
        const double t = static_cast<double>(i) / (count - 1);
        samples.push_back({t * length, (1 - t) * from + t * to});
    }
    return samples;
}

std::vector<LineProbe::Sample> LineProbe::arc(const Vec3& centre, const Vec3& axis, const Vec3& from, double angle,
                                              int count) {
    const Vec3 e = axis.normalized(), arm = from - centre, along = e * e.dot(arm), radius = arm - along;
    std::vector<Sample> samples;
    for (int i = 0; i < count; ++i) {
        const double turned = angle * i / (count - 1);
        const Vec3 there = std::cos(turned) * radius + std::sin(turned) * e.cross(radius);
        samples.push_back({std::abs(turned) * radius.norm(), centre + along + there, turned});
    }
    return samples;
}

std::vector<ProbeColumn> LineProbe::columns() const {
    std::vector<ProbeColumn> columns{{"s", "m"}};
    if (samples_.front().angle) columns.push_back({"angle", "rad"});
    columns.insert(columns.end(), {{"X", "m"}, {"Y", "m"}, {"Z", "m"}});
    fields_.append_columns(columns);
    return columns;
}

std::vector<std::vector<double>> LineProbe::rows(const Snapshot& snapshot) const {
    std::vector<std::vector<double>> rows;
    for (const Sample& sample : samples_) {
        std::vector<double>& row = rows.emplace_back(1, sample.s);
        if (sample.angle) row.push_back(*sample.angle);
        row.insert(row.end(), sample.X.begin(), sample.X.end());
    }
    fields_.append_rows(snapshot, part_, places_, rows);
    return rows;
}

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
    std::vector<LineProbe::Sample> line = LineProbe::line(from, to, samples);
    std::vector<Between> places;
    for (const LineProbe::Sample& sample : line)
        places.push_back(locate_point(model.bodies[static_cast<std::size_t>(body)], sample.X - model.origin).place);
    if (std::ranges::all_of(places, [](const Between& place) { return place.points.empty(); }))
        throw std::invalid_argument("a line without a sample in it");
    return std::make_unique<LineProbe>(FieldPlace::body, body, std::move(line), std::move(places), fields);
}

} // namespace osculate::output
