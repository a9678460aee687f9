#include "osculate/model/rigid_motion.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace osculate::model {

namespace {
constexpr double rank_tolerance = 1e-12; // of a Gram matrix: 1e-6 of a lever arm
}

Extent extent(const Body& body, const std::vector<Vec3>& x) {
    Extent result;
    auto& [centre, radius] = result;
    const auto last = body.first_node + body.nodes();
    for (Index node = body.first_node; node < last; ++node) centre += x[node] / static_cast<double>(body.nodes());
    for (Index node = body.first_node; node < last; ++node) radius = std::max(radius, (x[node] - centre).norm());
    return result;
}

void RigidHold::hold(const Vec3& point, const Vec3& direction) {
    Motion row;
    row << direction, ((point - extent_.centre) / extent_.radius).cross(direction);
    gram_ += row * row.transpose();
}

void RigidHold::hold(const CyclicSymmetry& ring) {
    // R t = t and R w = w of what moves all sectors alike: along the axis, and about it
    const Vec3 one = ring.axis.unitOrthogonal(), other = ring.axis.cross(one);
    for (const Vec3& across : {one, other}) {
        hold(ring.point, across);
        hold_turning(across);
    }
}

void RigidHold::hold_turning(const Vec3& axis) {
    Motion row;
    row << Vec3::Zero(), axis;
    gram_ += row * row.transpose();
}

void RigidHold::hold(const RigidBody& body, const linear::NodeConstraint& constraint, const std::vector<Vec3>& x) {
    if (constraint.node == body.reference) hold(x[static_cast<std::size_t>(body.reference)], constraint.direction);
    if (constraint.node == body.rotation()) hold_turning(constraint.direction);
}

int RigidHold::free() const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(gram_, Eigen::EigenvaluesOnly);
    const auto& values = eigen.eigenvalues(); // ascending
    int count = 0;
    for (int k = 0; k < 6; ++k) count += !(values(k) > rank_tolerance * values(5));
    return count;
}

std::vector<std::string> RigidHold::free_motions() const {
    const int all = free();
    std::vector<std::string> words;
    for (int k = 0; k < 6; ++k)
        if (all == 6 || gram_(k, k) <= rank_tolerance * gram_.diagonal().maxCoeff())
            words.push_back(std::string(k < 3 ? "along " : "about ") + "xyz"[k % 3]);
    if (const int others = all - static_cast<int>(words.size()); others > 0)
        words.push_back(words.empty() ? std::to_string(others) + " oblique" : std::to_string(others) + " more");
    return words;
}

std::vector<Index> joined_groups(const Model& model) {
    std::vector<Index> group = tied_groups(model);
    for (const LedNode& one : model.led)
        for (const auto& [node, by] : one.by) {
            const Index from = group[static_cast<std::size_t>(body_index(model, node))],
                        to = group[static_cast<std::size_t>(body_index(model, one.node))];
            std::ranges::replace(group, from, to);
        }
    return group;
}

std::vector<char> held_by_equations(const Model& model, const std::vector<linear::NodeConstraint>& constraints) {
    std::vector<char> held(model.bodies.size(), 0);
    if (model.led.empty()) return held;
    const std::vector<Index> tied = tied_groups(model), group = joined_groups(model);
    Eigen::AlignedBox3d box;
    for (const Vec3& X : model.X) box.extend(X);
    const Vec3 centre = box.center();
    const double size = std::max(0.5 * box.diagonal().norm(), 1e-300);
    const auto n = static_cast<Index>(model.bodies.size());
    Matrix gram = Matrix::Zero(6 * n, 6 * n);
    std::vector<std::pair<Index, Eigen::Matrix<double, 6, 1>>> row; // by bodies, few
    const auto part_of = [&](Index body) -> Eigen::Matrix<double, 6, 1>& {
        const Index at = tied[static_cast<std::size_t>(body)];
        const auto found = std::ranges::find(row, at, [](const auto& part) { return part.first; });
        return found != row.end() ? found->second : row.emplace_back(at, Eigen::Matrix<double, 6, 1>::Zero()).second;
    };
    const auto add_part = [&](Index body, const Vec3& point, const Vec3& direction) {
        Eigen::Matrix<double, 6, 1>& part = part_of(body);
        part.head<3>() += direction;
        part.tail<3>() += ((point - centre) / size).cross(direction);
    };
    const auto finish = [&] {
        for (const auto& [a, x] : row)
            for (const auto& [b, y] : row) gram.block<6, 6>(6 * a, 6 * b) += x * y.transpose();
        row.clear();
    };
    const auto X = [&](Index node) -> const Vec3& { return model.X[static_cast<std::size_t>(node)]; };
    for (const linear::NodeConstraint& c : constraints) {
        const RigidBody* rigid = rigid_body_of(model, c.node);
        if (rigid != nullptr && c.node == rigid->rotation())
            part_of(rigid->body).tail<3>() += c.direction;
        else
            add_part(rigid != nullptr ? rigid->body : body_index(model, c.node), X(c.node), c.direction);
        finish();
    }
    for (const CyclicSymmetry& ring : model.cyclic) { // as RigidHold::hold() of a ring
        const Vec3 one = ring.axis.unitOrthogonal();
        for (const Vec3& across : {one, Vec3(ring.axis.cross(one))}) {
            add_part(ring.body, ring.point, across);
            finish();
            part_of(ring.body).tail<3>() += across;
            finish();
        }
    }
    for (const LedNode& one : model.led) {
        add_part(body_index(model, one.node), X(one.node), one.direction);
        for (const auto& [node, by] : one.by) add_part(body_index(model, node), X(node), -by);
        finish();
    }
    for (Index g = 0; g < n; ++g) {
        std::set<Index> rows; // bodies that are tied to one another move as one
        for (std::size_t b = 0; b < group.size(); ++b)
            if (group[b] == g)
                for (Index k = 0; k < 6; ++k) rows.insert(6 * tied[b] + k);
        if (rows.empty()) continue;
        const std::vector<Index> own(rows.begin(), rows.end());
        const Vector values = symmetric_eigen(gram(own, own)).values; // ascending
        if (values(0) > rank_tolerance * values(values.size() - 1))
            for (Index b = 0; b < n; ++b)
                if (group[static_cast<std::size_t>(b)] == g) held[static_cast<std::size_t>(b)] = 1;
    }
    return held;
}

} // namespace osculate::model
