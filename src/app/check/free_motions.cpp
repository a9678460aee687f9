#include "app/check/free_motions.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/model/rigid_motion.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace osculate::app {

namespace {

/// Of a Gram matrix. Supports are exact; the normals of a smooth master are those of the body to some 1e-3 of a radian, so
/// that a lever arm of as much of the size holds nothing.
constexpr double held_tolerance = 1e-12, pressed_tolerance = 1e-6;
constexpr double alike = 1e-3; ///< of unit vectors

std::string triple(const Vec3& v, double scale) {
    std::string text;
    for (int k = 0; k < 3; ++k) {
        const double x = std::abs(v[k]) < 1e-6 * scale ? 0 : v[k];
        text += (k > 0 ? ", " : "") + fmt::format("{:.4g}", x);
    }
    return "(" + text + ")";
}

/// Directions that span the columns of an orthonormal basis: coordinate axes as far as possible.
std::vector<Vec3> nice_directions(const Eigen::Matrix3Xd& basis) {
    std::vector<Vec3> found;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = Vec3::Unit(k);
        if ((axis - basis * (basis.transpose() * axis)).norm() < alike) found.push_back(axis);
    }
    for (Eigen::Index c = 0; c < basis.cols() && static_cast<Eigen::Index>(found.size()) < basis.cols(); ++c) {
        Vec3 left = basis.col(c);
        for (const Vec3& f : found) left -= f * f.dot(left);
        if (left.norm() < alike) continue;
        left.normalize();
        Eigen::Index largest = 0;
        left.cwiseAbs().maxCoeff(&largest);
        found.push_back(left[largest] < 0 ? Vec3(-left) : left);
    }
    return found;
}

std::string along(const Vec3& direction) {
    for (int k = 0; k < 3; ++k)
        if ((direction - Vec3::Unit(k)).norm() < alike) return std::string(1, "xyz"[k]);
    return triple(direction, 1);
}

/// Orthonormal basis of the columns of a matrix, and of the combinations that give nothing.
struct Split {
    Eigen::Matrix3Xd range;
    Eigen::MatrixXd kernel;
};

Split split(const Eigen::MatrixXd& m) {
    Split result;
    result.range.resize(3, 0);
    result.kernel.resize(m.cols(), 0);
    if (m.cols() == 0) return result;
    const SymmetricEigen eigen = symmetric_eigen(m.transpose() * m);
    for (Eigen::Index k = 0; k < m.cols(); ++k) {
        const double value = eigen.values(k);
        const Eigen::VectorXd combination = eigen.vectors.col(k);
        if (value > pressed_tolerance && result.range.cols() < 3) {
            result.range.conservativeResize(3, result.range.cols() + 1);
            result.range.rightCols(1) = m * combination / std::sqrt(value);
        } else {
            result.kernel.conservativeResize(m.cols(), result.kernel.cols() + 1);
            result.kernel.rightCols(1) = combination;
        }
    }
    return result;
}

/// Points and directions that hold a body.
struct Holds {
    std::vector<std::pair<Vec3, Vec3>> supports, contact;
    std::vector<Vec3> turning; ///< axes about which it cannot turn
    bool rubs = false, apart = false;
};

class Finder {
public:
    Finder(const Plan& plan, const model::ContactEvaluations& contact)
        : plan_(plan), contact_(contact), holds_(plan.model.bodies.size()), group_(holds_.size()) {
        std::iota(group_.begin(), group_.end(), std::size_t{0});
    }

    std::vector<FreeMotion> find(const time::Stage& stage) {
        for (const linear::NodeConstraint& c : stage.constraints)
            if (const model::RigidBody* rigid = model::rigid_body_of(plan_.model, c.node);
                rigid != nullptr && c.node == rigid->rotation())
                holds_[static_cast<std::size_t>(rigid->body)].turning.push_back(c.direction);
            else
                holds_[rigid != nullptr ? static_cast<std::size_t>(rigid->body) : body_of(c.node)]
                    .supports.emplace_back(plan_.model.X[static_cast<std::size_t>(c.node)], c.direction);
        for (const model::CyclicSymmetry& ring : plan_.model.cyclic) { // as RigidHold::hold() of a ring
            const Vec3 one = ring.axis.unitOrthogonal();
            for (const Vec3& across : {one, Vec3(ring.axis.cross(one))}) {
                holds_[static_cast<std::size_t>(ring.body)].supports.emplace_back(ring.point, across);
                holds_[static_cast<std::size_t>(ring.body)].turning.push_back(across);
            }
        }
        for (const model::ContactEvaluation& evaluation : contact_) add(evaluation);
        share_among_tied();
        const std::vector<char> joined = model::held_by_equations(plan_.model, stage.constraints);
        std::vector<FreeMotion> found;
        std::vector<std::vector<std::string>> own;
        for (std::size_t b = 0; b < holds_.size(); ++b) {
            own.push_back(joined[b] != 0 ? std::vector<std::string>() : motions({b}, true));
            for (const std::string& motion : own.back())
                found.push_back({plan_.model.bodies[b].name, motion, holds_[b].rubs, holds_[b].apart});
        }
        for (std::size_t g = 0; g < holds_.size(); ++g) add_group(g, own, joined, found);
        return found;
    }

private:
    [[nodiscard]] std::size_t body_of(Index node) const {
        return static_cast<std::size_t>(model::body_index(plan_.model, node));
    }

    /// What holds a body holds all that are tied to it.
    void share_among_tied() {
        const std::vector<Index> tied = model::tied_groups(plan_.model);
        const std::vector<Holds> own = holds_;
        for (std::size_t a = 0; a < own.size(); ++a)
            for (std::size_t b = 0; b < own.size(); ++b) {
                if (a == b || tied[a] != tied[b]) continue;
                Holds& all = holds_[a];
                all.supports.insert(all.supports.end(), own[b].supports.begin(), own[b].supports.end());
                all.contact.insert(all.contact.end(), own[b].contact.begin(), own[b].contact.end());
                all.turning.insert(all.turning.end(), own[b].turning.begin(), own[b].turning.end());
                all.rubs = all.rubs || own[b].rubs;
                all.apart = all.apart || own[b].apart;
            }
    }

    void add(const model::ContactEvaluation& evaluation) {
        const model::ContactPair& pair = evaluation.pair();
        const std::size_t slave = body_of(pair.slaves().node.front()), master = body_of(pair.master_nodes().front());
        bool touches = false;
        for (Index j = 0; j < pair.size(); ++j) {
            const contact::ContactPoint& point = evaluation.point(j);
            const double own = std::sqrt(pair.slaves().area[static_cast<std::size_t>(j)]);
            if (!point.found || point.gap > std::min(own, pair.surface().facet_size(point.facet))) continue;
            touches = true;
            const Vec3& s = plan_.model.X[static_cast<std::size_t>(pair.slaves().node[static_cast<std::size_t>(j)])];
            holds_[slave].contact.emplace_back(s, point.normal);
            holds_[master].contact.emplace_back(point.foot, point.normal);
        }
        if (!touches) {
            holds_[slave].apart = holds_[master].apart = true;
            return;
        }
        for (const std::size_t b : {slave, master}) holds_[b].rubs = holds_[b].rubs || pair.options().friction > 0;
        const std::size_t from = group_[slave], to = group_[master];
        std::ranges::replace(group_, from, to);
    }

    /// Of bodies that move as one.
    [[nodiscard]] std::vector<std::string> motions(const std::vector<std::size_t>& bodies, bool with_contact) const {
        Eigen::AlignedBox3d box;
        for (const std::size_t b : bodies) {
            const model::Body& body = plan_.model.bodies[b];
            for (Index node = body.first_node; node < body.first_node + body.nodes(); ++node)
                box.extend(plan_.model.X[static_cast<std::size_t>(node)]);
        }
        RigidFreedom freedom(box.center(), 0.5 * box.diagonal().norm());
        for (const std::size_t b : bodies) {
            for (const auto& [point, direction] : holds_[b].supports) freedom.hold(point, direction);
            for (const Vec3& axis : holds_[b].turning) freedom.hold_turning(axis);
            if (with_contact)
                for (const auto& [point, direction] : holds_[b].contact) freedom.press(point, direction);
        }
        return freedom.in_words(plan_.model.origin);
    }

    void add_group(std::size_t g, const std::vector<std::vector<std::string>>& own, const std::vector<char>& joined,
                   std::vector<FreeMotion>& found) {
        std::vector<std::size_t> bodies;
        std::string names;
        for (std::size_t b = 0; b < group_.size(); ++b)
            if (group_[b] == g) {
                bodies.push_back(b);
                names += (names.empty() ? "" : ", ") + plan_.model.bodies[b].name;
            }
        if (bodies.size() < 2 || std::ranges::any_of(bodies, [&](std::size_t b) { return joined[b] != 0; })) return;
        for (const std::string& motion : motions(bodies, false)) {
            // what each of them can do by itself has been said
            if (std::ranges::all_of(bodies, [&](std::size_t b) { return std::ranges::count(own[b], motion) > 0; }))
                continue;
            found.push_back({names, motion + ", as one"});
        }
    }

    const Plan& plan_;
    const model::ContactEvaluations& contact_;
    std::vector<Holds> holds_;
    std::vector<std::size_t> group_; ///< (bodies) those that touch one another have the same number
};

} // namespace

namespace {

/// Columns: orthonormal combinations of the columns of `basis` that a Gram matrix does not see.
Eigen::MatrixXd unseen(const Eigen::Matrix<double, 6, 6>& gram, const Eigen::MatrixXd& basis, double tolerance) {
    const double most = gram.trace();
    if (basis.cols() == 0 || !(most > 0)) return basis;
    const SymmetricEigen eigen = symmetric_eigen(basis.transpose() * gram * basis);
    Eigen::Index free = 0;
    while (free < basis.cols() && eigen.values(free) <= tolerance * most) ++free;
    return basis * eigen.vectors.leftCols(free);
}

void add_row(const Vec3& arm, const Vec3& direction, Eigen::Matrix<double, 6, 6>& gram) {
    Eigen::Matrix<double, 6, 1> row;
    row << direction, arm.cross(direction);
    gram += row * row.transpose();
}

} // namespace

void RigidFreedom::hold(const Vec3& point, const Vec3& direction) {
    add_row((point - centre_) / size_, direction, held_);
}

void RigidFreedom::hold_turning(const Vec3& axis) {
    Eigen::Matrix<double, 6, 1> row;
    row << Vec3::Zero(), axis;
    held_ += row * row.transpose();
}

void RigidFreedom::press(const Vec3& point, const Vec3& normal) {
    add_row((point - centre_) / size_, normal, pressed_);
}

std::vector<std::string> RigidFreedom::in_words(const Vec3& origin) const {
    const Eigen::MatrixXd left = unseen(held_, Eigen::MatrixXd::Identity(6, 6), held_tolerance);
    const Eigen::MatrixXd motions = unseen(pressed_, left, pressed_tolerance);
    const Eigen::MatrixXd T = motions.topRows(3), W = motions.bottomRows(3);
    const Split turning = split(W);
    const Eigen::Matrix3Xd sliding = split(T * turning.kernel).range;

    std::vector<std::string> words;
    for (const Vec3& direction : nice_directions(sliding)) words.push_back("slides along " + along(direction));
    for (const Vec3& axis : nice_directions(turning.range)) {
        const Vector combination = least_squares(W, axis);
        Vec3 t = T * combination * size_; // of the centre, at one radian
        t -= sliding * (sliding.transpose() * t);
        const double pitch = axis.dot(t);
        const Vec3 through = centre_ + axis.cross(t) + origin;
        const bool screws = std::abs(pitch) > alike * size_;
        words.push_back((screws ? "screws along the axis along " : "turns about the axis along ") + along(axis) +
                        " through " + triple(through, through.norm() + size_) + " m");
    }
    return words;
}

std::vector<FreeMotion> free_motions(const Plan& plan, const model::ContactEvaluations& contact) {
    constexpr std::size_t most = 1000; // bodies: beyond, nobody reads the list
    const auto first = std::ranges::find_if(plan.stages, [](const time::Stage& s) { return !s.dynamics; });
    if (first == plan.stages.end() || plan.model.bodies.size() > most) return {};
    return Finder(plan, contact).find(*first);
}

} // namespace osculate::app
