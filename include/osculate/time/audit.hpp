#pragma once
/// Last check of a solved step: whether bodies penetrate each other, independently of contact.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/exact_audit.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace osculate::time {

/// Audits displacements with contact::SurfaceAudit, and with ExactAudit where surfaces are exact. Bodies without a common pair may overlap as deeply as they do in
/// the reference configuration, because the user placed them so.
class Audit {
public:
    explicit Audit(const model::Model& model);

    /// Audits the state with displacements u, all nodes, m. The result is valid until the next call.
    const contact::AuditResult& examine(const Field& u);
    /// The deepest place of the last examination after its excess is reduced by the initial one; no value if there is
    /// no intrusion.
    [[nodiscard]] std::optional<contact::Intrusion> deepest() const;
    /// Bodies, the lower first, that no pair keeps apart from now on.
    void pass_over(std::set<std::pair<Index, Index>> bodies) { apart_ = std::move(bodies); }

private:
    /// @param outer  facets of every body, global nodes
    Audit(const model::Model& model, const std::vector<std::vector<mesh::Facet>>& outer);

    const model::Model& model_;
    contact::SurfaceAudit surfaces_;
    ExactAudit exact_;
    contact::AuditResult result_;
    std::set<std::pair<Index, Index>> apart_;         ///< see pass_over()
    std::map<std::pair<Index, Index>, double> drawn_; ///< excess in the reference configuration, m
};

/// Describes an intrusion in words.
[[nodiscard]] std::string in_words(const contact::Intrusion& intrusion, const model::Model& model);

} // namespace osculate::time
