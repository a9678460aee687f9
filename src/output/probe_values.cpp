#include "output/probe_values.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace osculate::output {

namespace {

const char* ending(int components, int c) {
    static constexpr std::array vector{"_x", "_y", "_z"};
    static constexpr std::array tensor{"_xx", "_yy", "_zz", "_xy", "_yz", "_zx"};
    if (components == 1) return "";
    return components == 3 ? vector[static_cast<std::size_t>(c)] : tensor[static_cast<std::size_t>(c)];
}

} // namespace

std::string name_of_column(const std::string& header) {
    return header.substr(0, header.find(" ["));
}

ProbeFields::ProbeFields(FieldPlace where, const FieldNames& names) {
    for (const std::string& name : names) fields_.push_back(&field(where, name));
}

void ProbeFields::append_columns(std::vector<ProbeColumn>& columns, const std::string& prefix) const {
    for (const OutputField* f : fields_)
        for (int c = 0; c < f->components; ++c)
            columns.push_back({prefix + f->name + ending(f->components, c), f->unit});
}

bool ProbeFields::has(const std::string& field) const {
    return std::ranges::any_of(fields_, [&](const OutputField* f) { return f->name == field; });
}

void ProbeFields::append_rows(const Snapshot& snapshot, Index body_or_pair, const std::vector<Between>& places,
                              std::vector<std::vector<double>>& rows) const {
    for (const OutputField* f : fields_) {
        const std::vector<double> values = f->values(snapshot, body_or_pair);
        const auto value = [&](Index point, int c) {
            return values[static_cast<std::size_t>(point) * static_cast<std::size_t>(f->components) +
                          static_cast<std::size_t>(c)];
        };
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Between& place = places[i];
            for (int c = 0; c < f->components; ++c) {
                if (place.points.empty()) {
                    rows[i].push_back(std::numeric_limits<double>::quiet_NaN());
                    continue;
                }
                if (f->integer) { // of the nearest
                    Index heaviest = 0;
                    place.weights.maxCoeff(&heaviest);
                    rows[i].push_back(value(place.points[static_cast<std::size_t>(heaviest)], c));
                    continue;
                }
                double sum = 0;
                for (std::size_t k = 0; k < place.points.size(); ++k)
                    if (const double w = place.weights(static_cast<Index>(k)); w != 0) // no value there does not matter
                        sum += w * value(place.points[k], c);
                rows[i].push_back(sum);
            }
        }
    }
}

} // namespace osculate::output
