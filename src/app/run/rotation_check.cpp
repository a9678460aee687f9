#include "osculate/app/rotation_check.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <span>
#include <stdexcept>

namespace osculate::app {

namespace {

constexpr double noticed = 0.1;     ///< of the largest strain
constexpr double least_led = 1e-6;  ///< of lines that are led: a rotation by 0.08 degrees
constexpr double least_free = 1e-3; ///< of bodies that grow: a rotation by 2.6 degrees
constexpr std::size_t per_body = 9; ///< numbers in memory()

/// Nodes of an element: reference positions and displacements relative to their centres.
struct Nodes {
    Vec3 X = Vec3::Zero(), u = Vec3::Zero(); ///< centres
    std::array<Vec3, mesh::most_nodes_per_cell> dX, du;
    std::size_t count = 0;

    Nodes(std::span<const Index> nodes, Index first, const Field& all_X, const Field& all_u) : count(nodes.size()) {
        for (std::size_t i = 0; i < count; ++i) {
            const auto node = static_cast<std::size_t>(first + nodes[i]);
            X += dX[i] = all_X[node];
            u += du[i] = all_u[node];
        }
        X /= static_cast<double>(count);
        u /= static_cast<double>(count);
        for (std::size_t i = 0; i < count; ++i) {
            dX[i] -= X;
            du[i] -= u;
        }
    }
};

/// H of the linear displacement field that is nearest to those of the nodes.
Mat3 gradient(const Nodes& nodes) {
    Mat3 uX = Mat3::Zero(), XX = Mat3::Zero();
    for (std::size_t i = 0; i < nodes.count; ++i) {
        uX += nodes.du[i] * nodes.dX[i].transpose();
        XX += nodes.dX[i] * nodes.dX[i].transpose();
    }
    return uX * XX.inverse();
}

/// Largest strain of an element: of the linear field, and what hexahedra and prisms bend by beside it. @param H  of it
double largest_strain(const Nodes& nodes, const Mat3& H) {
    Eigen::SelfAdjointEigenSolver<Mat3> principal;
    principal.computeDirect((H + H.transpose()) / 2, Eigen::EigenvaluesOnly);
    double bent = 0;
    const bool corners_alone = nodes.count <= 8; // what lies between them tells of turns that vary, too
    for (std::size_t i = 0; i < nodes.count && corners_alone; ++i)
        bent = std::max(bent, (nodes.du[i] - H * nodes.dX[i]).squaredNorm() / nodes.dX[i].squaredNorm());
    return principal.eigenvalues().cwiseAbs().maxCoeff() + std::sqrt(bent);
}

/// Angle of the rotation R of F = 1 + H = R U, rad; 0 where the element is inside out.
double turn(const Mat3& H) {
    const Mat3 F = Mat3::Identity() + H;
    if (!(F.determinant() > 0)) return 0;
    // U^2 = 1 + C with C = H + H^T + H^T H
    const auto [squares, axes] = principal_axes(H + H.transpose() + H.transpose() * H);
    const Vec3 U = (squares.array() + 1).max(0.0).sqrt();
    if (!(U.minCoeff() > 0)) return 0;
    const Mat3 R = F * axes * U.cwiseInverse().asDiagonal() * axes.transpose();
    return Eigen::AngleAxisd(R).angle();
}

/// 1 - cos theta
double shortening(double angle) {
    const double half = std::sin(angle / 2);
    return 2 * half * half;
}

/// How much shorter the line between two nodes seems than it is, of its length, if one moves by du against the other.
double shortening(const Vec3& dX, const Vec3& du) {
    // with the stretch U of the line, U^2 = 1 + C, and its strain e: U - 1 - e
    const double length = dX.squaredNorm(), e = dX.dot(du) / length, C = 2 * e + du.squaredNorm() / length;
    return std::max(0.0, C / (1 + std::sqrt(std::max(0.0, 1 + C))) - e);
}

/// Projects a vector onto the directions in which a node is held.
Vec3 held_part(const linear::Constraints& constraints, Index node, const Vec3& v) {
    Vec3 local = constraints.to_local(node, v);
    for (int k = 0; k < 3; ++k)
        if (constraints.equation(node, k) != linear::Constraints::held) local[k] = 0;
    return constraints.to_global(node, local);
}

} // namespace

RotationCheck::RotationCheck(const model::Model& model)
    : model_(model), follows_(static_cast<std::size_t>(model.nodes()), 0), spoilt_(model.bodies.size()) {
    for (const model::RigidBody& body : model.rigid)
        for (const Index node : body.nodes) follows_[static_cast<std::size_t>(node)] = 1;
    for (const model::Body& body : model.bodies)
        any_ = any_ || (!body.rigid &&
                        std::ranges::any_of(body.kernels, [](const auto& kernel) { return !kernel->finite_strain(); }));
}

void RotationCheck::accepted(const model::State& state, const linear::Constraints& constraints) {
    if (!any_) return;
    std::vector<char> led = follows_;
    for (std::size_t i = 0; i < led.size(); ++i)
        if (constraints.free_components(static_cast<Index>(i)) <= 1) led[i] = 1;
    for (std::size_t b = 0; b < model_.bodies.size(); ++b)
        if (!model_.bodies[b].rigid) examine(b, state, constraints, led);
}

/// Of all processes; of equals the first element.
RotationCheck::Turned RotationCheck::worst_of_all(const Turned& own, Ranks& ranks) {
    const double numbers[] = {own.added,     own.angle,     own.time,     static_cast<double>(own.element),
                              own.place.x(), own.place.y(), own.place.z()};
    constexpr std::size_t n = std::size(numbers);
    std::vector<double> all(n * static_cast<std::size_t>(ranks.count()));
    ranks.gather(numbers, std::vector<int>(static_cast<std::size_t>(ranks.count()), static_cast<int>(n)), all.data());
    Turned worst;
    for (const double* one = all.data(); one != all.data() + all.size(); one += n) {
        const auto element = static_cast<Index>(one[3]);
        if (element >= 0 && (one[0] > worst.added || (one[0] == worst.added && element < worst.element)))
            worst = {one[0], 0, one[1], one[2], element, Vec3(one[4], one[5], one[6])};
    }
    return worst;
}

void RotationCheck::examine(std::size_t b, const model::State& state, const linear::Constraints& constraints,
                            const std::vector<char>& led) {
    const model::Body& body = model_.bodies[b];
    double strain = 0;
    Turned forced, grown;
    Index first = 0;
    for (std::size_t k = 0; k < body.mesh.blocks.size(); ++k) {
        const mesh::ElementBlock& block = body.mesh.blocks[k];
        const Index begin = first, n = nodes_per_cell(block.type);
        first += block.size();
        if (body.kernels[k]->finite_strain()) continue;
        for (Index e = 0; e < block.size(); ++e) {
            const std::span own(&block.connectivity[static_cast<std::size_t>(e * n)], static_cast<std::size_t>(n));
            if (model_.share && !model_.share->owns(body.first_node + own.front())) continue;
            const Nodes nodes(own, body.first_node, model_.X, state.u);
            const Mat3 H = gradient(nodes);
            strain = std::max(strain, largest_strain(nodes, H));
            const auto is_led = [&](Index node) { return led[static_cast<std::size_t>(body.first_node + node)] != 0; };
            const bool line = std::ranges::count_if(own, is_led) > 1;
            // 1 - cos theta <= |H|^2
            if (H.squaredNorm() <= (line ? std::min(grown.added, forced.added) : grown.added)) continue;
            const double angle = turn(H), added = shortening(angle);
            const auto note = [&](Turned& worst, double by) {
                if (by > worst.added) worst = {by, 0, angle, state.time, begin + e, nodes.X + nodes.u};
            };
            note(grown, added);
            for (std::size_t j = 0; j < own.size() && added > forced.added; ++j)
                for (std::size_t i = 0; i < j && is_led(own[j]); ++i) {
                    if (!is_led(own[i])) continue;
                    const Vec3 du =
                        held_part(constraints, body.first_node + own[j],
                                  held_part(constraints, body.first_node + own[i], nodes.du[j] - nodes.du[i]));
                    note(forced, std::min(added, shortening(nodes.dX[j] - nodes.dX[i], du)));
                }
        }
    }
    if (model_.share) {
        Ranks& ranks = model_.share->ranks();
        strain = ranks.largest(strain);
        forced = worst_of_all(forced, ranks);
        grown = worst_of_all(grown, ranks);
    }
    largest_ = std::max(largest_, grown.added);
    forced.led = true;
    for (auto [worst, least] : {std::pair{forced, least_led}, std::pair{grown, least_free}}) {
        worst.strain = strain;
        if (!(worst.added > std::max(least, noticed * strain))) continue;
        // what is forced is worse than what grows
        if (worst.led > spoilt_[b].led || (worst.led == spoilt_[b].led && worst.added > spoilt_[b].added))
            spoilt_[b] = worst;
    }
}

std::optional<double> RotationCheck::largest() const {
    return any_ ? std::optional(largest_) : std::nullopt;
}

std::optional<std::string> RotationCheck::warning() const {
    const auto worst = std::ranges::max_element(spoilt_, [](const Turned& a, const Turned& b) {
        return std::pair(a.led, a.added) < std::pair(b.led, b.added);
    });
    if (worst == spoilt_.end() || worst->added == 0) return std::nullopt;
    const auto others = std::ranges::count_if(spoilt_, [](const Turned& turned) { return turned.added > 0; }) - 1;
    const Vec3 place = worst->place + model_.origin;
    const std::string& name = model_.bodies[static_cast<std::size_t>(worst - spoilt_.begin())].name;
    return fmt::format(
        "body '{}' turns, and linear_elastic takes a rotation for a strain: {} by {:.2g} of its length at element {}, "
        "at "
        "({:.4g}, {:.4g}, {:.4g}) m, which has turned by {:.2g} degrees at {:.4g} s; the largest strain of the body is "
        "{:.2g}. {}{}. Set bodies.{}.material to saint_venant_kirchhoff or neo_hookean",
        name, worst->led ? "what is held or driven there is strained" : "the body has grown", worst->added,
        worst->element, place.x(), place.y(), place.z(), worst->angle * 180 / std::numbers::pi, worst->time,
        worst->strain,
        worst->led ? "Its forces and stresses are wrong" : "Its size is wrong, and so is what presses on it",
        others == 0 ? "" : fmt::format("; {} other {} likewise", others, others == 1 ? "body" : "bodies"), name);
}

std::vector<double> RotationCheck::memory() const {
    std::vector<double> numbers{largest_};
    for (const Turned& turned : spoilt_)
        numbers.insert(numbers.end(),
                       {turned.added, turned.strain, turned.angle, turned.time, static_cast<double>(turned.element),
                        turned.place.x(), turned.place.y(), turned.place.z(), turned.led ? 1.0 : 0.0});
    return numbers;
}

void RotationCheck::recall(std::span<const double> memory) {
    if (memory.size() != 1 + per_body * spoilt_.size())
        throw std::runtime_error("the checkpoint holds no rotations of the run's bodies");
    largest_ = memory[0];
    for (std::size_t b = 0; b < spoilt_.size(); ++b) {
        const double* at = &memory[1 + per_body * b];
        spoilt_[b] = {at[0], at[1], at[2], at[3], static_cast<Index>(at[4]), Vec3(at[5], at[6], at[7]), at[8] != 0};
    }
}

} // namespace osculate::app
