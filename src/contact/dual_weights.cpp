#include "osculate/contact/dual_weights.hpp"

#include "contact/facet_rule.hpp"
#include "osculate/contact/near_facets.hpp"
#include "osculate/core/without_traps.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>

namespace osculate::contact {

void DualSum::finish(double area, double least_cover, DualFunctions& dual) const {
    dual.usable = covered_ > least_cover * area;
    dual.D.setZero();
    if (!dual.usable) return;
    dual.D.head(corners_) = M_.rowwise().sum();
    const WithoutTraps singular; // where it is, that is seen below
    dual.A = dual.D.head(corners_).asDiagonal() * M_.inverse().eval();
    // too few points, or points in a row
    dual.usable = dual.A.allFinite() && dual.A.cwiseAbs().maxCoeff() * least_cover * least_cover < 1;
}

double reference_area(const std::vector<Vec3>& X, const Vec2& xi) {
    const Shape N = shape(static_cast<int>(X.size()), xi);
    Vec3 a = Vec3::Zero(), b = Vec3::Zero();
    for (std::size_t c = 0; c < X.size(); ++c) {
        a += N.N_a(static_cast<Index>(c), 0) * X[c];
        b += N.N_a(static_cast<Index>(c), 1) * X[c];
    }
    return a.cross(b).norm();
}

std::vector<Vec3> corner_positions(const SlaveFacet& facet, std::span<const Vec3> slaves) {
    std::vector<Vec3> x;
    for (const Index node : facet) x.push_back(slaves[static_cast<std::size_t>(node)]);
    return x;
}

namespace {
/// Area of the reference facet per area in the plane of the facet as it is.
double reference_per_plane(const Shape& N, const std::vector<Vec3>& X, const std::vector<Vec3>& corner,
                           const SlavePlane& plane) {
    Vec3 a = Vec3::Zero(), b = Vec3::Zero(), A = Vec3::Zero(), B = Vec3::Zero();
    for (std::size_t c = 0; c < corner.size(); ++c) {
        const double N_1 = N.N_a(static_cast<Index>(c), 0), N_2 = N.N_a(static_cast<Index>(c), 1);
        a += N_1 * corner[c];
        b += N_2 * corner[c];
        A += N_1 * X[c];
        B += N_2 * X[c];
    }
    return A.cross(B).norm() / plane.normal().dot(a.cross(b));
}

Vec3 normal_of(std::span<const Vec3> corner) {
    const Vec3 a = corner[1] - corner[0], b = corner[2] - corner[0];
    return (corner.size() == 4 ? b.cross(corner[3] - corner[1]) : a.cross(b)).normalized();
}

} // namespace

DualWeights::DualWeights(const mesh::HalfEdgeSurface& surface, const std::vector<SlaveFacet>& facets,
                         const std::vector<Vec3>& S, double least_cover)
    : surface_(surface), least_cover_(least_cover), turns_round_(false), incident_(S.size()) {
    // a surface with features, or without an end, comes to lie under a facet twice
    turns_round_ = surface.boundary_loop_count() == 0;
    for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()) && !turns_round_; ++h)
        turns_round_ = surface.is_feature_edge(h);
    for (const SlaveFacet& corners : facets) {
        Facet& facet = facets_.emplace_back();
        facet.corners = corners;
        facet.X = corner_positions(corners, S);
        for (int c = 0; c < corners.count; ++c)
            incident_[static_cast<std::size_t>(corners.node[static_cast<std::size_t>(c)])].push_back(
                {static_cast<Index>(facets_.size()) - 1, c});
        constexpr int points = 2; // in each direction
        for (const RulePoint& q : facet_rule(corners.count, points))
            facet.area += q.weight * reference_area(facet.X, q.xi);
    }
}

void DualWeights::begin(const PairPositions& at) {
    if (!turns_round_) return;
    master_normal_.clear();
    for (Index g = 0; g < surface_.facet_count(); ++g) {
        const auto vertices = surface_.facet_vertices(g);
        std::array<Vec3, 4> corner;
        for (std::size_t i = 0; i < vertices.size(); ++i)
            corner[i] = at.vertices[static_cast<std::size_t>(vertices[i])];
        master_normal_.push_back(normal_of({corner.data(), vertices.size()}));
    }
    for (Facet& facet : facets_) facet.normal = normal_of(corner_positions(facet.corners, at.slaves));
}

bool DualWeights::faces(const Facet& facet, Index master) const {
    return master_normal_.empty() || master_normal_[static_cast<std::size_t>(master)].dot(facet.normal) < facing;
}

void DualWeights::update(Index f, const PairPositions& at, std::vector<Index> seeds) {
    Facet& facet = facets_[static_cast<std::size_t>(f)];
    facet.overlaps.clear();
    const std::vector<Vec3>& x = at.vertices;
    const std::vector<Vec3> corner = corner_positions(facet.corners, at.slaves);
    const SlavePlane plane(corner);
    const int n = facet.corners.count;
    sort_unique(seeds);
    std::vector<Index> waiting = std::move(seeds), seen = waiting;
    while (!waiting.empty()) {
        const Index candidate = waiting.back();
        waiting.pop_back();
        if (!faces(facet, candidate)) continue;
        const auto vertices = surface_.facet_vertices(candidate);
        std::array<Vec3, 4> master;
        for (std::size_t i = 0; i < vertices.size(); ++i) master[i] = x[static_cast<std::size_t>(vertices[i])];
        const auto points = plane.overlap({master.data(), vertices.size()});
        if (points.empty()) continue;
        Overlap& overlap = facet.overlaps.emplace_back();
        overlap.facet = candidate;
        overlap.points.reserve(points.size());
        for (const OverlapPoint& q : points) {
            const Shape N = shape(n, q.xi);
            overlap.points.push_back({q.u, q.area * reference_per_plane(N, facet.X, corner, plane), N.N,
                                      shape(static_cast<int>(vertices.size()), q.u).N});
        }
        for (const Index v : surface_.facet_vertices(candidate))
            for (const Index next : surface_.vertex_facets(v)) {
                const auto place = std::lower_bound(seen.begin(), seen.end(), next);
                if (place != seen.end() && *place == next) continue;
                seen.insert(place, next);
                waiting.push_back(next);
            }
    }
    std::sort(facet.overlaps.begin(), facet.overlaps.end(),
              [](const Overlap& a, const Overlap& b) { return a.facet < b.facet; });

    find_border(facet, at, plane, corner);
    DualSum sum(n);
    for (const Overlap& overlap : facet.overlaps)
        for (const Point& q : overlap.points) sum.add(q.N, q.area);
    sum.finish(facet.area, least_cover_, facet.dual);
    if (!facet.dual.usable) return;
    facet.vertices.clear();
    for (const Overlap& overlap : facet.overlaps) {
        const auto v = surface_.facet_vertices(overlap.facet);
        facet.vertices.insert(facet.vertices.end(), v.begin(), v.end());
    }
    sort_unique(facet.vertices);
    facet.shares.setZero(4, static_cast<Index>(facet.vertices.size()));
    for (const Overlap& overlap : facet.overlaps) {
        const auto vertices = surface_.facet_vertices(overlap.facet);
        Eigen::Matrix4d products = Eigen::Matrix4d::Zero(); // int N N_i dA
        for (const Point& q : overlap.points) products += q.area * q.N * q.of_master.transpose();
        for (std::size_t i = 0; i < vertices.size(); ++i)
            facet.shares.col(place_in(facet.vertices, vertices[i])).head(n) +=
                facet.dual.A * products.col(static_cast<Index>(i)).head(n);
    }
}

void DualWeights::find_border(Facet& facet, const PairPositions& at, const SlavePlane& plane,
                              const std::vector<Vec3>& corner) const {
    facet.border.clear();
    for (const Overlap& overlap : facet.overlaps) {
        const auto vertices = surface_.facet_vertices(overlap.facet);
        for (std::size_t c = 0; c < vertices.size(); ++c) {
            const Index h = surface_.first_half_edge(overlap.facet) + static_cast<Index>(c);
            if (!surface_.is_boundary_edge(h) &&
                faces(facet, surface_.half_edges()[surface_.half_edges()[h].twin].facet))
                continue;
            const std::array<Index, 2> ends{vertices[c], vertices[(c + 1) % vertices.size()]};
            for (const EdgePoint& q : plane.edge_over(at.vertices[static_cast<std::size_t>(ends[0])],
                                                      at.vertices[static_cast<std::size_t>(ends[1])])) {
                const Shape N = shape(facet.corners.count, q.xi);
                facet.border.push_back({ends, q.s, q.length * reference_per_plane(N, facet.X, corner, plane), N.N});
            }
        }
    }
}

void DualWeights::vary_border(Facet& facet, const PairPositions& at, const SlavePlane& plane,
                              const std::array<Vec3, 4>& turn) const {
    // the overlap gains a strip as wide as the edge moves outwards over the slave,
    //     v = nu . ((1 - s) dx_a + s dx_b - N_k ds_k - t dd),   nu in the slave plane,
    // so with M = int N N^T, D = M 1, P = int N N_i and the shares S = diag(D) M^-1 P
    //     dD = N v,   dS = (N_c R + psi_c (N_i - R^T N)^T) v,   R = M^-1 P
    const int n = facet.corners.count;
    const auto count = static_cast<Index>(facet.vertices.size());
    facet.dD.setZero(n, 3 * (n + count));
    const Matrix R = facet.dual.D.head(n).cwiseInverse().asDiagonal() * facet.shares.topRows(n);
    for (const BorderPoint& q : facet.border) {
        const Vec3 &a = at.vertices[static_cast<std::size_t>(q.ends[0])],
                   &b = at.vertices[static_cast<std::size_t>(q.ends[1])];
        // a boundary edge has its facet on the left seen from the master's outside, so on the right from the slave's
        const Vec3& d = plane.normal();
        const Vec3 nu = d.cross(b - a).normalized(), x = (1 - q.s) * a + q.s * b;
        Vec3 foot = Vec3::Zero();
        for (Index k = 0; k < n; ++k)
            foot += q.N(k) * at.slaves[static_cast<std::size_t>(facet.corners.node[static_cast<std::size_t>(k)])];
        const double t = d.dot(x - foot);
        Eigen::RowVectorXd v = Eigen::RowVectorXd::Zero(facet.dD.cols());
        for (Index k = 0; k < n; ++k) // nu . (e x ds) = (nu x e) . ds
            v.segment<3>(3 * k) =
                -q.N(k) * nu.transpose() - t / plane.area() * nu.cross(turn[static_cast<std::size_t>(k)]).transpose();
        const Index first = place_in(facet.vertices, q.ends[0]), second = place_in(facet.vertices, q.ends[1]);
        v.segment<3>(3 * (n + first)) += (1 - q.s) * nu.transpose();
        v.segment<3>(3 * (n + second)) += q.s * nu.transpose();
        v *= q.weight;

        Vector beside = -R.transpose() * q.N.head(n);
        beside(first) += 1 - q.s;
        beside(second) += q.s;
        const DualFunctions::Row4 psi = [&] {
            DualFunctions::Row4 all = DualFunctions::Row4::Zero();
            all.head(n) = facet.dual.A * q.N.head(n);
            return all;
        }();
        for (Index c = 0; c < n; ++c) {
            facet.dD.row(c) += q.N(c) * v;
            facet.variation.middleRows(c * count, count) += (q.N(c) * R.row(c).transpose() + psi(c) * beside) * v;
        }
    }
}

double DualWeights::share(Index j) const {
    double sum = 0;
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (facet.dual.usable) sum += facet.dual.D(c);
    }
    return sum;
}

void DualWeights::add_vertices(Index j, std::vector<Index>& vertices) const {
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (facet.dual.usable) vertices.insert(vertices.end(), facet.vertices.begin(), facet.vertices.end());
    }
}

void DualWeights::add_weights(Index j, const std::vector<Index>& carriers, Vector& weights) const {
    const double by = share(j);
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.dual.usable) continue;
        for (std::size_t i = 0; i < facet.vertices.size(); ++i)
            weights(place_in(carriers, facet.vertices[i])) += facet.shares(c, static_cast<Index>(i)) / by;
    }
}

void DualWeights::vary(Index f, const PairPositions& positions) {
    Facet& facet = facets_[static_cast<std::size_t>(f)];
    if (!facet.dual.usable) return;
    // at fixed xi, along the slave plane's normal d:  X(u) = s + t d
    //     du_a = b^a . (ds - N_i dx_i + t dd),   b^a . X,b = delta_ab,  b^a . d = 0,   dd = (I - d d^T) dA / |A|
    // what moves with the borders between overlaps cancels, since N_i runs on across them
    const int n = facet.corners.count;
    const auto count = static_cast<Index>(facet.vertices.size());
    facet.variation.setZero(n * count, 3 * (n + count));
    const std::vector<Vec3>& x = positions.vertices;
    const std::vector<Vec3> corner = corner_positions(facet.corners, positions.slaves);
    const SlavePlane plane(corner);
    const Vec3& d = plane.normal();
    // d(2A) of each corner, as the vector e of  dA = e x dx
    std::array<Vec3, 4> edge{};
    for (int c = 0; c < n; ++c) {
        const auto at = [&](int k) { return corner[static_cast<std::size_t>((c + k) % n)]; };
        edge[static_cast<std::size_t>(c)] = (at(n - 1) - at(1)) / 2;
    }
    for (const Overlap& overlap : facet.overlaps) {
        const auto vertices = surface_.facet_vertices(overlap.facet);
        const auto m = static_cast<Index>(vertices.size());
        std::array<Index, 4> place{};
        for (Index i = 0; i < m; ++i)
            place[static_cast<std::size_t>(i)] = place_in(facet.vertices, vertices[static_cast<std::size_t>(i)]);
        // sums over the points of psi_c row_i, row_i = dN_i/ds, times N_k of slave and master, and times t
        std::array<std::array<Eigen::Matrix<double, 3, 9>, 4>, 4> sums; // c, i
        for (auto& of_corner : sums)
            for (auto& sum : of_corner) sum.setZero();
        for (const Point& q : overlap.points) {
            const Shape master = shape(static_cast<int>(m), q.u);
            Vec3 X = Vec3::Zero(), at = Vec3::Zero();
            Mat3 frame; // X,1  X,2  d
            frame.setZero();
            frame.col(2) = d;
            for (Index i = 0; i < m; ++i) {
                const Vec3& xi = x[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])];
                X += master.N(i) * xi;
                frame.leftCols<2>() += xi * master.N_a.row(i);
            }
            for (int c = 0; c < n; ++c) at += q.N(c) * corner[static_cast<std::size_t>(c)];
            Eigen::Matrix<double, 9, 1> factors;
            factors << q.N, master.N, d.dot(X - at);
            const Eigen::Matrix<double, 2, 3> b = frame.inverse().topRows<2>();
            const Eigen::Matrix<double, 3, 4> by_s = (master.N_a * b).transpose(); // dN_i / ds
            DualFunctions::Row4 psi = DualFunctions::Row4::Zero();
            psi.head(n) = q.area * (facet.dual.A * q.N.head(n));
            for (std::size_t c = 0; c < static_cast<std::size_t>(n); ++c)
                for (std::size_t i = 0; i < static_cast<std::size_t>(m); ++i)
                    sums[c][i].noalias() +=
                        (psi(static_cast<Index>(c)) * by_s.col(static_cast<Index>(i))) * factors.transpose();
        }
        for (Index c = 0; c < n; ++c)
            for (Index i = 0; i < m; ++i) {
                const auto& sum = sums[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
                auto row = facet.variation.row(c * count + place[static_cast<std::size_t>(i)]);
                for (Index k = 0; k < n; ++k) // with row . t (e x dx) / |A|
                    row.segment<3>(3 * k) +=
                        sum.col(k).transpose() +
                        Vec3(sum.col(8)).cross(edge[static_cast<std::size_t>(k)]).transpose() / plane.area();
                for (Index k = 0; k < m; ++k)
                    row.segment<3>(3 * (n + place[static_cast<std::size_t>(k)])) -= sum.col(4 + k).transpose();
            }
    }
    facet.dD.resize(0, 0);
    if (!facet.border.empty()) vary_border(facet, positions, plane, edge);
}

} // namespace osculate::contact
