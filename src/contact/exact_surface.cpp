#include "osculate/contact/exact_surface.hpp"

#include <Eigen/LU>

namespace osculate::contact {

namespace {

using Weights = Eigen::Vector4d;

class ExactSurface final : public MasterSurface {
public:
    ExactSurface(ExactShape shape, const RigidFrame& frame) : shape_(std::move(shape)), frame_(frame) {
        Mat3 sides;
        for (Index i = 0; i < 3; ++i) sides.col(i) = frame_.X[static_cast<std::size_t>(i) + 1] - frame_.X[0];
        by_place_.bottomRows<3>() = sides.inverse();
        by_place_.row(0) = -by_place_.bottomRows<3>().colwise().sum();
    }

    [[nodiscard]] std::span<const Index> patch_vertices(Index) const override { return frame_.vertices; }
    [[nodiscard]] bool tells_apart(Index, Index) const override { return false; }
    [[nodiscard]] bool exact() const override { return true; }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation, const Placement*) const override {
        point.behind = false;
        point.facet = hit.facet;
        point.side = -1;
        // as precise as the gap: see evaluate_precisely()
        using Precise3 = Eigen::Matrix<long double, 3, 3>;
        const auto precise = [](const Vec3& v) { return PrecisePoint(v.cast<long double>()); };
        const Vec3& x0 = x[frame_.vertices[0]];
        Precise3 sides, drawn;
        for (Index i = 0; i < 3; ++i) {
            sides.col(i) = precise(x[frame_.vertices[static_cast<std::size_t>(i) + 1]]) - precise(x0);
            drawn.col(i) = precise(frame_.X[static_cast<std::size_t>(i) + 1]) - precise(frame_.X[0]);
        }
        const PrecisePoint place = drawn * (sides.inverse() * (precise(s) - precise(x0)));
        const ShapePoint at = contact::evaluate_precisely(shape_, PrecisePoint(precise(frame_.X[0]) + place));
        const Mat3 F = sides.cast<double>() * by_place_.bottomRows<3>();
        const Vec3 from_X0 = place.cast<double>(); // S - X_0
        point.found = at.found;
        if (!at.found) return;
        const auto weights_at = [&](const Vec3& from) {
            Weights w = by_place_ * from;
            w(0) += 1;
            return w;
        };
        const Vec3 foot = from_X0 - at.gap * at.normal;
        const Weights w = weights_at(from_X0);
        point.gap = at.gap;
        point.normal = (F * at.normal).normalized();
        point.foot = x0 + F * foot;
        point.nodes.assign(frame_.vertices.begin(), frame_.vertices.end());
        point.weights = weights_at(foot);
        point.pressing = -point.weights * point.normal.transpose();
        if (variation != nullptr) vary(F, at, w, point, *variation);
    }

private:
    /// @param w  barycentric coordinates of S
    void vary(const Mat3& F, const ShapePoint& at, const Weights& w, const ContactPoint& point,
              ContactVariation& v) const {
        // dS = F^T (ds - w_i dx_i), dF = dx_i (dw_i/dX)^T
        // dg = n . F dS,   dn = dF N + F H dS,   dP = (1 - N N^T - g H) dS,   dPhi_i = dw_i/dX dP,   dp_i = -d(Phi_i n)
        constexpr Index columns = 15;
        const Vec3& n = point.normal;
        const Mat3 turn = F * at.curvature * F.transpose();
        const Mat3 slide = Mat3::Identity() - at.normal * at.normal.transpose() - at.gap * at.curvature;
        const Eigen::Matrix<double, 4, 3> weights_by_s = by_place_ * slide * F.transpose();
        v.patches.clear();
        v.dg.resize(columns);
        v.dn.resize(3, columns);
        v.dweights.resize(4, columns);
        v.dg.head<3>() = n.transpose();
        v.dn.leftCols<3>() = turn;
        v.dweights.leftCols<3>() = weights_by_s;
        for (Index i = 0; i < 4; ++i) {
            const Index c = 3 + 3 * i;
            v.dg.segment<3>(c) = -w(i) * n.transpose();
            v.dn.middleCols<3>(c) = by_place_.row(i).dot(at.normal) * Mat3::Identity() - w(i) * turn;
            v.dweights.middleCols<3>(c) = -w(i) * weights_by_s;
        }
        v.dpressing.resize(12, columns);
        for (Index i = 0; i < 4; ++i)
            v.dpressing.middleRows<3>(3 * i) = -n * v.dweights.row(i) - point.weights(i) * v.dn;
    }

    ExactShape shape_;
    RigidFrame frame_;
    Eigen::Matrix<double, 4, 3> by_place_; ///< gradients of the barycentric coordinates, 1/m
};

} // namespace

RigidFrame rigid_frame(const std::vector<Vec3>& X) {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& one : X) mean += one / static_cast<double>(X.size());
    RigidFrame frame;
    const auto take = [&](std::size_t k, const auto& size) {
        double largest = -1;
        for (std::size_t v = 0; v < X.size(); ++v)
            if (const double now = size(X[v]); now > largest) {
                largest = now;
                frame.vertices[k] = static_cast<Index>(v);
                frame.X[k] = X[v];
            }
    };
    take(0, [&](const Vec3& p) { return (p - mean).norm(); });
    take(1, [&](const Vec3& p) { return (p - frame.X[0]).norm(); });
    take(2, [&](const Vec3& p) { return (p - frame.X[0]).cross(frame.X[1] - frame.X[0]).norm(); });
    const Vec3 across = (frame.X[1] - frame.X[0]).cross(frame.X[2] - frame.X[0]);
    take(3, [&](const Vec3& p) { return std::abs(across.dot(p - frame.X[0])); });
    return frame;
}

std::unique_ptr<MasterSurface> make_exact_surface(const ExactShape& shape, const RigidFrame& frame) {
    return std::make_unique<ExactSurface>(shape, frame);
}

} // namespace osculate::contact
