/// Probes that reduce the values of many nodes to one.

#include "output/probe_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace osculate::output {

namespace {

double reduced(const std::string& reduction, const std::vector<double>& values) {
    if (reduction == "sum") return std::accumulate(values.begin(), values.end(), 0.0);
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (reduction == "max") return *std::ranges::max_element(values);
    if (reduction == "min") return *std::ranges::min_element(values);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class NodesProbe final : public Probe {
public:
    NodesProbe(FieldPlace where, Index part, std::vector<Index> points, const FieldNames& fields,
               std::vector<std::string> reductions)
        : where_(where), part_(part), points_(std::move(points)), fields_(where, fields),
          reductions_(std::move(reductions)) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override {
        std::vector<ProbeColumn> columns;
        for (const std::string& reduction : reductions_) fields_.append_columns(columns, reduction + "_");
        return columns;
    }
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override {
        std::vector<double> row;
        for (const std::string& reduction : reductions_)
            for (const Field* f : fields_.all()) {
                const std::vector<double> values = f->values(snapshot, part_);
                const auto n = static_cast<std::size_t>(f->components);
                for (std::size_t c = 0; c < n; ++c) {
                    std::vector<double> chosen;
                    const auto add = [&](std::size_t point) {
                        if (const double v = values[point * n + c]; !std::isnan(v)) chosen.push_back(v);
                    };
                    for (const Index point : points_) add(static_cast<std::size_t>(point));
                    row.push_back(reduced(reduction, chosen));
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
    ProbeFields fields_;
    std::vector<std::string> reductions_;
};

} // namespace

std::unique_ptr<Probe> make_nodes_probe(const model::Model& model, const model::Set& set, const FieldNames& fields,
                                        const std::vector<std::string>& reductions) {
    std::vector<Index> points = set.nodes;
    for (Index& node : points) node -= model.bodies[static_cast<std::size_t>(set.body)].first_node;
    return std::make_unique<NodesProbe>(FieldPlace::body, set.body, std::move(points), fields, reductions);
}

std::unique_ptr<Probe> make_slave_nodes_probe(const model::Model& model, Index pair, const FieldNames& fields,
                                              const std::vector<std::string>& reductions) {
    std::vector<Index> points(static_cast<std::size_t>(model.pairs[static_cast<std::size_t>(pair)]->size()));
    std::iota(points.begin(), points.end(), Index{0});
    return std::make_unique<NodesProbe>(FieldPlace::slave, pair, std::move(points), fields, reductions);
}

} // namespace osculate::output
