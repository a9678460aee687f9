#pragma once
/// Fields at samples of a line, of a body or of a slave surface.

#include "output/probe_values.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace osculate::output {

class LineProbe final : public Probe {
public:
    struct Sample {
        double s;                      ///< along the line from its start, m
        Vec3 X;                        ///< in the scene's coordinates, m
        std::optional<double> angle{}; ///< on an arc, rad
    };
    /// Samples of a straight line, both ends among them.
    [[nodiscard]] static std::vector<Sample> line(const Vec3& from, const Vec3& to, int count);
    /// Samples of the arc that begins at `from` and turns by `angle`, rad, about the axis through `centre`.
    [[nodiscard]] static std::vector<Sample> arc(const Vec3& centre, const Vec3& axis, const Vec3& from, double angle,
                                                 int count);

    LineProbe(FieldPlace where, Index part, std::vector<Sample> samples, std::vector<Between> places,
              const FieldNames& fields)
        : part_(part), body_(where == FieldPlace::body), samples_(std::move(samples)), places_(std::move(places)),
          fields_(where, fields) {}

    [[nodiscard]] std::vector<ProbeColumn> columns() const override;
    [[nodiscard]] std::vector<std::vector<double>> rows(const Snapshot& snapshot) const override;
    [[nodiscard]] bool reads(const std::string& field) const override { return body_ && fields_.has(field); }
    [[nodiscard]] double places() const override { return static_cast<double>(samples_.size()); }

private:
    Index part_;
    bool body_;
    std::vector<Sample> samples_;
    std::vector<Between> places_;
    ProbeFields fields_;
};

} // namespace osculate::output
