#pragma once
/// The fields that a frame can contain, one row each.

#include "osculate/output/snapshot.hpp"
#include "osculate/output/vtk_file.hpp"

#include <span>
#include <string>
#include <vector>

namespace osculate::output {

enum class FieldPlace { body, slave, master };

struct OutputField {
    const char* name; ///< in scenes and in files
    FieldPlace where;
    int components;
    const char* unit; ///< SI; empty for numbers without one
    bool integer;
    /// Values point by point: at a body's nodes, a pair's slave nodes or its master's vertices.
    std::vector<double> (*values)(const Snapshot&, Index body_or_pair);
};

/// Every field, in the order of the reference.
[[nodiscard]] std::span<const OutputField> all_fields();

/// The field with this name. @throws InternalError if there is none
[[nodiscard]] const OutputField& field(FieldPlace where, const std::string& name);

/// Values of the field as an array of a VTK file.
[[nodiscard]] Array evaluate(const OutputField& field, const Snapshot& snapshot, Index body_or_pair);

} // namespace osculate::output
