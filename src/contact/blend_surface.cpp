#include "contact/reach.hpp"
#include "contact/vertex_patch.hpp"
#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/projection.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

using Rows2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using Row = Eigen::Matrix<double, 1, Eigen::Dynamic>;

/// A vertex patch seen from the slave point, within its bump. y = (s, nodes of the patch), 3 + 3n columns.
struct ActivePatch {
    const VertexPatch* patch = nullptr;
    MatrixX3 coefficients;
    Foot foot;
    Vec3 normal;
    double gap = 0, tau = 0, psi = 0;
    Vector phi;
    MatrixX2 phi_a;
    Rows2 du;
    Row dg, dpsi;
    std::vector<Index> place; ///< of the patch's nodes in the union of all patches
};

class BlendSurface final : public MasterSurface {
public:
    BlendSurface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const BlendOptions& options)
        : surface_(surface), vertex_patches_(surface, X, options), facets_(make_facets_surface(surface)) {
        find_creases();
        for (Index f = 0; f < surface.facet_count(); ++f) {
            std::vector<Index> nodes;
            const auto add = [&](Index facet) {
                for (const Index p : vertex_patches_.of_facet[facet]) {
                    const auto& own = vertex_patches_.patches[p].vertices;
                    nodes.insert(nodes.end(), own.begin(), own.end());
                }
                const auto own = surface.facet_vertices(facet);
                if (vertex_patches_.bare[facet] != 0) nodes.insert(nodes.end(), own.begin(), own.end());
            };
            add(f);
            for (const Neighbour& other : creases_[f]) add(other.facet);
            std::sort(nodes.begin(), nodes.end());
            nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
            reach_.push_back(std::move(nodes));
        }
    }

    std::span<const Index> patch_vertices(Index facet) const override { return reach_[facet]; }
    Index fallbacks() const override { return vertex_patches_.fallbacks; }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation) const override {
        point.found = point.behind = false;
        point.facet = hit.facet;
        if (hit.facet < 0) return;
        const double size = surface_.facet_size(hit.facet);
        if (beyond_boundary(hit, size)) return;
        Side side = look(s, hit, x);
        for (const Index facet : across_crease(hit)) {
            FacetHit there;
            there.facet = facet;
            Side other = look(s, there, x);
            // beyond a crease both sides are planes, more or less, through it: the one s is farther from faces s. For
            // a convex edge that is the larger gap, for a concave one the smaller; a tie keeps the closest facet
            if (other.point.found &&
                (!side.point.found || std::abs(other.point.gap) > (1 + tie) * std::abs(side.point.gap)))
                side = std::move(other);
        }
        point = std::move(side.point);
        point.facet = hit.facet;
        if (!point.found || variation == nullptr) return;
        if (side.active.empty()) {
            ContactPoint same;
            facets_->evaluate(s, side.hit, x, same, variation);
        } else {
            vary_blend(side.active, s, point, *variation);
        }
    }

private:
    static constexpr double tie = 1e-9;

    /// A slave point seen from one smooth side of the surface.
    struct Side {
        FacetHit hit;
        std::vector<ActivePatch> active; ///< empty where only the facet itself is left
        ContactPoint point;
    };
    /// Another smooth side that meets a facet in one of its edges or corners.
    struct Neighbour {
        int corner; ///< the edge is the one that leaves it
        bool edge;
        Index facet;
    };

    Side look(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x) const {
        Side side{hit, {}, {}};
        for (const Index p : vertex_patches_.of_facet[hit.facet]) see(vertex_patches_.patches[p], s, x, side.active);
        if (!side.active.empty()) {
            blend(side.active, x, side.point);
            side.point.behind = side.point.gap <= -deepest * surface_.facet_size(hit.facet);
            side.point.found = !side.point.behind;
        } else if (vertex_patches_.bare[hit.facet] != 0) {
            facets_->evaluate(s, hit, x, side.point, nullptr);
        } // else s is too far off for any foot
        return side;
    }

    /// Facets of the other sides when s lies beyond a crease, so that its closest point is on one.
    [[nodiscard]] std::vector<Index> across_crease(const FacetHit& hit) const {
        std::vector<Index> result;
        if (hit.overhang == 0 || creases_[hit.facet].empty()) return result;
        const int n = static_cast<int>(surface_.facet_vertices(hit.facet).size());
        const auto on_edge = [&](int c) {
            const Vec2& u = hit.u;
            const double square[] = {1 + u.y(), 1 - u.x(), 1 - u.y(), 1 + u.x()};
            const double triangle[] = {u.y(), 1 - u.sum(), u.x()};
            return (n == 4 ? square : triangle)[c] < tie;
        };
        for (const Neighbour& k : creases_[hit.facet]) {
            const bool this_edge = on_edge(k.corner), last_edge = on_edge((k.corner + n - 1) % n);
            if (k.edge ? this_edge : this_edge && last_edge) result.push_back(k.facet);
        }
        return result;
    }

    void find_creases() {
        creases_.resize(static_cast<std::size_t>(surface_.facet_count()));
        for (Index f = 0; f < surface_.facet_count(); ++f) {
            const auto v = surface_.facet_vertices(f);
            for (std::size_t c = 0; c < v.size(); ++c) {
                const int corner = static_cast<int>(c);
                const Index h = surface_.first_half_edge(f) + corner;
                if (surface_.is_feature_edge(h))
                    creases_[f].push_back({corner, true, surface_.half_edges()[surface_.half_edges()[h].twin].facet});
                for (const auto& sector : sectors(surface_, v[c]))
                    if (!std::binary_search(sector.begin(), sector.end(), f))
                        creases_[f].push_back({corner, false, sector.front()});
            }
        }
    }

    /// Adds the patch to `active` when s has a foot on it within its bump.
    static void see(const VertexPatch& patch, const Vec3& s, const std::vector<Vec3>& x,
                    std::vector<ActivePatch>& active) {
        const Vec3 origin = x[patch.vertices[0]], from_origin = s - origin; // keeps round-off local
        const auto n = static_cast<Index>(patch.vertices.size());
        MatrixX3 nodes(n, 3);
        for (Index i = 0; i < n; ++i) nodes.row(i) = (x[patch.vertices[i]] - origin).transpose();
        // foot on the tangent plane at the vertex
        const Matrix32 tangents = nodes.transpose() * patch.slope;
        const Vec3 off = from_origin - nodes.transpose() * patch.at_vertex;
        const Mat2 metric = tangents.transpose() * tangents;
        const Vec2 away = metric.inverse() * (tangents.transpose() * off);
        constexpr double surely_outside = 4; // tau on the tangent plane: twice as far as the bump reaches
        if (!(patch.kappa * away.dot(patch.metric * away) < surely_outside)) return;

        ActivePatch a;
        a.patch = &patch;
        a.coefficients = patch.shape.coefficients(nodes);
        const auto foot = project(patch.shape, a.coefficients, from_origin, patch.origin + away);
        if (!foot) return;
        a.foot = *foot;
        const Vec2 u = a.foot.u - patch.origin;
        a.tau = patch.kappa * u.dot(patch.metric * u);
        if (!(a.tau < 1)) return;
        ContactPoint unique;
        if (!locate(patch.shape, a.foot, from_origin, unique)) return;
        a.foot.point.X += origin;
        a.normal = unique.normal;
        a.gap = unique.gap;
        a.psi = (1 - a.tau) * (1 - a.tau) * (1 - a.tau);
        first_variation(a, nodes, from_origin);
        active.push_back(std::move(a));
    }

    /// du_a = K^-1_ab ( X,b.(ds - Phi_i dx_i) + g n.Phi_i,b dx_i ),  dg = n.(ds - Phi_i dx_i),
    /// dpsi = -6 kappa (1-tau)^2 u^T M du
    static void first_variation(ActivePatch& a, const MatrixX3& nodes, const Vec3& from_origin) {
        const PatchPoint& p = a.foot.point;
        const auto n = static_cast<Index>(a.patch->vertices.size());
        a.phi.resize(n);
        a.phi_a.resize(n, 2);
        a.patch->shape.weights(a.foot.u, a.phi, a.phi_a);
        // partition of unity and foot to the last digit, not only to the round-off of the patch: then forces and
        // moments balance as well
        a.phi /= a.phi.sum();
        a.phi_a -= (a.phi * a.phi_a.colwise().sum()).eval();
        a.phi += a.phi_a * ((p.X_a.transpose() * p.X_a - a.gap * p.curvature(a.normal)).inverse() *
                            (p.X_a.transpose() * (from_origin - nodes.transpose() * a.phi)));
        const Mat2 K_inverse = (p.X_a.transpose() * p.X_a - a.gap * p.curvature(a.normal)).inverse();
        const Eigen::Matrix<double, 2, 3> tangents = p.X_a.transpose();
        a.du.resize(2, 3 + 3 * n);
        a.dg.resize(3 + 3 * n);
        a.du.leftCols<3>() = K_inverse * tangents;
        a.dg.leftCols<3>() = a.normal.transpose();
        for (Index i = 0; i < n; ++i) {
            a.du.middleCols<3>(3 + 3 * i) =
                K_inverse * (-a.phi(i) * tangents + a.gap * a.phi_a.row(i).transpose() * a.normal.transpose());
            a.dg.middleCols<3>(3 + 3 * i) = -a.phi(i) * a.normal.transpose();
        }
        const Vec2 m = a.patch->metric * (a.foot.u - a.patch->origin);
        a.dpsi = -6 * a.patch->kappa * (1 - a.tau) * (1 - a.tau) * m.transpose() * a.du;
    }

    /// g = sum psi_v g_v / P;  dg = (1/P) sum [ psi_v dg_v + (g_v - g) dpsi_v ];  weights (1/P) sum psi_v Phi_i
    static void blend(std::vector<ActivePatch>& active, const std::vector<Vec3>& x, ContactPoint& point) {
        double P = 0, g = 0;
        point.nodes.clear();
        for (const ActivePatch& a : active) {
            P += a.psi;
            g += a.psi * a.gap;
            point.nodes.insert(point.nodes.end(), a.patch->vertices.begin(), a.patch->vertices.end());
        }
        g /= P;
        std::sort(point.nodes.begin(), point.nodes.end());
        point.nodes.erase(std::unique(point.nodes.begin(), point.nodes.end()), point.nodes.end());
        const auto n = static_cast<Index>(point.nodes.size());
        Row dg = Row::Zero(3 + 3 * n);
        point.weights = Vector::Zero(n);
        for (ActivePatch& a : active) {
            const Row own = (a.psi * a.dg + (a.gap - g) * a.dpsi) / P;
            dg.leftCols<3>() += own.leftCols<3>();
            for (std::size_t i = 0; i < a.patch->vertices.size(); ++i) {
                const auto at =
                    static_cast<Index>(std::lower_bound(point.nodes.begin(), point.nodes.end(), a.patch->vertices[i]) -
                                       point.nodes.begin());
                a.place.push_back(at);
                dg.middleCols<3>(3 + 3 * at) += own.middleCols<3>(3 + 3 * static_cast<Index>(i));
                point.weights(at) += a.psi * a.phi(static_cast<Index>(i)) / P;
            }
        }
        point.gap = g;
        const double slope = dg.leftCols<3>().norm();
        point.normal = dg.leftCols<3>().transpose() / slope;
        point.pressing = dg.tail(3 * n).reshaped(3, n).transpose() / slope;
        point.foot.setZero();
        for (Index i = 0; i < n; ++i) point.foot += point.weights(i) * (x[point.nodes[i]] - x[point.nodes[0]]);
        point.foot += x[point.nodes[0]];
    }

    /// Second variations of psi_v g_v / P in the patch's own y, but for the terms that couple it with the blended gap:
    ///   psi dDg_v + dpsi Dg_v + Dpsi dg_v + (g_v - g) dDpsi
    /// with n.dX,a of the moving nodes alone (N), B = N + b du, and dDu from differentiating (s - X).X,a = 0 twice.
    static Matrix second_variation(const ActivePatch& a, const Vec3& s, double g) {
        const PatchPoint& p = a.foot.point;
        const VertexPatch& patch = *a.patch;
        const auto n = static_cast<Index>(patch.vertices.size());
        const Index m = 3 + 3 * n;
        const Rows2& U = a.du;
        const Mat2 b = p.curvature(a.normal), metric = p.X_a.transpose() * p.X_a;
        const Vec2 Mu = patch.metric * (a.foot.u - patch.origin);
        const Vec2 q = (metric - a.gap * b).inverse() * Mu; // (M u) . dDu = q . dDF
        const Vec3 e = s - p.X;
        const MatrixX3 phi_ab = patch.shape.second_derivatives(a.foot.u);
        const PatchThird third = patch.shape.third(a.foot.u, a.coefficients);
        const Vec3 X_q = p.X_a * q;
        Matrix32 X_qc; // q_a X,ac
        X_qc.col(0) = q.x() * p.X_11 + q.y() * p.X_12;
        X_qc.col(1) = q.x() * p.X_12 + q.y() * p.X_22;
        Mat2 third_q; // e . q_a X,acd
        third_q(0, 0) = e.dot(q.x() * third.X_111 + q.y() * third.X_112);
        third_q(0, 1) = third_q(1, 0) = e.dot(q.x() * third.X_112 + q.y() * third.X_122);
        third_q(1, 1) = e.dot(q.x() * third.X_122 + q.y() * third.X_222);

        Rows2 N = Rows2::Zero(2, m), R = Rows2::Zero(2, m); // n.Phi_i,a dx_i;  e.(q_a Phi_i,ac) dx_i - X_q.Phi_i,c dx_i
        Rows3 A = X_qc * U, E = -p.X_a * U;                 // q_a dX,a and d(s - X), totals
        E.leftCols<3>() += Mat3::Identity();
        for (Index i = 0; i < n; ++i) {
            const Vec2 phi_i = a.phi_a.row(i).transpose();
            const Vec2 phi_q(q.x() * phi_ab(i, 0) + q.y() * phi_ab(i, 1), q.x() * phi_ab(i, 1) + q.y() * phi_ab(i, 2));
            N.middleCols<3>(3 + 3 * i) = phi_i * a.normal.transpose();
            R.middleCols<3>(3 + 3 * i) = phi_q * e.transpose() - phi_i * X_q.transpose();
            A.middleCols<3>(3 + 3 * i) += q.dot(phi_i) * Mat3::Identity();
            E.middleCols<3>(3 + 3 * i) -= a.phi(i) * Mat3::Identity();
        }
        const double rest = 1 - a.tau, by_tau = -3 * rest * rest; // dpsi/dtau
        const double by_u = (a.gap - g) * by_tau * 2 * patch.kappa;
        const Rows2 B = N + b * U;
        // U^T Z + Z^T U collects all terms with du
        const Rows2 Z = a.psi * (-N - 0.5 * b * U) + by_u * (R + 0.5 * (third_q - p.curvature(X_q) + patch.metric) * U);
        Matrix H = U.transpose() * Z;
        H += by_u * (A.transpose() * E);
        H += a.dpsi.transpose() * a.dg;
        H = (H + H.transpose()).eval();
        H += (a.psi * a.gap) * (B.transpose() * (metric.inverse() * B));
        if (rest > 0) H += ((a.gap - g) * 6 * rest / (by_tau * by_tau)) * (a.dpsi.transpose() * a.dpsi);
        return H;
    }

    static void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                           ContactVariation& variation) {
        const auto n = static_cast<Index>(point.nodes.size());
        const Index m = 3 + 3 * n;
        const double g = point.gap;
        double P = 0;
        for (const ActivePatch& a : active) P += a.psi;
        Row dg = Row::Zero(m), dpsi = Row::Zero(m);
        Matrix H = Matrix::Zero(m, m);
        variation.dweights = Matrix::Zero(n, m);
        for (const ActivePatch& a : active) {
            const auto own = static_cast<Index>(a.place.size());
            const Matrix Hv = second_variation(a, s, g);
            const auto at = [&](Index k) {
                return k == 0 ? Index{0} : 3 + 3 * a.place[static_cast<std::size_t>(k - 1)];
            };
            for (Index i = 0; i <= own; ++i) {
                dg.middleCols<3>(at(i)) +=
                    a.psi * a.dg.middleCols<3>(3 * i) + (a.gap - g) * a.dpsi.middleCols<3>(3 * i);
                dpsi.middleCols<3>(at(i)) += a.dpsi.middleCols<3>(3 * i);
                for (Index k = 0; k <= own; ++k) H.block<3, 3>(at(i), at(k)) += Hv.block<3, 3>(3 * i, 3 * k);
            }
            // d(psi Phi_i) = psi Phi_i,a du_a + dpsi Phi_i
            for (Index i = 0; i < own; ++i) {
                const Row row = a.psi * (a.phi_a.row(i) * a.du) + a.phi(i) * a.dpsi;
                for (Index k = 0; k <= own; ++k)
                    variation.dweights.block<1, 3>(a.place[static_cast<std::size_t>(i)], at(k)) +=
                        row.middleCols<3>(3 * k);
            }
        }
        dg /= P;
        H -= dpsi.transpose() * dg + dg.transpose() * dpsi;
        H /= P;
        variation.dweights = (variation.dweights - point.weights * dpsi) / P;
        variation.dg = dg;
        const double slope = dg.leftCols<3>().norm();
        const Vec3& normal = point.normal;
        const Row dslope = normal.transpose() * H.topRows<3>();
        variation.dn = (H.topRows<3>() - normal * dslope) / slope;
        variation.dpressing = (H.bottomRows(3 * n) - point.pressing.transpose().reshaped() * dslope) / slope;
    }

    const mesh::HalfEdgeSurface& surface_;
    VertexPatches vertex_patches_;
    std::unique_ptr<MasterSurface> facets_;
    std::vector<std::vector<Neighbour>> creases_; ///< per facet
    std::vector<std::vector<Index>> reach_;       ///< per facet, vertices of all patches it may need
};

} // namespace

std::unique_ptr<MasterSurface> make_blend_surface(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                                  const BlendOptions& options) {
    return std::make_unique<BlendSurface>(surface, X, options);
}

} // namespace osculate::contact
