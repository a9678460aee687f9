/// ContactTerm's derivatives: as products, in a matrix, for a preconditioner.

#include "osculate/core/parallel.hpp"
#include "osculate/equilibrium/contact_term.hpp"

#include <algorithm>

namespace osculate::equilibrium {

void ContactTerm::prepare_variations(std::size_t p, bool all) {
    model::ContactEvaluation& evaluation = evaluations_[p];
    std::vector<char> wanted;
    for (Index j = 0; j < evaluation.pair().size(); ++j) wanted.push_back(reaches(p, j) && (all || evaluation.owns(j)));
    evaluation.prepare_variations(wanted, threads_);
}

void ContactTerm::linearise_law(std::size_t p, Index j, ContactTangent& tangent) const {
    const Mat3 mirrored = symmetry_directions(evaluations_[p].pair().slaves().node[j]);
    tangent.D = (Mat3::Identity() - mirrored) * law(p, j).by_lambda + mirrored;
    tangent.reaches = reaches(p, j);
    tangent.carriers = tangent.reaches ? evaluations_[p].carriers(j) : 0;
}

void ContactTerm::linearise(std::size_t p, Index j, contact::VariationForm form, ContactTangent& tangent) const {
    tangent.variation.form = form;
    const model::ContactEvaluation& evaluation = evaluations_[p];
    const Vec3& lambda = lambda_[p][j];
    const contact::ContactResidual law = this->law(p, j);
    const Mat3 mirrored = symmetry_directions(evaluation.pair().slaves().node[j]), kept = Mat3::Identity() - mirrored;
    tangent.D = kept * law.by_lambda + mirrored;
    tangent.reaches = reaches(p, j);
    tangent.carriers = tangent.reaches ? evaluation.carriers(j) : 0;
    tangent.evaluation = &evaluation;
    tangent.slave = j;
    tangent.force = lambda;
    if (!tangent.reaches) return;
    evaluation.vary(j, tangent.variation);
    tangent.A.noalias() = law.by_gap * tangent.variation.dg + law.by_normal * tangent.variation.dn;
    if (evaluation.pair().options().rubs()) {
        evaluation.drift_variation(j, tangent.variation, tangent.dd);
        tangent.A.noalias() += law.by_drift * tangent.dd;
    }
    tangent.A = kept * tangent.A;
    tangent.E = -evaluation.master_force_by_lambda(j); // the forces stand on the right of the equilibrium
    evaluation.fold(j, tangent.A, tangent.E);
    if (tangent.variation.form != contact::VariationForm::matrices) return;
    evaluation.master_force_by_y(j, lambda, tangent.variation, tangent.G);
    tangent.G = -tangent.G;
    evaluation.fold(j, tangent.G);
}

std::vector<LinearisedContact> ContactTerm::linearise_near(double reach) {
    std::vector<LinearisedContact> list;
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        model::ContactEvaluation& evaluation = evaluations_[p];
        evaluation.evaluate_all_here(threads_);
        const Index size = evaluation.pair().size();
        std::vector<char> wanted(static_cast<std::size_t>(size), 0);
        for (Index j = 0; j < size; ++j) {
            const contact::ContactPoint& point = evaluation.point(j);
            wanted[j] = point.found &&
                        (reaches(p, j) || point.gap < reach * evaluation.pair().surface().facet_size(point.facet));
        }
        evaluation.prepare_variations(wanted, threads_);
        contact::ContactVariation variation;
        Matrix dd;
        for (Index j = 0; j < size; ++j) {
            if (wanted[j] == 0) continue;
            LinearisedContact& one = list.emplace_back();
            one.coupling = first_[p] + j;
            one.slave = evaluation.pair().slaves().node[j];
            one.masters = evaluation.point_nodes(j);
            one.friction = evaluation.friction(j);
            const contact::ContactState state = evaluation.state(j, lambda_[p][j]);
            const Vec3& n = state.normal;
            const Mat3 mirrored = symmetry_directions(one.slave), kept = Mat3::Identity() - mirrored,
                       T = Mat3::Identity() - n * n.transpose();
            int least = 0;
            n.cwiseAbs().minCoeff(&least);
            one.axes.col(0) = n;
            one.axes.col(1) = n.cross(Vec3::Unit(least)).normalized();
            one.axes.col(2) = n.cross(one.axes.col(1));
            variation.patches.clear();
            variation.form = contact::VariationForm::products;
            evaluation.vary(j, variation);
            one.A = n * variation.dg;
            if (evaluation.pair().options().rubs()) {
                evaluation.drift_variation(j, variation, dd);
                one.A += T * dd;
            }
            one.A = kept * one.A;
            one.F = evaluation.master_force_by_lambda(j);
            evaluation.fold(j, one.A, one.F);
            one.A = (one.axes.transpose() * one.A).eval();
            one.F = (one.F * kept * one.axes).eval();
            one.w = one.axes.transpose() * (kept * (state.gap * n + T * state.drift));
            const contact::Coulomb law = evaluation.law(j, lambda_[p][j]);
            one.w(0) = state.gap + law.from();
            one.drag = law.drag();
            one.compliance = law.compliance();
            one.normal_compliance = law.normal_compliance();
            one.anchor = one.axes.transpose() * law.anchor();
        }
    }
    return list;
}

namespace {
/// The same spring between the nodes that dependent nodes follow. A slave that depends on others becomes one of the
/// masters with the opposite sign, and the slave itself moves only along the directions that it keeps.
void follow_carriers(const linear::Dependence& dependence, linear::Spring& spring) {
    if (!linear::any_depends(dependence, spring.slave, spring.masters)) return;
    linear::Spring folded;
    const auto add = [&](Index node, const Mat3& follow, bool own) {
        if (own && dependence.owns(node)) {
            folded.masters.push_back(node);
            folded.follow.push_back(follow * dependence.keeps(node));
        }
        if (!dependence.depends(node)) return;
        for (const linear::Dependence::Carrier& carrier : dependence.carriers(node)) {
            // each once: their nodes are many, and each pair of entries costs a product
            const auto at = std::ranges::find(folded.masters, carrier.node);
            if (at == folded.masters.end()) {
                folded.masters.push_back(carrier.node);
                folded.follow.push_back(follow * carrier.moves);
            } else {
                folded.follow[static_cast<std::size_t>(at - folded.masters.begin())] += follow * carrier.moves;
            }
        }
    };
    for (std::size_t i = 0; i < spring.masters.size(); ++i) add(spring.masters[i], spring.follow[i], true);
    if (dependence.depends(spring.slave)) add(spring.slave, -Mat3::Identity(), false);
    spring.masters = std::move(folded.masters);
    spring.follow = std::move(folded.follow);
}
} // namespace

linear::SoftContact ContactTerm::soften(std::size_t p, Index j) const {
    const model::ContactEvaluation& evaluation = evaluations_[p];
    linear::SoftContact soft;
    const contact::ContactResidual law = this->law(p, j);
    const Index slave = evaluation.pair().slaves().node[j];
    const Mat3 mirrored = symmetry_directions(slave), kept = Mat3::Identity() - mirrored;
    soft.coupling = first_[p] + j;
    soft.where.slave = slave;
    soft.D = kept * law.by_lambda + mirrored;
    soft.c = evaluation.stiffness(j, lambda_[p][j]);
    if (!evaluation.point(j).found || !contact::is_closed(statuses_[p][j])) return soft;
    soft.normal = evaluation.point(j).normal;
    soft.B = kept * (law.by_gap * soft.normal.transpose() + law.by_drift);
    evaluation.follow_master(j, soft.where.masters, soft.where.follow);
    if (dependence_ != nullptr) follow_carriers(*dependence_, soft.where);
    return soft;
}

void ContactTerm::add_soft(std::vector<linear::SoftContact>& soft) const {
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) soft.push_back(soften(p, j));
}

void ContactTerm::linearise(const Iterate&) {
    const ScopedTimer timer(timings_, Part::contact);
    tangents_.resize(static_cast<std::size_t>(first_.back()));
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& evaluation = evaluations_[p];
        const Index size = evaluation.pair().size();
        prepare_variations(p, false);
        ContactTangent* own = tangents_.data() + first_[p];
        parallel_for(threads_, size, [&](Index begin, Index end) {
            for (Index j = begin; j < end; ++j)
                if (evaluation.owns(j)) {
                    linearise(p, j, contact::VariationForm::products, own[j]);
                } else {
                    if (own[j].evaluation != nullptr) own[j] = {}; // of a step in which it was this process'
                    linearise_law(p, j, own[j]);
                }
        });
    }
    list_bearing();
}

void ContactTerm::list_bearing() {
    open_laws_.assign(tangents_.size(), Mat3::Zero());
    bearing_.clear();
    bearing_owner_.clear();
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        const model::ContactEvaluation& evaluation = evaluations_[p];
        const ContactTangent* own = tangents_.data() + first_[p];
        for (Index j = 0; j < evaluation.pair().size(); ++j)
            if (own[j].reaches) {
                bearing_.push_back({&own[j], evaluation.point_nodes(j), soften(p, j)});
                if (evaluation.share() != nullptr) bearing_owner_.push_back(evaluation.share()->owner(j));
            } else
                open_laws_[static_cast<std::size_t>(first_[p] + j)] = own[j].D;
    }
}

void ContactTerm::add_product(const Direction& d, Field& f, VectorRef y) {
    const auto moved = [&](Index node) -> const Vec3& { return d.u[node]; };
    const auto add = [&](Index node, const Vec3& force) { f[node] += force; };
    product_on_.resize(bearing_.size());
    product_law_.resize(bearing_.size());
    parallel_for(threads_, static_cast<Index>(bearing_.size()), [&](Index begin, Index end) {
        for (Index j = begin; j < end; ++j)
            if (ranks_ == nullptr || bearing_owner_[j] == ranks_->rank())
                product_law_[j] = bearing_[j].multiply(moved, force(d.z, bearing_[j].law.coupling), product_on_[j]);
    });
    if (ranks_ != nullptr) exchange_products();
    std::size_t next = 0;
    for (Index coupling = 0; coupling < first_.back(); ++coupling) {
        const Index slave = unknowns_.slave(coupling);
        const Vec3 lambda = force(d.z, coupling);
        Vec3 law;
        if (next < bearing_.size() && bearing_[next].law.coupling == coupling) {
            bearing_[next].scatter(product_on_[next], lambda, add);
            law = product_law_[next++];
        } else {
            law = open_laws_[coupling] * lambda;
            f[slave] -= lambda;
        }
        law = constraints_.to_local(slave, law);
        for (int k = 0; k < 3; ++k) y[unknowns_.contact_row(coupling, k)] = law(k);
    }
}

void ContactTerm::exchange_products() {
    constexpr int of_law = 3;
    const auto size = [](const linear::BearingContact& contact) {
        const auto& tangent = static_cast<const ContactTangent&>(*contact.derivatives);
        return 3 * tangent.carriers;
    };
    std::vector<int> sizes(static_cast<std::size_t>(ranks_->count()), 0);
    std::vector<double> own;
    for (std::size_t b = 0; b < bearing_.size(); ++b) {
        sizes[static_cast<std::size_t>(bearing_owner_[b])] += of_law + size(bearing_[b]);
        if (bearing_owner_[b] != ranks_->rank()) continue;
        own.insert(own.end(), product_law_[b].begin(), product_law_[b].end());
        own.insert(own.end(), product_on_[b].begin(), product_on_[b].end());
    }
    std::vector<const double*> at;
    std::size_t all = 0;
    for (const int one : sizes) all += static_cast<std::size_t>(one);
    exchanged_.resize(all);
    ranks_->gather(own, sizes, exchanged_.data());
    for (std::size_t r = 0, from = 0; r < sizes.size(); from += static_cast<std::size_t>(sizes[r++]))
        at.push_back(exchanged_.data() + from);
    for (std::size_t b = 0; b < bearing_.size(); ++b) {
        const double*& from = at[static_cast<std::size_t>(bearing_owner_[b])];
        product_law_[b] = Eigen::Map<const Vec3>(from);
        product_on_[b] = Eigen::Map<const Vector>(from + of_law, size(bearing_[b]));
        from += of_law + size(bearing_[b]);
    }
}

bool ContactTerm::add_pattern(std::vector<linear::Coupling>& couplings) const {
    bool covered = true;
    const auto covers = [](const linear::Coupling& coupling, const std::vector<Index>& masters) {
        return std::ranges::all_of(masters,
                                   [&](Index node) { return std::ranges::binary_search(coupling.masters, node); });
    };
    const auto independent = [&](std::size_t p, Index j, std::vector<Index> masters) {
        if (dependence_ != nullptr) linear::replace_dependent(*dependence_, unknowns_.slave(first_[p] + j), masters);
        return masters;
    };
    for (std::size_t p = 0; p < evaluations_.size() && covered; ++p)
        for (Index j = 0; j < evaluations_[p].pair().size() && covered; ++j)
            covered = !reaches(p, j) || covers(couplings[static_cast<std::size_t>(first_[p] + j)],
                                               independent(p, j, evaluations_[p].point_nodes(j)));
    if (covered) return true;
    for (std::size_t p = 0; p < evaluations_.size(); ++p)
        for (Index j = 0; j < evaluations_[p].pair().size(); ++j) {
            auto& masters = couplings[static_cast<std::size_t>(first_[p] + j)].masters;
            if (!reaches(p, j)) continue;
            // room for the point to move about its facet
            masters = evaluations_[p].patch_nodes(evaluations_[p].facets()[j]);
            const auto& own = evaluations_[p].point_nodes(j);
            masters.insert(masters.end(), own.begin(), own.end());
            masters = independent(p, j, std::move(masters));
            std::sort(masters.begin(), masters.end());
            masters.erase(std::unique(masters.begin(), masters.end()), masters.end()); // mirror images repeat nodes
        }
    return false;
}

void ContactTerm::add_derivatives(linear::SystemMatrix& matrix) {
    constexpr Index batch = 64; // tangents held at a time: each takes some 100 kB on a smooth master
    if (tangents_.size() < batch) tangents_.resize(batch);
    for (std::size_t p = 0; p < evaluations_.size(); ++p) {
        model::ContactEvaluation& evaluation = evaluations_[p];
        const Index size = evaluation.pair().size();
        {
            const ScopedTimer timer(timings_, Part::contact);
            evaluation.evaluate_all_here(threads_);
            prepare_variations(p, true);
        }
        for (Index first = 0; first < size; first += batch) {
            const Index count = std::min(batch, size - first);
            {
                const ScopedTimer timer(timings_, Part::contact);
                parallel_for(threads_, count, [&](Index begin, Index end) {
                    for (Index k = begin; k < end; ++k)
                        linearise(p, first + k, contact::VariationForm::matrices, tangents_[k]);
                });
            }
            const ScopedTimer timer(timings_, Part::assembly);
            parallel_lanes(threads_, [&](Lane lane) { // each the rows of its own nodes, in the order of the slaves
                for (Index k = 0; k < count; ++k) {
                    const ContactTangent& t = tangents_[k];
                    const Index j = first + k, coupling = first_[p] + j;
                    const std::vector<Index>& nodes = evaluation.point_nodes(j);
                    if (t.reaches && dependence_ != nullptr &&
                        linear::any_depends(*dependence_, unknowns_.slave(coupling), nodes)) {
                        const linear::FoldedContact folded(*dependence_, unknowns_.slave(coupling), nodes, t.A, t.E,
                                                           t.G);
                        matrix.add_contact(coupling, folded.masters, folded.A, t.D, folded.E, folded.G, lane);
                    } else if (t.reaches)
                        matrix.add_contact(coupling, nodes, t.A, t.D, t.E, t.G, lane);
                    else if (dependence_ != nullptr && dependence_->depends(unknowns_.slave(coupling))) {
                        const linear::FoldedContact force(*dependence_, unknowns_.slave(coupling), {},
                                                          Matrix::Zero(3, 3), contact::MatrixX3(0, 3), Matrix(0, 3));
                        matrix.add_contact(coupling, force.masters, force.A, t.D, force.E,
                                           Matrix::Zero(force.E.rows(), force.A.cols()), lane);
                    } else
                        matrix.add_contact(coupling, t.D, lane);
                }
            });
        }
    }
}

} // namespace osculate::equilibrium
