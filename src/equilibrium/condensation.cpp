#include "osculate/equilibrium/condensation.hpp"

#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <numeric>

namespace osculate::equilibrium {

Condensation::Condensation(const model::Model& model, const linear::Constraints& constraints,
                           const linear::BlockMatrix& K, std::vector<linear::CondensedBody> bodies,
                           std::vector<Index> slaves, const TangentChoice& choice, int threads)
    : model_(model), constraints_(constraints), K_(&K), bodies_(std::move(bodies)), slaves_(std::move(slaves)),
      grows_(choice.grows), at_any_cost_(choice.at_any_cost), threads_(threads) {
    if (!grows_) {
        now_ = kept_ = condensed_on(choice.nodes, nullptr);
        return;
    }
    outside_.assign(model.X.size(), 0);
    for (const model::OuterSurface& surface : model.general->surfaces())
        for (const mesh::Facet& facet : surface.facets)
            for (const Index node : facet) outside_[node] = 1;
    for (const linear::CondensedBody& body : bodies_) {
        if (!body.loose) continue;
        Nodes all(static_cast<std::size_t>(body.nodes));
        std::iota(all.begin(), all.end(), body.first_node);
        const Nodes ends = linear::three_apart(all, model.X);
        anchors_.insert(anchors_.end(), ends.begin(), ends.end());
    }
}

std::shared_ptr<linear::CondensedTangent> Condensation::condensed_on(const Nodes& nodes,
                                                                     const linear::CondensedTangent* before) const {
    return std::make_shared<linear::CondensedTangent>(constraints_, *K_, model_.X, bodies_, nodes, slaves_, threads_,
                                                      before);
}

void Condensation::begin(double mass_factor, bool changed) {
    mass_factor_ = mass_factor;
    if (now_) now_->begin(mass_factor, changed);
    if (kept_ && kept_ != now_) kept_->begin(mass_factor, changed);
}

void Condensation::commit() {
    if (now_) now_->keep();
    kept_ = now_;
}

void Condensation::rollback() {
    now_ = kept_;
    if (now_) now_->restore();
}

Condensation::Nodes Condensation::nodes_for(const std::vector<linear::BearingContact>& contacts) const {
    Nodes nodes = anchors_;
    for (const linear::BearingContact& c : contacts) {
        nodes.push_back(c.law.where.slave);
        nodes.insert(nodes.end(), c.law.where.masters.begin(), c.law.where.masters.end());
        nodes.insert(nodes.end(), c.nodes.begin(), c.nodes.end());
    }
    const auto in_order = [](Nodes& list) {
        std::ranges::sort(list);
        list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    in_order(nodes);
    const auto pays = [&](const Nodes& list) {
        constexpr double as_fast = 8; // other pairs cost a factorisation more, but no inverse
        return at_any_cost_ || condensation_cost(model_, list, contacts.size()).pays(as_fast);
    };
    if (now_) {
        Nodes more = nodes, ahead;
        more.insert(more.end(), now_->nodes().begin(), now_->nodes().end());
        in_order(more);
        for (const Index node : more) // contact has moved on, and goes on
            if (!std::ranges::binary_search(now_->nodes(), node))
                for (auto k = model_.K.row_begin(node); k < model_.K.row_end(node); ++k)
                    if (outside_[model_.K.column(k)] != 0) ahead.push_back(model_.K.column(k));
        ahead.insert(ahead.end(), more.begin(), more.end());
        in_order(ahead);
        for (Nodes* list : {&ahead, &more})
            if (pays(*list)) return std::move(*list);
    }
    return pays(nodes) ? nodes : Nodes{};
}

bool Condensation::serves(const std::vector<linear::BearingContact>& contacts) const {
    if (!grows_) return true;
    return !contacts.empty() && ((now_ && now_->covers(contacts)) || !nodes_for(contacts).empty());
}

linear::CondensedTangent& Condensation::tangent_for(const std::vector<linear::BearingContact>& contacts) {
    if (!now_ || (grows_ && !now_->covers(contacts))) {
        std::shared_ptr<linear::CondensedTangent> next = condensed_on(nodes_for(contacts), now_.get());
        next->begin(mass_factor_, false);
        factorisations_ += now_ ? now_->factorisations() : 0;
        now_ = std::move(next);
    }
    return *now_;
}

std::vector<Index> Condensation::kept_nodes() const {
    return grows_ && kept_ ? kept_->nodes() : Nodes{};
}

void Condensation::recall(const std::vector<Index>& nodes, const linear::ContactLaws* laws) {
    if (grows_ && !nodes.empty()) now_ = kept_ = condensed_on(nodes, nullptr);
    if (now_ && laws != nullptr) now_->restore(*laws);
}

} // namespace osculate::equilibrium
