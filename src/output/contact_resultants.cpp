#include "osculate/output/contact_resultants.hpp"

#include <algorithm>

namespace osculate::output {

ContactResultants contact_resultants(const Snapshot& snapshot, Index pair) {
    const model::ContactPair& term = *snapshot.model().pairs[pair];
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
        const double p_N = contact.lambda.dot(contact.normal);
        sum.force += contact.lambda;
        sum.moment += snapshot.x()[term.slaves().node[j]].cross(contact.lambda);
        sum.normal += p_N;
        sum.friction += (contact.lambda - p_N * contact.normal).norm();
        sum.area += snapshot.evaluation(pair).area(j);
    }
    sum.moment += snapshot.model().origin.cross(sum.force);
    return sum;
}

} // namespace osculate::output
