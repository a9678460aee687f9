#include "osculate/output/history.hpp"

#include "osculate/model/general_contact.hpp"
#include "osculate/output/contact_resultants.hpp"

#include <utility>

namespace osculate::output {

namespace {

constexpr const char* axes[] = {"_x", "_y", "_z"};

struct EnergyColumn {
    const char* name;
    double time::Ledger::*value;
};
constexpr EnergyColumn energies[] = {
    {"kinetic", &time::Ledger::kinetic},   {"strain", &time::Ledger::strain},
    {"external", &time::Ledger::external}, {"friction", &time::Ledger::friction},
    {"damping", &time::Ledger::damping},   {"algorithmic", &time::Ledger::algorithmic},
    {"contact", &time::Ledger::contact},   {"balance", &time::Ledger::balance},
};

constexpr const char* general_prefix = "pair.general.";

void append(std::vector<Cell>& cells, const Vec3& v) {
    for (int k = 0; k < 3; ++k) cells.emplace_back(v(k));
}

std::vector<Vec3> set_reactions(const Snapshot& snapshot, const linear::Constraints& constraints) {
    std::vector<Vec3> sum(snapshot.model().sets.size(), Vec3::Zero());
    for (Index node = 0; node < constraints.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const linear::NodeConstraint* held = constraints.constraint(node, k);
                held != nullptr && held->set >= 0) {
                const Vec3 axis = constraints.frame(node).col(k);
                sum[held->set] += axis * axis.dot(snapshot.reactions()[node]);
            }
    return sum;
}

} // namespace

std::vector<Vec3> nodal_reactions(const linear::Constraints& constraints, const std::vector<Vec3>& unbalanced) {
    std::vector<Vec3> reactions(unbalanced.size());
    for (Index node = 0; node < constraints.nodes(); ++node)
        reactions[node] = constraints.reaction(node, unbalanced[node]);
    return reactions;
}

std::vector<std::string> History::columns(const model::Model& model, bool pairs, const std::vector<Index>& sets,
                                          bool ledger) {
    std::vector<std::string> names{"time", "dt", "iterations"};
    const auto vector = [&](const std::string& name) {
        for (const char* axis : axes) names.push_back(name + axis);
    };
    const auto resultants = [&](const std::string& prefix) {
        vector(prefix + "force");
        for (const char* name : {"normal", "friction"}) names.push_back(prefix + name);
        vector(prefix + "moment");
        for (const char* name : {"area", "open", "stick", "slip", "penetration"}) names.push_back(prefix + name);
    };
    if (pairs)
        for (const auto& pair : model.pairs) resultants("pair." + pair->name() + ".");
    if (pairs && model.general) {
        resultants(general_prefix);
        for (const model::OuterSurface& surface : model.general->surfaces()) {
            vector("body." + surface.name + ".contact_force");
            vector("body." + surface.name + ".contact_moment");
        }
    }
    for (const Index set : sets) vector("set." + model.sets[set].name + ".reaction");
    for (const model::RigidBody& rigid : model.rigid) {
        const std::string prefix = (rigid.coupling ? "coupling." : "body.") + rigid.name + ".ref_";
        for (const char* name : {"u", "rotation", "force", "moment"}) vector(prefix + name);
    }
    if (ledger) {
        for (const EnergyColumn& energy : energies) names.push_back(std::string("energy.") + energy.name);
        vector("momentum.linear");
        vector("momentum.angular");
    }
    return names;
}

History::History(const std::filesystem::path& path, const model::Model& model, bool pairs, std::vector<Index> sets,
                 bool ledger, std::optional<std::uintmax_t> keep)
    : pairs_(pairs), sets_(std::move(sets)), ledger_(ledger), table_(path, columns(model, pairs, sets_, ledger), keep) {
}

std::vector<Cell> History::cells(const Snapshot& snapshot, const linear::Constraints& constraints, double dt,
                                 int iterations, bool pairs, const std::vector<Index>& sets, bool ledger,
                                 const time::Ledger* energies_now) {
    std::vector<Cell> cells{snapshot.state().time, dt, long{iterations}};
    const auto add = [&](const ContactResultants& sum) {
        append(cells, sum.force);
        cells.insert(cells.end(), {sum.normal, sum.friction});
        append(cells, sum.moment);
        cells.insert(cells.end(), {sum.area, sum.open, sum.stick, sum.slip, sum.penetration});
    };
    const model::Model& model = snapshot.model();
    for (std::size_t p = 0; pairs && p < model.pairs.size(); ++p)
        add(contact_resultants(snapshot, static_cast<Index>(p)));
    if (pairs && model.general) {
        add(general_resultants(snapshot));
        for (const BodyResultants& body : body_resultants(snapshot)) {
            append(cells, body.force);
            append(cells, body.moment);
        }
    }
    if (!sets.empty()) {
        const std::vector<Vec3> reactions = set_reactions(snapshot, constraints);
        for (const Index set : sets) append(cells, reactions[set]);
    }
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        const model::RigidBody& rigid = model.rigid[k];
        const auto r = static_cast<std::size_t>(rigid.reference);
        append(cells, snapshot.state().u[r]);
        append(cells, snapshot.state().rigid[k].rotation);
        append(cells, snapshot.reactions()[rigid.reference]);
        append(cells, Vec3(rigid.radius * snapshot.reactions()[rigid.rotation()]));
    }
    if (ledger && energies_now != nullptr) {
        for (const EnergyColumn& energy : energies) cells.emplace_back(energies_now->*energy.value);
        append(cells, energies_now->linear);
        append(cells, Vec3(energies_now->angular + snapshot.model().origin.cross(energies_now->linear)));
    } else if (ledger) {
        cells.resize(cells.size() + std::size(energies) + 6, std::string());
    }
    return cells;
}

void History::row(const Snapshot& snapshot, const linear::Constraints& constraints, double dt, int iterations,
                  const time::Ledger* ledger) {
    table_.row(cells(snapshot, constraints, dt, iterations, pairs_, sets_, ledger_, ledger));
}

} // namespace osculate::output
