#pragma once
/// The same scene elsewhere: turned, mirrored, moved, in other units, numbered otherwise. Any scene, through its structs.

#include "osculate/app/compile.hpp"
#include "osculate/scene/scene.hpp"
#include "scene/describe.hpp"
#include "support/renumber.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

namespace osculate::support {

/// What is done to a scene; positions become length * (turn * X + shift).
struct Transformation {
    std::string name;
    double length = 1, mass = 1, time = 1; ///< a number of metres, kilograms, seconds becomes so many times larger
    Mat3 turn = Mat3::Identity();          ///< orthogonal; a determinant of -1 mirrors
    double sizes_away = 0;                 ///< of the diagonal around all bodies
    bool renumber = false;                 ///< nodes, elements and facets of every body at random
    bool reverse_bodies = false;
    bool swap_sides = false; ///< slave for master: another approximation, not the same scene

    [[nodiscard]] double force() const { return mass * length / (time * time); }
    [[nodiscard]] double factor(const scene::Dimension& d) const {
        return std::pow(length, d.length) * std::pow(mass, d.mass) * std::pow(time, d.time);
    }
};

namespace detail {

inline std::string digits(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "(%.17g)", value);
    return text;
}

inline void rescale(scene::Course& course, double factor, double time) {
    if (auto* value = std::get_if<double>(&course.form)) *value *= factor;
    if (auto* table = std::get_if<scene::Table>(&course.form))
        for (auto& [t, value] : table->rows) t *= time, value *= factor;
    if (auto* expression = std::get_if<scene::Expression>(&course.form)) {
        expression->size *= factor;
        if (time != 1)
            expression->text =
                std::regex_replace(expression->text, std::regex(R"(\bt\b)"), "(t*" + digits(1 / time) + ")");
    }
}

/// Multiplies every number of a scene that has a dimension.
class Rescaler final : public scene::Visitor {
public:
    explicit Rescaler(const Transformation& by) : by_(by) {}

    void number(const scene::Key& key, double& value) override { value *= by_.factor(key.unit); }
    void optional_number(const scene::Key& key, std::optional<double>& value) override {
        if (value) *value *= by_.factor(key.unit);
    }
    void optional_relative_length(const scene::Key& /*key*/, std::optional<scene::RelativeLength>& value) override {
        if (value && value->metres) value->value *= by_.length;
    }
    void vector(const scene::Key& key, Vec3& value) override { value *= by_.factor(key.unit); }
    void optional_vector(const scene::Key& key, std::optional<Vec3>& value) override {
        if (value) *value *= by_.factor(key.unit);
    }
    void course(const scene::Key& key, scene::Course& value) override {
        rescale(value, by_.factor(key.unit), by_.time);
    }
    void optional_course(const scene::Key& key, std::optional<scene::Course>& value) override {
        if (value) course(key, *value);
    }
    void courses(const scene::Key& key, std::array<scene::Course, 3>& value) override {
        for (scene::Course& component : value) course(key, component);
    }
    void table(const scene::Key& key, const scene::Key& first, scene::Table& value) override {
        for (auto& row : value.rows) {
            row[0] *= by_.factor(first.unit);
            row[1] *= by_.factor(key.unit);
        }
    }
    void integer(const scene::Key& /*key*/, int& /*value*/) override {}
    void divisions(const scene::Key& /*key*/, std::array<int, 3>& /*value*/) override {}
    void integers(const scene::Key& /*key*/, std::vector<int>& /*value*/) override {}
    void flag(const scene::Key& /*key*/, bool& /*value*/) override {}
    void text(const scene::Key& /*key*/, std::string& /*value*/) override {}
    void two_names(const scene::Key& /*key*/, std::array<std::string, 2>& /*names*/) override {}
    void word(const scene::Key& /*key*/, const scene::Words& /*all*/, std::size_t& /*index*/) override {}
    void words(const scene::Key& /*key*/, const scene::Words& /*all*/, std::vector<std::string>& /*value*/) override {}
    void axes(const scene::Key& /*key*/, Mat3& /*value*/) override {}
    void points(const scene::Key& key, std::vector<Vec3>& value) override {
        for (Vec3& point : value) vector(key, point);
    }
    void group(const scene::Key& /*key*/, const std::function<void()>& body) override { body(); }
    void optional_group(const scene::Key& /*key*/, bool& present, const std::function<void()>& body) override {
        if (present) body();
    }
    void one_of(const scene::Choice& choice) override { choice.describe(choice.active); }
    void named(const scene::Key& /*key*/, const scene::Entries& entries) override {
        for (std::size_t i = 0; i < entries.size(); ++i) entries.describe(i);
    }

private:
    const Transformation& by_;
};

/// Components of turn * f for components that are values, or tables and zeros.
inline std::array<scene::Course, 3> turned(const std::array<scene::Course, 3>& f, const Mat3& turn) {
    std::array<scene::Course, 3> result;
    if (std::ranges::all_of(f, &scene::Course::is_value)) {
        const Vec3 all = turn * Vec3(f[0].value(), f[1].value(), f[2].value());
        for (int i = 0; i < 3; ++i) result[static_cast<std::size_t>(i)] = all[i];
        return result;
    }
    std::vector<double> times;
    for (const scene::Course& c : f) {
        if (c.is_value() ? c.value() != 0 : !std::holds_alternative<scene::Table>(c.form))
            throw std::invalid_argument("a vector with an expression, or with a table and a value beside it");
        const auto corners = c.corners();
        times.insert(times.end(), corners.begin(), corners.end());
    }
    std::ranges::sort(times);
    times.erase(std::ranges::unique(times).begin(), times.end());
    for (int i = 0; i < 3; ++i) {
        scene::Table table;
        for (const double t : times) {
            double value = 0;
            for (int k = 0; k < 3; ++k) value += turn(i, k) * f[static_cast<std::size_t>(k)].function()(t);
            table.rows.push_back({t, value});
        }
        result[static_cast<std::size_t>(i)] = table;
    }
    return result;
}

inline void turn_scene(scene::Scene& scene, const Mat3& turn) {
    scene.gravity = turn * scene.gravity;
    for (auto& [name, body] : scene.bodies) {
        body.initial_velocity = turn * body.initial_velocity;
        body.initial_spin = turn.determinant() * (turn * body.initial_spin); // an axial vector
        if (body.slice) body.slice->axis = turn * body.slice->axis;
    }
    for (auto& [name, equation] : scene.equations)
        for (auto& [set, factors] : equation.terms) factors = turn * factors;
    for (auto& [set, support] : scene.supports) support.axes = turn * support.axes;
    for (auto& [stage_name, stage] : scene.stages) {
        for (const auto& [set, components] : stage.displacement)
            if (scene::find(scene.supports, set) == nullptr) {
                scene::Support axes;
                axes.axes = turn;
                scene.supports.emplace_back(set, axes);
            }
        for (auto& [body, force] : stage.body_force) force = turned(force, turn);
        for (auto& [set, force] : stage.nodal_force) force = turned(force, turn);
        for (auto& [body, c] : stage.centrifugal)
            c.axis.point = turn * c.axis.point, c.axis.direction = turn * c.axis.direction;
    }
}

/// Moves what a scene says about places beside its meshes.
inline void move_scene(scene::Scene& scene, const Vec3& by) {
    const auto move = [&](std::optional<Vec3>& point) {
        if (point) *point += by;
    };
    for (auto& [name, coupling] : scene.couplings) move(coupling.reference_point);
    for (auto& [name, body] : scene.bodies) {
        if (body.rigid) move(body.rigid->centre), move(body.rigid->reference_point);
        if (body.slice) body.slice->point += by;
        if (!body.rigid_surface) continue;
        std::visit(
            [&]<class S>(S& surface) {
                if constexpr (std::is_same_v<S, scene::PlaneSurface>) surface.point += by;
                if constexpr (std::is_same_v<S, scene::CylinderSurface>) surface.axis_point += by;
                if constexpr (std::is_same_v<S, scene::SphereSurface>) surface.centre += by;
                if constexpr (std::is_same_v<S, scene::ConeSurface>) surface.apex += by;
                if constexpr (std::is_same_v<S, scene::ExtrudedSurface>)
                    for (Vec3& point : surface.points) point += by;
            },
            *body.rigid_surface);
    }
    for (auto& [name, stage] : scene.stages)
        for (auto& [body, c] : stage.centrifugal) c.axis.point += by;
}

inline void mirror_orientation(mesh::Mesh& m) {
    for (mesh::ElementBlock& block : m.blocks) {
        const mesh::CellInfo& info = mesh::cell_info(block.type);
        const auto n = static_cast<std::size_t>(info.nodes);
        for (std::size_t e = 0; e < block.connectivity.size(); e += n) {
            const std::vector<Index> old(block.connectivity.begin() + static_cast<long>(e),
                                         block.connectivity.begin() + static_cast<long>(e + n));
            for (std::size_t k = 0; k < n; ++k)
                block.connectivity[e + k] = old[static_cast<std::size_t>(info.mirrored[k])];
        }
    }
    for (auto& [name, facets] : m.surfaces)
        for (mesh::Facet& facet : facets) std::reverse(facet.nodes.begin() + 1, facet.nodes.begin() + facet.count);
}

} // namespace detail

/// A scene whose sets are named in its meshes, so that it can be transformed.
struct NamedScene {
    scene::Scene scene;
    std::vector<mesh::Mesh> meshes;
    double diagonal = 0; ///< around all bodies
};

/// @param plan  of the scene and meshes as they are
inline NamedScene with_named_sets(scene::Scene scene, std::vector<mesh::Mesh> meshes, const app::Plan& plan) {
    for (std::size_t s = 0; s < scene.sets.size(); ++s) {
        const model::Set& set = plan.model.sets[s];
        const Index first = plan.model.bodies[set.body].first_node;
        const std::string name = "transformed " + set.name;
        mesh::Mesh& m = meshes[static_cast<std::size_t>(set.body)];
        for (const Index node : set.nodes) m.node_sets[name].push_back(node - first);
        m.surfaces[name] = set.facets; // none: the set has no facets, whatever its nodes cover
        for (mesh::Facet& facet : m.surfaces[name])
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] -= first;
        scene.sets[s].second.select = scene::SelectNamed{name, true};
    }
    Eigen::AlignedBox3d box;
    for (const mesh::Mesh& m : meshes)
        for (const Vec3& X : m.nodes) box.extend(X);
    return {std::move(scene), std::move(meshes), box.diagonal().norm()};
}

/// Where bodies go that are so many sizes away, the same for every scene of this size.
inline Vec3 shift(const NamedScene& from, double sizes) {
    return sizes * from.diagonal * Vec3(0.6, -0.64, 0.48);
}

/// Coordinates as a place far away can hold them: rounded there and brought back, which is exact.
inline NamedScene as_held_at(NamedScene named, double sizes) {
    const Vec3 there = shift(named, sizes);
    for (mesh::Mesh& m : named.meshes)
        for (Vec3& X : m.nodes) X = Vec3(X + there) - there;
    return named;
}

/// @param number  (nodes) what every node of the untransformed model is called afterwards
inline NamedScene transformed(NamedScene named, const Transformation& by, std::vector<Index>& number) {
    auto& [scene, meshes, diagonal] = named;
    const Vec3 there = shift(named, by.sizes_away);
    std::mt19937 random(3);
    std::vector<std::vector<Index>> to;
    for (mesh::Mesh& m : meshes) {
        for (Vec3& X : m.nodes) X = by.length * (by.turn * X + there);
        if (by.turn.determinant() < 0) detail::mirror_orientation(m);
        std::vector<Index> local(m.nodes.size());
        std::iota(local.begin(), local.end(), 0);
        if (by.renumber) local = renumber(m, random);
        to.push_back(local);
    }
    detail::Rescaler rescaler(by);
    describe(rescaler, scene);
    if (by.turn != Mat3::Identity()) detail::turn_scene(scene, by.turn);
    if (by.sizes_away != 0) detail::move_scene(scene, by.length * there);
    std::vector<Index> first(meshes.size(), 0); // of every body, afterwards
    const auto count = [&](std::size_t b) { return meshes[b].node_count(); };
    if (by.reverse_bodies)
        for (std::size_t b = meshes.size() - 1; b-- > 0;) first[b] = first[b + 1] + count(b + 1);
    else
        for (std::size_t b = 1; b < meshes.size(); ++b) first[b] = first[b - 1] + count(b - 1);
    number.clear();
    for (std::size_t b = 0; b < to.size(); ++b)
        for (const Index node : to[b]) number.push_back(first[b] + node);
    if (by.reverse_bodies) {
        std::ranges::reverse(scene.bodies);
        std::ranges::reverse(meshes);
    }
    if (by.swap_sides) {
        for (auto& [name, pair] : scene.contact) {
            if (!pair.master.rigid_surface.empty()) continue; // which is no slave
            std::swap(pair.slave, pair.master.set);
            std::swap(pair.between[0], pair.between[1]);
        }
        scene.solver.smallest_step = std::max(scene.solver.smallest_step, 0.1); // where it fails, soon
    }
    return named;
}

} // namespace osculate::support
