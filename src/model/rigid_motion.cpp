#include "osculate/model/rigid_motion.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

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

} // namespace osculate::model
