#include "osculate/time/ledger.hpp"

#include "osculate/core/field.hpp"

#include <algorithm>

namespace osculate::time {

namespace {

Field times(const linear::BlockMatrix& A, const Field& x) {
    Field y(x.size());
    A.multiply_add(x, y, 1);
    return y;
}

/// Fills in what depends on the state alone.
void take_stock(Ledger& ledger, const model::Model& model, const equilibrium::Dynamics& dynamics,
                const model::State& state) {
    const Field p = times(model.mass(dynamics.lumped_mass), state.v);
    ledger.kinetic = 0.5 * dot(state.v, p);
    ledger.strain = model::strain_energy(model, state.u, state.material, 1);
    const model::RigidMomenta rigid = model::rigid_momenta(model, state);
    const Vec3 none = Vec3::Zero();
    ledger.linear = sum_over(model.nodes(), none, [&](Index i) { return p[i]; });
    ledger.angular =
        sum_over(model.nodes(), none, [&](Index i) { return Vec3((model.X[i] + state.u[i]).cross(p[i])); });
    if (model.rigid.empty()) return;
    ledger.kinetic += rigid.kinetic;
    ledger.linear += rigid.linear;
    ledger.angular += rigid.angular;
}

/// Whether a node of an interface that gives way comes into contact in a step.
bool closes_softly(const model::State& from, const model::State& to) {
    for (std::size_t p = 0; p < to.contact.size(); ++p) {
        if (!to.contact[p].pair->options().overclosure) continue;
        const auto &before = from.contact[p].status, &now = to.contact[p].status;
        for (std::size_t j = 0; j < now.size(); ++j)
            if (contact::is_closed(now[j]) && !contact::is_closed(before[j])) return true;
    }
    return false;
}

/// Energy of interfaces that give way.
double of_interfaces(const model::ContactEvaluations& contact) {
    double sum = 0;
    for (const model::ContactEvaluation& evaluation : contact)
        if (evaluation.pair().options().overclosure)
            for (Index j = 0; j < evaluation.pair().size(); ++j) sum += evaluation.stored(j);
    return sum;
}

/// The same where nothing has been evaluated yet.
double of_interfaces(const model::Model& model, const model::State& state) {
    if (std::ranges::none_of(state.contact,
                             [](const auto& one) { return one.pair->options().overclosure.has_value(); }))
        return 0;
    model::ContactEvaluations contact = model::contact_evaluations(model::pairs_of(state.contact));
    std::vector<Vec3> x;
    for (std::size_t i = 0; i < model.X.size(); ++i) x.push_back(model.X[i] + state.u[i]);
    Timings timings;
    for (std::size_t p = 0; p < contact.size(); ++p) {
        contact[p].begin_step(x, state.contact[p], timings, 1);
        contact[p].evaluate(x, timings, 1);
    }
    return of_interfaces(contact);
}

} // namespace

Ledger opened(const model::Model& model, const equilibrium::Dynamics& dynamics, const model::State& state) {
    Ledger ledger;
    take_stock(ledger, model, dynamics, state);
    ledger.interface = of_interfaces(model, state);
    ledger.strain += ledger.interface;
    return ledger;
}

void revalue_interfaces(Ledger& ledger, const model::Model& model, const model::State& state) {
    const double now = of_interfaces(model, state), change = now - ledger.interface;
    ledger.interface = now;
    ledger.strain += change;
    ledger.external += change;
}

Ledger advanced(const Ledger& ledger, const model::Model& model, const equilibrium::Dynamics& dynamics,
                const equilibrium::Equilibrium& equilibrium, const model::State& from, const model::State& to,
                const Field& force, bool impact) {
    Ledger next = ledger;
    take_stock(next, model, dynamics, to);
    Field Du = weighted(1, to.u, -1, from.u);
    if (equilibrium.rigid() != nullptr) equilibrium.rigid()->make_conjugate(Du);

    double external = sum_over(model.nodes(), dot(Du, force), [&](Index i) {
        return Du[i].dot(equilibrium.constraints().reaction(i, equilibrium.unbalanced()[i]));
    });
    equilibrium::BodyWork work = equilibrium.bodies().work(to);
    if (equilibrium.rigid() != nullptr) work.inertia += equilibrium.rigid()->work_of_inertia();
    external += work.follower;
    double contact = 0, friction = 0;
    model::Taken law;
    for (std::size_t p = 0; p < to.contact.size(); ++p) {
        const model::ContactEvaluation& evaluation = equilibrium.contact()[p];
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            const Vec3& lambda = to.contact[p].lambda[j];
            const model::Taken taken = evaluation.taken(j, lambda);
            law.damping += taken.damping;
            law.algorithmic += taken.algorithmic;
            if (lambda.isZero(0) || !evaluation.point(j).found) continue;
            evaluation.for_each_force(j, lambda, [&](Index node, const Vec3& f) { contact += f.dot(Du[node]); });
            const Vec3& n = evaluation.point(j).normal;
            const Vec3 tangential = lambda - n * n.dot(lambda);
            const Vec3 drift = evaluation.drift(j, from.u, to.u);
            friction -= tangential.dot(drift);
        }
    }
    const double change = next.kinetic - ledger.kinetic + next.strain - (ledger.strain - ledger.interface);
    const double of_weights = equilibrium.rigid() != nullptr ? equilibrium.rigid()->work_of_weights() : 0;
    const double algorithmic = work.inertia + work.internal - of_weights - change;
    // what flows stays below the mean stress times the flow: the rest, of second order, is the integrator's
    const double plastic = model.nonlinear ? model.nonlinear->dissipated(model.X, to.material) -
                                                 model.nonlinear->dissipated(model.X, from.material)
                                           : 0;
    next.interface = of_interfaces(equilibrium.contact());
    next.strain += next.interface;
    const double taken = next.interface - ledger.interface; // by interfaces, from what contact does
    next.external += external;
    next.friction += friction;
    // an impact is inelastic on purpose
    const double of_impact = impact ? algorithmic - contact - friction - taken : 0;
    next.damping += work.damping + (impact ? of_impact : plastic + law.damping);
    next.settling += work.stiffness_damping + (impact ? of_impact - plastic : 0);
    const double late = algorithmic - plastic + law.algorithmic;
    // what a step too long for it takes of an impact on an interface is lost in closing gaps, as with exact contact
    const double closing = closes_softly(from, to) ? std::max(0.0, late) : 0;
    next.algorithmic += impact ? 0 : late - closing;
    next.contact += impact ? 0 : contact + friction + taken + law.damping + law.algorithmic - closing;
    next.balance += change - (external + contact - work.damping - algorithmic);
    return next;
}

} // namespace osculate::time
