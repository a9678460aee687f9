#include "app/check/thin_layers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace osculate::app {

namespace {

constexpr double same_way = 0.7;     ///< cosine: of the three directions of an element, the one that is meant
constexpr double share = 0.3;        ///< cosine: what acts at less of an angle than 73 degrees bends
constexpr double slender = 4;        ///< size over thickness: below, bodies are sheared and squeezed more than bent
constexpr double worth_saying = 1.5; ///< times too stiff
constexpr double few = 0.1;          ///< of the hexahedra: a rim, a fin

bool no_common_node(const mesh::Facet& a, const mesh::Facet& b) {
    return std::none_of(a.begin(), a.end(), [&](Index node) { return std::find(b.begin(), b.end(), node) != b.end(); });
}

/// Where a hexahedron reaches from one side of its body to the other.
struct Through {
    Vec3 direction = Vec3::Zero(); ///< unit
    double thickness = 0;          ///< m
    const mesh::Facet* sides[2]{};
};

/// Hexahedra of a body that reach through it and are bent.
struct Locking {
    Index thin = 0, hexahedra = 0; ///< of so many
    double factor = 0;             ///< how many times too stiff, in the mean
};

class Layers {
public:
    Layers(const Plan& plan, std::size_t b, double nu) : plan_(plan), body_(plan.model.bodies[b]), nu_(nu) {
        Eigen::AlignedBox3d box;
        for (const Vec3& X : body_.mesh.nodes) box.extend(X);
        size_ = box.diagonal().norm();
        for (const time::Stage& stage : plan.stages) add_loads(stage);
        if (!plan.stages.empty())
            for (const linear::NodeConstraint& c : plan.stages.front().constraints)
                if (own(c.node)) {
                    held_[c.node - body_.first_node].push_back(c.direction);
                    add(c.direction);
                }
        for (const auto& pair : plan.pairs_at_start()) {
            for (const Index node : pair->slaves().node) contact_.insert(model::material_node(plan.model, node));
            for (const Index node : pair->master_nodes()) contact_.insert(model::material_node(plan.model, node));
            for (const mesh::Facet& facet : pair->slaves().facets)
                if (own(model::material_node(plan.model, facet.nodes[0]))) add(mesh::facet_normal(facet, plan.model.X));
            if (own(model::material_node(plan.model, pair->master_nodes().front()))) add_master(*pair);
        }
    }

    [[nodiscard]] Locking locking() const {
        std::map<std::pair<Index, Index>, std::vector<const mesh::Facet*>> of_element;
        Index hexahedra = 0;
        for (const mesh::ElementBlock& block : body_.mesh.blocks)
            if (block.type == mesh::CellType::hex8) hexahedra += block.size();
        for (const mesh::Facet& facet : body_.exterior)
            if (body_.mesh.blocks[static_cast<std::size_t>(facet.block)].type == mesh::CellType::hex8)
                of_element[{facet.block, facet.element}].push_back(&facet);
        Locking result{0, hexahedra, 0};
        for (const auto& [element, facets] : of_element)
            if (const double factor = locks(facets); factor > worth_saying) {
                ++result.thin;
                result.factor += factor;
            }
        if (result.thin > 0) result.factor /= static_cast<double>(result.thin);
        return result;
    }

private:
    [[nodiscard]] bool own(Index node) const {
        return node >= body_.first_node && node < body_.first_node + body_.nodes();
    }

    /// Only which way something acts counts, up to a fifth or so.
    void add(const Vec3& v) {
        if (!(v.norm() > 0)) return;
        const Vec3 d = v.normalized();
        const std::array<int, 3> cell{static_cast<int>(std::lround(5 * d.x())),
                                      static_cast<int>(std::lround(5 * d.y())),
                                      static_cast<int>(std::lround(5 * d.z()))};
        acting_.emplace(cell, d);
    }

    void add_nodal(const SparseField& force) {
        for (const auto& [node, value] : force)
            if (own(node)) add(value);
    }

    void add_loads(const time::Stage& stage) {
        add_nodal(stage.force_start);
        add_nodal(stage.force_end);
        for (Index i = body_.first_node; stage.weight && i < body_.first_node + body_.nodes(); ++i)
            add((*stage.weight)[static_cast<std::size_t>(i)]);
        for (const time::CourseForce& force : stage.course_forces) add_nodal(force.pattern);
        for (const time::FollowerPressure& pressure : stage.follower_pressures)
            for (const mesh::SurfaceFace& face : pressure.faces)
                if (own(face.nodes[0])) {
                    const auto x = [&](std::size_t c) {
                        return plan_.model.X[static_cast<std::size_t>(face.nodes[c])];
                    };
                    add((x(1) - x(0)).cross(x(2) - x(0)));
                }
    }

    void add_master(const model::ContactPair& pair) {
        const std::vector<Vec3> x = pair.vertices(plan_.model.X);
        for (Index f = 0; f < pair.surface().facet_count(); ++f) {
            const auto v = pair.surface().facet_vertices(f);
            add((x[v[1]] - x[v[0]]).cross(x[v[2]] - x[v[0]]));
        }
    }

    [[nodiscard]] bool bends(const Vec3& direction) const {
        return std::ranges::any_of(acting_, [&](const auto& a) { return std::abs(a.second.dot(direction)) > share; });
    }

    [[nodiscard]] bool in_contact(const mesh::Facet& facet) const {
        return std::all_of(facet.begin(), facet.end(),
                           [&](Index node) { return contact_.contains(body_.first_node + node); });
    }

    [[nodiscard]] bool held(const mesh::Facet& facet, const Vec3& direction) const {
        return std::all_of(facet.begin(), facet.end(), [&](Index node) {
            const auto at = held_.find(node);
            return at != held_.end() && std::ranges::any_of(at->second, [&](const Vec3& d) {
                       return std::abs(d.dot(direction)) > same_way;
                   });
        });
    }

    /// How many times too stiff a hexahedron is with these exterior faces, the worst way that it is bent; 0: it is not.
    [[nodiscard]] double locks(const std::vector<const mesh::Facet*>& facets) const {
        std::vector<Through> through;
        const std::vector<Vec3>& X = body_.mesh.nodes;
        for (std::size_t i = 0; i < facets.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (no_common_node(*facets[i], *facets[j])) {
                    const Vec3 t = mesh::facet_centroid(*facets[i], X) - mesh::facet_centroid(*facets[j], X);
                    through.push_back({t.normalized(), t.norm(), {facets[i], facets[j]}});
                }
        double worst = 0;
        for (const Through& t : through) {
            if (held(*t.sides[0], t.direction) || held(*t.sides[1], t.direction) || !bends(t.direction)) continue;
            if (in_contact(*t.sides[0]) && in_contact(*t.sides[1])) continue; // squeezed, as in a stack
            if (size_ < slender * t.thickness) continue;
            double length = 0;
            for (const Vec3& side : middle_lines(*t.sides[0])) {
                const bool crossed = std::ranges::any_of(through, [&](const Through& other) {
                    return std::abs(other.direction.dot(side.normalized())) > same_way;
                });
                if (!crossed) length = std::max(length, side.norm());
            }
            if (length > 0) worst = std::max(worst, too_stiff_in_bending(length / t.thickness, nu_));
        }
        return worst;
    }

    /// The lines that join the middles of opposite edges.
    [[nodiscard]] std::array<Vec3, 2> middle_lines(const mesh::Facet& facet) const {
        const auto x = [&](std::size_t c) { return body_.mesh.nodes[static_cast<std::size_t>(facet.nodes[c])]; };
        return {0.5 * (x(1) + x(2) - x(0) - x(3)), 0.5 * (x(2) + x(3) - x(0) - x(1))};
    }

    const Plan& plan_;
    const model::Body& body_;
    double nu_;
    double size_ = 0;                           ///< of the body, m
    std::map<std::array<int, 3>, Vec3> acting_; ///< which way loads, supports and contact act on the body
    std::set<Index> contact_;                   ///< global nodes of all slaves and masters
    std::map<Index, std::vector<Vec3>> held_;   ///< by the body's node, in the first stage
};

} // namespace

double too_stiff_in_bending(double slenderness, double nu) {
    return (1 - nu) / ((1 + nu) * (1 - 2 * nu)) + slenderness * slenderness / (2 * (1 + nu));
}

std::vector<Warning> thin_layers(const scene::Scene& scene, const Plan& plan) {
    std::vector<Warning> found;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const scene::Body& body = scene.bodies[b].second;
        if (body.rigid || body.hex_formulation != HexFormulation::full) continue;
        const Locking locking = Layers(plan, b, scene::elastic(body.material).nu).locking();
        if (locking.thin == 0 || static_cast<double>(locking.thin) < few * static_cast<double>(locking.hexahedra))
            continue;
        found.push_back(
            {"bodies." + scene.bodies[b].first + ".hex_formulation",
             fmt::format(
                 "full, but {} of {} hexahedra reach through the whole thickness: the body is about {:.2g} times too "
                 "stiff in bending; {}",
                 locking.thin, locking.hexahedra, locking.factor,
                 std::holds_alternative<scene::LinearElastic>(body.material)
                     ? "use incompatible_modes, which bends correctly"
                     : "use elements half as long as the body is thick, and two or more through the thickness")});
    }
    return found;
}

} // namespace osculate::app
