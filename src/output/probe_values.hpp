#pragma once
/// Fields as columns of probes, and values between nodes.

#include "osculate/output/probe.hpp"

namespace osculate::output {

/// A place between nodes: which of a part's points, and how much of each. Without points: a place without values.
struct Between {
    std::vector<Index> points;
    Vector weights;
};

/// The chosen fields of a place, and their columns.
class ProbeFields {
public:
    ProbeFields(FieldPlace where, const FieldNames& names);

    /// "stress_xx", one per component. @param prefix  "mean_"
    void append_columns(std::vector<ProbeColumn>& columns, const std::string& prefix = {}) const;
    [[nodiscard]] bool has(const std::string& field) const;
    [[nodiscard]] const std::vector<const OutputField*>& all() const { return fields_; }
    /// Values at a place, appended to every row.
    void append_rows(const Snapshot& snapshot, Index body_or_pair, const std::vector<Between>& places,
                     std::vector<std::vector<double>>& rows) const;

private:
    std::vector<const OutputField*> fields_;
};

} // namespace osculate::output
