#include "osculate/output/contact_resultants.hpp"

#include "osculate/model/general_contact.hpp"

#include <algorithm>

namespace osculate::output {

ContactResultants contact_resultants(const Snapshot& snapshot, Index pair) {
    const model::ContactPair& term = *snapshot.state().contact[pair].pair;
    const std::vector<contact::Status>& status = snapshot.state().contact[pair].status;
    ContactResultants sum;
    if (snapshot.audit() != nullptr)
        sum.penetration = snapshot.audit()->between(model::body_index(snapshot.model(), term.slaves().node.front()),
                                                    model::body_index(snapshot.model(), term.master_nodes().front()));
    for (Index j = 0; j < term.size(); ++j) {
        const contact::ContactState contact = snapshot.contact(pair, j);
        const bool partner =
            snapshot.audit() == nullptr ? snapshot.has_partner(pair, j) : snapshot.evaluation(pair).point(j).found;
        if (partner) sum.penetration = std::max(sum.penetration, -contact.gap);
        if (!contact::is_closed(status[j])) {
            ++sum.open;
            continue;
        }
        ++(status[j] == contact::Status::stick ? sum.stick : sum.slip);
        const model::ContactEvaluation& evaluation = snapshot.evaluation(pair);
        const Vec3 whole = evaluation.whole(j) * contact.lambda;
        const double p_N = whole.dot(contact.normal);
        sum.force += whole;
        // at the contact point of an edge; elsewhere at the node
        const Vec3 at = term.slaves().edges ? Vec3(evaluation.point(j).foot + contact.gap * contact.normal)
                                            : snapshot.x(term.slaves().node[j]);
        sum.moment += at.cross(whole);
        sum.normal += p_N;
        sum.friction += (whole - p_N * contact.normal).norm();
        sum.area += evaluation.area(j);
    }
    sum.moment += snapshot.model().origin.cross(sum.force);
    return sum;
}

ContactResultants general_resultants(const Snapshot& snapshot) {
    ContactResultants sum;
    for (std::size_t p = snapshot.model().pairs.size(); p < snapshot.state().contact.size(); ++p) {
        const ContactResultants one = contact_resultants(snapshot, static_cast<Index>(p));
        sum.force += one.force;
        sum.moment += one.moment;
        sum.normal += one.normal;
        sum.friction += one.friction;
        sum.area += one.area;
        sum.open += one.open;
        sum.stick += one.stick;
        sum.slip += one.slip;
        sum.penetration = std::max(sum.penetration, one.penetration);
    }
    return sum;
}

std::vector<BodyResultants> body_resultants(const Snapshot& snapshot) {
    const model::Model& model = snapshot.model();
    const std::vector<model::OuterSurface>& surfaces = model.general->surfaces();
    std::vector<BodyResultants> sums(surfaces.size());
    for (std::size_t p = model.pairs.size(); p < snapshot.state().contact.size(); ++p) {
        const model::ContactEvaluation& evaluation = snapshot.evaluation(static_cast<Index>(p));
        const std::pair<Index, Index> sides = model.general->sides_of(evaluation.pair());
        const Index slave = sides.first, master = sides.second; // a lambda takes no parts of a pair
        const std::vector<Vec3>& lambda = snapshot.state().contact[p].lambda;
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            evaluation.for_each_force(j, lambda[static_cast<std::size_t>(j)], [&](Index node, const Vec3& force) {
                const bool own = model::body_index(model, node) == surfaces[static_cast<std::size_t>(slave)].body;
                BodyResultants& sum = sums[static_cast<std::size_t>(own ? slave : master)];
                sum.force += force;
                sum.moment += snapshot.x(node).cross(force);
            });
        }
    }
    for (BodyResultants& sum : sums) sum.moment += model.origin.cross(sum.force);
    return sums;
}

} // namespace osculate::output
