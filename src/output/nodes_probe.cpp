/// Probes that reduce the values of many nodes to one.

#include "output/probe_values.hpp"
#include "output/set_areas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace osculate::output {

namespace {

constexpr const char* area_mean = "area_mean";

/// @param weights  of the values, for area_mean
double reduced(const std::string& reduction, const std::vector<double>& values, const std::vector<double>& weights) {
    if (reduction == "sum") return std::accumulate(values.begin(), values.end(), 0.0);
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (reduction == "max") return *std::ranges::max_element(values);
    if (reduction == "min") return *std::ranges::min_element(values);
    if (reduction == area_mean) {
        const double area = std::accumulate(weights.begin(), weights.end(), 0.0);
        const double sum = std::inner_product(values.begin(), values.end(), weights.begin(), 0.0);
        return area > 0 ? sum / area : std::numeric_limits<double>::quiet_NaN();
    }
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class NodesProbe final : public Probe {
public:
    /// @param areas  of the points, m^2
    NodesProbe(FieldPlace where, Index part, std::vector<Index> points, std::vector<double> areas,
               const FieldNames& fields, std::vector<std::string> reductions)
        : where_(where), part_(part), points_(std::move(points)), areas_(std::move(areas)), fields_(where, fields),
          reductions_(std::move(reductions)) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        std::vector<ProbeColumn> columns;
        for (const std::string& reduction : reductions_) fields_.append_columns(columns, reduction + "_");
        return columns;
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        std::vector<double> row;
        for (const std::string& reduction : reductions_)
            for (const OutputField* f : fields_.all()) {
                const std::vector<double> values = f->values(snapshot, part_);
                const auto n = static_cast<std::size_t>(f->components);
                for (std::size_t c = 0; c < n; ++c) {
                    std::vector<double> chosen, areas;
                    for (std::size_t i = 0; i < points_.size(); ++i) {
                        const double v = values[static_cast<std::size_t>(points_[i]) * n + c];
                        if (std::isnan(v)) continue;
                        chosen.push_back(v);
                        areas.push_back(areas_[i]);
                    }
                    row.push_back(reduced(reduction, chosen, areas));
                }
            }
        return {row};
    }
    [[nodiscard]] bool reads(const std::string& field) const override {
        return where_ == FieldPlace::body && fields_.has(field);
    }
    [[nodiscard]] double places() const override { return static_cast<double>(points_.size()); }

private:
    FieldPlace where_;
    Index part_;
    std::vector<Index> points_;
    std::vector<double> areas_;
    ProbeFields fields_;
    std::vector<std::string> reductions_;
};

} // namespace

std::unique_ptr<Probe> make_nodes_probe(const model::Model& model, const model::Set& set, const FieldNames& fields,
                                        const std::vector<std::string>& reductions) {
    if (set.facets.empty() && std::ranges::find(reductions, area_mean) != reductions.end())
        throw std::invalid_argument("a set of nodes that cover no facet");
    std::vector<Index> points = set.nodes;
    for (Index& node : points) node -= model.bodies[static_cast<std::size_t>(set.body)].first_node;
    return std::make_unique<NodesProbe>(FieldPlace::body, set.body, std::move(points), areas_of(model, set), fields,
                                        reductions);
}

std::unique_ptr<Probe> make_slave_nodes_probe(const model::Model& model, Index pair, const FieldNames& fields,
                                              const std::vector<std::string>& reductions) {
    std::vector<Index> points(static_cast<std::size_t>(model.pairs[static_cast<std::size_t>(pair)]->size()));
    std::iota(points.begin(), points.end(), Index{0});
    return std::make_unique<NodesProbe>(FieldPlace::slave, pair, std::move(points),
                                        model.pairs[static_cast<std::size_t>(pair)]->slaves().area, fields, reductions);
}

} // namespace osculate::output
