#include "osculate/output/snapshot.hpp"

#include <utility>

namespace osculate::output {

Snapshot::Snapshot(const model::Model& model, const model::State& state, const model::ContactEvaluations& contact,
                   Reactions reactions, std::vector<Vec3> out_of_balance, double dt, const contact::AuditResult* audit)
    : model_(model), state_(state), contact_(contact), reactions_(std::move(reactions)),
      out_of_balance_(std::make_shared<const std::vector<Vec3>>(std::move(out_of_balance))), dt_(dt), audit_(audit) {}

Snapshot Snapshot::of_pieces(const std::vector<Piece>& pieces) const {
    Snapshot part(model_, state_, contact_, reactions_, {}, dt_, audit_);
    part.out_of_balance_ = out_of_balance_;
    part.pieces_ = &pieces;
    return part;
}

const Snapshot::Stress& Snapshot::stress(Index body) const {
    auto known = stress_.find(body);
    if (known == stress_.end())
        known = stress_.emplace(body, model::nodal_stress(model_, body, state_, part(body))).first;
    return known->second;
}

const NodalContact& Snapshot::nodal_contact() const {
    if (!nodal_contact_) nodal_contact_ = output::nodal_contact(model_, state_, contact_);
    return *nodal_contact_;
}

contact::ContactState Snapshot::contact(Index pair, Index slave) const {
    const contact::ContactPoint& point = contact_[pair].point(slave);
    return {state_.contact[pair].lambda[slave], point.gap, point.normal, Vec3::Zero()};
}

bool Snapshot::has_partner(Index pair, Index slave) const {
    const contact::ContactPoint& point = contact_[pair].point(slave);
    return point.found || point.behind;
}

} // namespace osculate::output
