#include "osculate/output/fields.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/core/error.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "output/nodal_strain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace osculate::output {

namespace {

using Values = std::vector<double>;

void append(Values& values, const Vec3& v) {
    values.insert(values.end(), v.data(), v.data() + 3);
}

void append(Values& values, double number) {
    values.push_back(number);
}

/// Number of points of a body, or of its piece, that have values.
std::size_t points(const Snapshot& snapshot, Index body) {
    const Piece* piece = snapshot.piece(body);
    return piece != nullptr ? piece->nodes.size() : static_cast<std::size_t>(snapshot.model().bodies[body].nodes());
}

/// Values of a body, point by point. @param value  of a node of the model
template <class Value> Values at_points(const Snapshot& snapshot, Index body, int components, Value&& value) {
    const Index first = snapshot.model().bodies[body].first_node;
    const Piece* piece = snapshot.piece(body);
    Values values;
    values.reserve(static_cast<std::size_t>(components) * points(snapshot, body));
    for (std::size_t i = 0; i < points(snapshot, body); ++i)
        append(values, value(first + (piece != nullptr ? piece->nodes[i] : static_cast<Index>(i))));
    return values;
}

/// Nodal vectors of one body.
Values of_body(const Snapshot& snapshot, Index body, const std::vector<Vec3>& nodal) {
    return at_points(snapshot, body, 3,
                     [&](Index node) -> const Vec3& { return nodal[static_cast<std::size_t>(node)]; });
}

/// f(slave, contact state, whether it is closed) for every slave node of a pair.
template <class F> void for_each_slave(const Snapshot& snapshot, Index pair, F&& f) {
    const model::ContactHistory& history = snapshot.state().contact[pair];
    for (Index j = 0; j < snapshot.model().pairs[pair]->size(); ++j)
        f(j, snapshot.contact(pair, j), contact::is_closed(history.status[j]));
}

Values displacement(const Snapshot& snapshot, Index body) {
    return of_body(snapshot, body, snapshot.state().u);
}

/// Nodal vectors that a state may lack: zero.
Values of_body_if_any(const Snapshot& snapshot, Index body, const std::vector<Vec3>& nodal) {
    if (nodal.empty()) return Values(3 * points(snapshot, body), 0.0);
    return of_body(snapshot, body, nodal);
}

Values velocity(const Snapshot& snapshot, Index body) {
    return of_body_if_any(snapshot, body, snapshot.state().v);
}

Values acceleration(const Snapshot& snapshot, Index body) {
    return of_body_if_any(snapshot, body, snapshot.state().a);
}

Values reaction(const Snapshot& snapshot, Index body) {
    return at_points(snapshot, body, 3, [&](Index node) { return snapshot.reactions()[node]; });
}

Values out_of_balance(const Snapshot& snapshot, Index body) {
    return of_body_if_any(snapshot, body, snapshot.out_of_balance());
}

Values penetration(const Snapshot& snapshot, Index body) {
    const model::Body& whole = snapshot.model().bodies[body];
    const Piece* piece = snapshot.piece(body);
    Values values(points(snapshot, body), 0.0);
    if (snapshot.audit() == nullptr) return values;
    for (const auto& [node, excess] : snapshot.audit()->nodes) {
        if (node < whole.first_node || node >= whole.first_node + whole.nodes()) continue;
        const auto own = static_cast<std::size_t>(node - whole.first_node);
        const Index point = piece != nullptr ? piece->point[own] : static_cast<Index>(own);
        if (point >= 0) values[static_cast<std::size_t>(point)] = excess;
    }
    return values;
}

/// What contact does to the nodes of one body. @param what  of a node
template <class What> Values contact_of_body(const Snapshot& snapshot, Index body, What&& what) {
    const NodalContact& contact = snapshot.nodal_contact();
    return at_points(snapshot, body, sizeof(what({})) / sizeof(double),
                     [&](Index node) { return what(contact[static_cast<std::size_t>(node)]); });
}

Values all_contact_force(const Snapshot& snapshot, Index body) {
    return contact_of_body(snapshot, body, [](const NodalContact::Node& node) { return node.force; });
}

Values contact_pressure(const Snapshot& snapshot, Index body) {
    return contact_of_body(snapshot, body, [](const NodalContact::Node& node) { return node.pressure; });
}

Values contact_gap(const Snapshot& snapshot, Index body) {
    return contact_of_body(snapshot, body, [](const NodalContact::Node& node) { return node.gap; });
}

Values contact_status(const Snapshot& snapshot, Index body) {
    return contact_of_body(snapshot, body, [](const NodalContact::Node& node) { return node.status; });
}

Values contact_slip(const Snapshot& snapshot, Index body) {
    return contact_of_body(snapshot, body, [](const NodalContact::Node& node) { return node.slip; });
}

Values stress(const Snapshot& snapshot, Index body) {
    const Snapshot::Stress& sigma = snapshot.stress(body);
    Values values;
    values.reserve(static_cast<std::size_t>(sigma.size()));
    for (Index i = 0; i < sigma.rows(); ++i)
        for (int c = 0; c < 6; ++c) values.push_back(sigma(i, c));
    return values;
}

Values von_mises(const Snapshot& snapshot, Index body) {
    // sqrt(((s_xx - s_yy)^2 + (s_yy - s_zz)^2 + (s_zz - s_xx)^2) / 2 + 3 (s_xy^2 + s_yz^2 + s_zx^2))
    const Snapshot::Stress& sigma = snapshot.stress(body);
    Values values;
    for (Index i = 0; i < sigma.rows(); ++i) {
        const Vec6 s = sigma.row(i);
        const Vec3 difference(s(0) - s(1), s(1) - s(2), s(2) - s(0));
        values.push_back(std::sqrt(difference.squaredNorm() / 2 + 3 * s.tail<3>().squaredNorm()));
    }
    return values;
}

/// Eigenvalue `k` of the stress, 0 the least.
template <int k> Values principal(const Snapshot& snapshot, Index body) {
    const Snapshot::Stress& sigma = snapshot.stress(body);
    Values values;
    for (Index i = 0; i < sigma.rows(); ++i) {
        const Vec6 s = sigma.row(i);
        Mat3 tensor;
        tensor << s(0), s(3), s(5), s(3), s(1), s(4), s(5), s(4), s(2);
        values.push_back(principal_axes(tensor).values(k));
    }
    return values;
}

Values strain(const Snapshot& snapshot, Index body) {
    const model::Body& part = snapshot.model().bodies[body];
    if (part.rigid) return Values(6 * points(snapshot, body), 0.0);
    return nodal_strain(snapshot.model().bodies[body], snapshot.state().u, snapshot.part(body));
}

Values energy_density(const Snapshot& snapshot, Index body) {
    const model::Body& part = snapshot.model().bodies[body];
    if (part.rigid) return Values(points(snapshot, body), 0.0);
    return nodal_energy_density(snapshot.model(), body, snapshot.state(), snapshot.part(body));
}

/// Equivalent, 0 in elastic bodies.
Values plastic_strain(const Snapshot& snapshot, Index body) {
    const model::Body& part = snapshot.model().bodies[body];
    if (part.rigid) return Values(points(snapshot, body), 0.0);
    return nodal_plastic_strain(snapshot.model(), body, snapshot.state(), snapshot.part(body));
}

Values gap(const Snapshot& snapshot, Index pair) {
    Values values;
    for_each_slave(snapshot, pair, [&](Index j, const contact::ContactState& contact, bool) {
        values.push_back(snapshot.has_partner(pair, j) ? contact.gap : std::numeric_limits<double>::quiet_NaN());
    });
    return values;
}

Values contact_force(const Snapshot& snapshot, Index pair) {
    Values values;
    for (const Vec3& lambda : snapshot.state().contact[pair].lambda) append(values, lambda);
    return values;
}

Values normal_stress(const Snapshot& snapshot, Index pair) {
    Values values;
    for_each_slave(snapshot, pair, [&](Index j, const contact::ContactState& contact, bool closed) {
        values.push_back(closed ? contact.lambda.dot(contact.normal) / snapshot.evaluation(pair).area(j) : 0);
    });
    return values;
}

Values tangential_traction(const Snapshot& snapshot, Index pair) {
    const model::ContactEvaluation& evaluation = snapshot.evaluation(pair);
    Values values;
    for_each_slave(snapshot, pair, [&](Index j, const contact::ContactState& contact, bool closed) {
        const Vec3& n = contact.normal;
        append(values, closed ? Vec3((contact.lambda - n * n.dot(contact.lambda)) / evaluation.area(j)) : Vec3::Zero());
    });
    return values;
}

Values friction_use(const Snapshot& snapshot, Index pair) {
    const double mu = snapshot.model().pairs[pair]->options().friction;
    Values values;
    for_each_slave(snapshot, pair, [&](Index, const contact::ContactState& contact, bool closed) {
        const double p_N = contact.lambda.dot(contact.normal);
        const double limit = mu * p_N;
        values.push_back(closed && limit > 0 ? (contact.lambda - p_N * contact.normal).norm() / limit : 0);
    });
    return values;
}

Values slip(const Snapshot& snapshot, Index pair) {
    Values values;
    for_each_slave(snapshot, pair, [&](Index j, const contact::ContactState& contact, bool closed) {
        const Vec3 d = closed ? snapshot.drift(pair, j) : Vec3::Zero();
        const Vec3& n = contact.normal;
        append(values, d - n * n.dot(d));
    });
    return values;
}

Values slip_rate(const Snapshot& snapshot, Index pair) {
    Values values = slip(snapshot, pair);
    for (double& value : values) value = snapshot.dt() > 0 ? value / snapshot.dt() : 0;
    return values;
}

/// Whether a facet of the master is one of the model's, no mirror image.
bool is_own(const Snapshot& snapshot, const mesh::Facet& facet) {
    return std::all_of(facet.begin(), facet.end(), [&](Index node) { return node < snapshot.model().nodes(); });
}

Values master_facet(const Snapshot& snapshot, Index pair) {
    const model::ContactPair& term = *snapshot.model().pairs[pair];
    std::vector<double> number; // among the model's own
    double next = 0;
    for (const mesh::Facet& facet : term.surface().facets()) number.push_back(is_own(snapshot, facet) ? next++ : -1);
    Values values;
    for (Index j = 0; j < term.size(); ++j) {
        const Index facet = snapshot.has_partner(pair, j) ? snapshot.evaluation(pair).hit(j).facet : -1;
        values.push_back(facet < 0 ? -1 : number[static_cast<std::size_t>(facet)]);
    }
    return values;
}

Values status(const Snapshot& snapshot, Index pair) {
    Values values;
    for (const contact::Status s : snapshot.state().contact[pair].status)
        values.push_back(s == contact::Status::open ? 0 : s == contact::Status::stick ? 1 : 2);
    return values;
}

Values normal(const Snapshot& snapshot, Index pair) {
    Values values;
    for (Index j = 0; j < snapshot.model().pairs[pair]->size(); ++j) {
        const contact::ContactPoint& point = snapshot.evaluation(pair).point(j);
        append(values, point.found ? point.normal : Vec3::Zero());
    }
    return values;
}

std::vector<Vec3> forces_on_master(const Snapshot& snapshot, Index pair) {
    const model::ContactEvaluation& evaluation = snapshot.evaluation(pair);
    const model::ContactPair& term = evaluation.pair();
    std::vector<Vec3> force(term.master_nodes().size(), Vec3::Zero());
    for (Index j = 0; j < term.size(); ++j) {
        const contact::ContactPoint& point = evaluation.point(j);
        if (!point.found) continue;
        for (Index i = 0; i < evaluation.carriers(j); ++i)
            force[term.own_vertex(point.nodes[i])] +=
                evaluation.master_force(j, i, snapshot.state().contact[pair].lambda[j]);
    }
    return force;
}

Values master_contact_force(const Snapshot& snapshot, Index pair) {
    Values values;
    for (const Vec3& f : forces_on_master(snapshot, pair)) append(values, f);
    return values;
}

/// Force against the outward normal over the area that belongs to a vertex, by the master's own facets.
Values master_normal_stress(const Snapshot& snapshot, Index pair) {
    const model::ContactPair& term = *snapshot.model().pairs[pair];
    const std::vector<Vec3> force = forces_on_master(snapshot, pair);
    struct Vertex {
        Vec3 normal = Vec3::Zero(); ///< sum of area vectors, at current positions, m^2
        double area = 0;            ///< m^2
    };
    std::unordered_map<Index, Vertex> vertices;
    for (const mesh::Facet& facet : term.surface().facets()) {
        if (!is_own(snapshot, facet)) continue;
        const auto shares = fe::tributary_areas(facet, snapshot.model().X);
        mesh::Facet corners;
        std::vector<Vec3> x;
        for (const Index node : facet) {
            corners.nodes[static_cast<std::size_t>(corners.count)] = corners.count;
            ++corners.count;
            x.push_back(snapshot.x(node));
        }
        const Vec3 n = mesh::facet_area_vector(corners, x);
        for (int c = 0; c < facet.count; ++c) {
            const auto k = static_cast<std::size_t>(c);
            Vertex& vertex = vertices[facet.nodes[k]];
            vertex.area += shares[k];
            vertex.normal += n;
        }
    }
    Values values;
    for (std::size_t i = 0; i < force.size(); ++i) {
        const auto found = vertices.find(term.master_nodes()[i]);
        const bool known = found != vertices.end() && found->second.area > 0 && found->second.normal.norm() > 0;
        values.push_back(known ? -force[i].dot(found->second.normal.normalized()) / found->second.area : 0);
    }
    return values;
}

Values area(const Snapshot& snapshot, Index pair) {
    Values values;
    for (Index j = 0; j < snapshot.model().pairs[pair]->size(); ++j)
        values.push_back(snapshot.evaluation(pair).area(j));
    return values;
}

constexpr OutputField table[] = {
    {"displacement", FieldPlace::body, 3, "m", false, displacement},
    {"velocity", FieldPlace::body, 3, "m/s", false, velocity},           // 0 before the first dynamic stage
    {"acceleration", FieldPlace::body, 3, "m/s^2", false, acceleration}, // the same
    {"stress", FieldPlace::body, 6, "Pa", false, stress},
    {"von_mises", FieldPlace::body, 1, "Pa", false, von_mises},
    {"stress_max", FieldPlace::body, 1, "Pa", false, principal<2>},
    {"stress_mid", FieldPlace::body, 1, "Pa", false, principal<1>},
    {"stress_min", FieldPlace::body, 1, "Pa", false, principal<0>},
    {"strain", FieldPlace::body, 6, "", false, strain}, // tensor components: shears are halves of the angles
    {"energy_density", FieldPlace::body, 1, "J/m^3", false, energy_density},
    {"plastic_strain", FieldPlace::body, 1, "", false, plastic_strain},
    {"reaction", FieldPlace::body, 3, "N", false, reaction},
    {"out_of_balance", FieldPlace::body, 3, "N", false, out_of_balance},   // of a failed iterate; 0 otherwise
    {"penetration", FieldPlace::body, 1, "m", false, penetration},         // in another body, by the audit; 0 outside
    {"contact_force", FieldPlace::body, 3, "N", false, all_contact_force}, // as slave and as master
    {"contact_pressure", FieldPlace::body, 1, "Pa", false, contact_pressure}, // > 0 in compression; 0 inside
    {"contact_gap", FieldPlace::body, 1, "m", false, contact_gap},            // as slave; NaN without a partner
    {"contact_status", FieldPlace::body, 1, "", true, contact_status},        // as slave: 0 open, 1 stick, 2 slip
    {"contact_slip", FieldPlace::body, 3, "m", false, contact_slip},          // of the step, as slave
    {"gap", FieldPlace::slave, 1, "m", false, gap},                           // NaN without a partner
    {"contact_force", FieldPlace::slave, 3, "N", false, contact_force},
    {"normal_stress", FieldPlace::slave, 1, "Pa", false, normal_stress},             // > 0 in compression
    {"tangential_traction", FieldPlace::slave, 3, "Pa", false, tangential_traction}, // on the slave
    {"friction_use", FieldPlace::slave, 1, "", false, friction_use}, // |traction| over its limit; 0 without friction
    {"slip_rate", FieldPlace::slave, 3, "m/s", false, slip_rate},    // slip over the step's dt
    {"master_facet", FieldPlace::slave, 1, "", true, master_facet},  // below; -1 without a partner, or a mirror image
    {"slip", FieldPlace::slave, 3, "m", false, slip},                // of the step; 0 where open
    {"status", FieldPlace::slave, 1, "", true, status},              // 0 open, 1 stick, 2 slip
    {"normal", FieldPlace::slave, 3, "", false, normal},             // out of the master; 0 without a partner
    {"area", FieldPlace::slave, 1, "m^2", false, area}, // tributary to the node, in the reference configuration
    {"contact_force", FieldPlace::master, 3, "N", false, master_contact_force},
    {"normal_stress", FieldPlace::master, 1, "Pa", false, master_normal_stress}, // > 0 in compression
};

} // namespace

std::span<const OutputField> all_fields() {
    return table;
}

const OutputField& field(FieldPlace where, const std::string& name) {
    for (const OutputField& row : table)
        if (row.where == where && name == row.name) return row;
    throw InternalError("no field is called '" + name + "' there");
}

Array evaluate(const OutputField& field, const Snapshot& snapshot, Index body_or_pair) {
    return {field.name, field.components, field.values(snapshot, body_or_pair), field.integer, field.unit};
}

} // namespace osculate::output
