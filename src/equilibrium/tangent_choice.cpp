#include "osculate/equilibrium/tangent_choice.hpp"

#include <algorithm>

namespace osculate::equilibrium {

bool CondensationCost::pays() const {
    constexpr double as_fast = 6; // dense operations are some three times quicker, and a few factorisations usual
    constexpr double most = 4e9;  // bytes
    return condensed <= as_fast * factorising && bytes <= most;
}

CondensationCost condensation_cost(const model::Model& model) {
    constexpr double nested_dissection = 14; // operations of METIS and CHOLMOD over the square of a body's unknowns
    constexpr double laws = 2;               // T's of a solve
    std::vector<char> touched(model.X.size(), 0);
    double forces = 0;
    for (const auto& pair : model.pairs) {
        for (const Index node : pair->slaves().node) touched[node] = 1;
        for (const Index node : pair->master_nodes()) touched[node] = 1;
        forces += 3.0 * static_cast<double>(pair->size());
    }
    CondensationCost cost;
    for (const model::Body& body : model.bodies) {
        const double all = 3.0 * static_cast<double>(body.nodes());
        const double kept = 3.0 * static_cast<double>(std::count(touched.begin() + body.first_node,
                                                                 touched.begin() + body.first_node + body.nodes(), 1));
        cost.factorising += nested_dissection * all * all;
        cost.condensed += kept * kept * kept;
        cost.bytes += sizeof(double) * kept * kept;
    }
    cost.condensed += laws * 2.0 / 3.0 * forces * forces * forces;
    cost.bytes += sizeof(double) * forces * forces;
    return cost;
}

bool goes_by_multigrid(const model::Model& model, linear::LinearSolver solver) {
    constexpr Index many = 20000;      // nodes from which cycles cost less than factors that serve one step
    constexpr Index very_many = 50000; // and less than those that condensation makes once
    if (solver != linear::LinearSolver::automatic) return solver == linear::LinearSolver::multigrid;
    const bool condensable = !model.finite_strain && condensation_cost(model).pays();
    return model.nodes() > (condensable ? very_many : many);
}

bool may_factorise(const model::Model& model, linear::LinearSolver solver) {
    constexpr Index most = 100000; // nodes: LU takes some 7 GB
    return !goes_by_multigrid(model, solver) || model.nodes() <= most;
}

bool goes_by_products(const model::Model& model, linear::LinearSolver solver) {
    if (goes_by_multigrid(model, solver)) return true;
    constexpr Index most = 40000; // some 50 kB each on a smooth master
    Index slaves = 0;
    for (const auto& pair : model.pairs) slaves += pair->size();
    return slaves > 0 && slaves <= most && solver != linear::LinearSolver::direct;
}

bool condenses(const model::Model& model, linear::LinearSolver solver, bool follows) {
    if (model.finite_strain || follows || goes_by_multigrid(model, solver) || !goes_by_products(model, solver))
        return false;
    return solver == linear::LinearSolver::condensed ||
           (solver == linear::LinearSolver::automatic && condensation_cost(model).pays());
}

} // namespace osculate::equilibrium
