#pragma once
/// What `osculate explain` shows of a plan.

#include "osculate/app/compile.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// Every part that a plan may hold, with the reason why it is there or left out, and what it takes.
[[nodiscard]] std::vector<PlanItem> plan_items(const scene::Scene& scene, const Plan& plan);

/// Parts in the order of `osculate explain`.
class PlanList {
public:
    /// @param cost  of the part where it is present
    void say(std::string part, bool present, std::string reason, PlanCost cost = {});
    /// What a part already listed takes, where it is present.
    void set_cost(const std::string& part, PlanCost cost);
    [[nodiscard]] std::vector<PlanItem> take() { return std::move(items_); }

private:
    std::vector<PlanItem> items_;
};

/// Stiffness, inertia, damping, loads: what bodies do by themselves.
void add_body_items(const scene::Scene& scene, const Plan& plan, PlanList& list);
/// Pairs, their surfaces and laws, and what judges steps by them.
void add_contact_items(const scene::Scene& scene, const Plan& plan, PlanList& list);
/// Files and what is computed for them alone.
void add_output_items(const scene::Scene& scene, const Plan& plan, PlanList& list);

/// Bytes of a matrix over the nodes of all bodies.
[[nodiscard]] double bytes_of(const linear::BlockMatrix& matrix);
/// How many stages are dynamic.
[[nodiscard]] std::size_t dynamic_stages(const Plan& plan);

} // namespace osculate::app
