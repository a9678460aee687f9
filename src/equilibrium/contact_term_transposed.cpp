/// Products with the transposed derivatives of contact, for derivatives of a quantity by everything at once.

#include "osculate/core/parallel.hpp"
#include "osculate/equilibrium/contact_term.hpp"

namespace osculate::equilibrium {

void ContactTerm::linearise_transposed(const Iterate&) {
    const ScopedTimer timer(timings_, Part::contact);
    tangents_.resize(static_cast<std::size_t>(first_.back()));
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        prepare_variations(p, false);
        ContactTangent* own = tangents_.data() + first_[p];
        parallel_for(threads_, evaluations_[p].pair().size(), [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j) linearise(p, j, contact::VariationForm::matrices, own[j]);
        });
    }
    list_bearing();
}

void ContactTerm::add_transposed(const Field& of_nodes, const std::vector<Vec3>& of_laws, Field& by_nodes,
                                 std::vector<Vec3>& by_forces) const {
    Vector dy, of_forces;
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) {
            const Index coupling = first_[p] + j, slave = unknowns_.slave(coupling);
            const ContactTangent& tangent = tangents_[coupling];
            const Vec3& of_law = of_laws[coupling];
            Vec3& of_lambda = by_forces[coupling];
            of_lambda -= of_nodes[slave];
            if (!tangent.reaches) {
                of_lambda += tangent.D.transpose() * of_law;
                continue;
            }
            const std::vector<Index>& nodes = evaluations_[p].point_nodes(j);
            of_forces.resize(3 * tangent.carriers);
            for (Index i = 0; i < tangent.carriers; ++i) of_forces.segment<3>(3 * i) = of_nodes[nodes[i]];
            of_lambda += tangent.along_transposed(of_law, of_forces, dy);
            by_nodes[slave] += dy.head<3>();
            for (std::size_t i = 0; i < nodes.size(); ++i)
                by_nodes[nodes[i]] += dy.segment<3>(3 + 3 * static_cast<Index>(i));
        }
}

void ContactTerm::add_transposed_of_start(const Weights& of, StateWeights& by) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& evaluation = evaluations_[p];
        const model::ContactPair& pair = evaluation.pair();
        if (!pair.options().rubs()) continue;
        const std::vector<Mat3>& in_plane = pair.slaves().in_plane;
        for (Index j = 0; j < pair.size(); ++j) {
            const Index coupling = first_[p] + j, slave = unknowns_.slave(coupling);
            if (!reaches(p, j)) continue;
            const Vec3 of_law = of.couplings[coupling] - symmetry_directions(slave) * of.couplings[coupling];
            // v = lambda_start - k d where stick is elastic: d counts -k times as much as lambda_start
            const Vec3 of_drift = law(p, j).by_drift.transpose() * of_law;
            by.couplings[coupling] -= evaluation.law(j, lambda_[p][j]).compliance() * of_drift;
            // d = (s - s_start) - sum_i Phi_i (x_i - x_i,start)
            const contact::ContactPoint& point = evaluation.point(j);
            const Vec3 of_start = in_plane.empty() ? of_drift : Vec3(in_plane[j].transpose() * of_drift);
            by.u[slave] -= of_start;
            for (std::size_t i = 0; i < point.nodes.size(); ++i) {
                const Index v = point.nodes[i];
                by.u[pair.node(v)] += point.weights(static_cast<Index>(i)) * (pair.image(v).transpose() * of_start);
            }
        }
    }
}

} // namespace osculate::equilibrium
