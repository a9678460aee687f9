#pragma once
/// The last look at a solved step: whether bodies lie inside one another, whatever contact says.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/model.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace osculate::time {

/// Audits displacements by contact::SurfaceAudit. Bodies that no pair keeps apart may overlap as deep as they do in the
/// reference configuration: that is how they were drawn.
class Audit {
public:
    explicit Audit(const model::Model& model);

    /// Of the state with displacements u, all nodes, m. Kept until the next one.
    const contact::AuditResult& examine(const Field& u);
    /// The deepest place of the last examination beyond what was drawn, its excess reduced by that; nothing where there is
    /// none.
    [[nodiscard]] std::optional<contact::Intrusion> deepest() const;

private:
    const model::Model& model_;
    contact::SurfaceAudit surfaces_;
    Field x_;
    contact::AuditResult result_;
    std::map<std::pair<Index, Index>, double> drawn_; ///< excess in the reference configuration, m
};

/// Who lies where in whom, in words.
[[nodiscard]] std::string in_words(const contact::Intrusion& intrusion, const model::Model& model);

} // namespace osculate::time
