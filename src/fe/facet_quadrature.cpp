#include "osculate/fe/facet_quadrature.hpp"

#include "fe/piece_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace osculate::fe {
namespace {

/// A quadrature point: shape functions and their derivatives, times no weight, tangents of the face.
struct Point {
    double weight = 1;
    std::array<double, mesh::most_nodes_per_face> N{}, dxi{}, deta{};
    Vec3 x_xi = Vec3::Zero(), x_eta = Vec3::Zero();
};

/// A point of a triangle by its natural coordinates and its share of the area.
struct TrianglePoint {
    double xi, eta, share;
};

/// Degree four [Strang and Fix 1973; Dunavant 1985]: N_i x_xi x x_eta of a six-node face is one of degree four.
const std::array<TrianglePoint, 6>& triangle_rule() {
    static const std::array<TrianglePoint, 6> rule = [] {
        const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), ten = std::sqrt(10.0);
        const double a = (8 - ten + root) / 18, b = (8 - ten - root) / 18;
        const double uneven = std::sqrt(213125 - 53320 * ten) / 3720, w = 620.0 / 3720;
        return std::array<TrianglePoint, 6>{{{a, a, w + uneven},
                                             {1 - 2 * a, a, w + uneven},
                                             {a, 1 - 2 * a, w + uneven},
                                             {b, b, w - uneven},
                                             {1 - 2 * b, b, w - uneven},
                                             {b, 1 - 2 * b, w - uneven}}};
    }();
    return rule;
}

/// The quadratic shape functions of a triangle at (xi, eta), nodes as those of mesh::SurfaceFace.
Point six_node_point(double xi, double eta, double weight) {
    const double zeta = 1 - xi - eta;
    Point p;
    p.weight = weight;
    p.N = {zeta * (2 * zeta - 1), xi * (2 * xi - 1), eta * (2 * eta - 1), 4 * zeta * xi, 4 * xi * eta, 4 * eta * zeta};
    p.dxi = {1 - 4 * zeta, 4 * xi - 1, 0, 4 * (zeta - xi), 4 * eta, -4 * eta};
    p.deta = {1 - 4 * zeta, 0, 4 * eta - 1, -4 * xi, 4 * xi, 4 * (zeta - eta)};
    return p;
}

/// Calls use(point) for the points of a part of a six-node face: of the triangle with a corner at (xi, eta) whose edges are
/// `size` times those of the whole, turned by half a turn where `size` < 0.
template <class Use> void integrate_part(double xi, double eta, double size, Use use) {
    for (const TrianglePoint& p : triangle_rule())
        use(six_node_point(xi + size * p.xi, eta + size * p.eta, 0.5 * size * size * p.share));
}

/// Natural coordinates of the nodes of an eight-node face.
constexpr std::array<std::array<double, 2>, 8> eight_nodes{
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

/// The serendipity functions of a quadrilateral at (xi, eta), nodes as those of mesh::SurfaceFace.
Point eight_node_point(double xi, double eta, double weight) {
    Point p;
    p.weight = weight;
    for (std::size_t i = 0; i < 8; ++i) {
        const auto [a, b] = eight_nodes[i];
        if (a == 0) {
            p.N[i] = (1 - xi * xi) * (1 + b * eta) / 2;
            p.dxi[i] = -xi * (1 + b * eta);
            p.deta[i] = b * (1 - xi * xi) / 2;
        } else if (b == 0) {
            p.N[i] = (1 + a * xi) * (1 - eta * eta) / 2;
            p.dxi[i] = a * (1 - eta * eta) / 2;
            p.deta[i] = -eta * (1 + a * xi);
        } else {
            p.N[i] = (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1) / 4;
            p.dxi[i] = a * (1 + b * eta) * (2 * a * xi + b * eta) / 4;
            p.deta[i] = b * (1 + a * xi) * (a * xi + 2 * b * eta) / 4;
        }
    }
    return p;
}

/// Calls use(s, t, weight) for n x n Gauss points of the square from -1 to 1.
template <unsigned n, class Use> void on_square(Use use) {
    using Gauss = boost::math::quadrature::gauss<double, n>;
    const auto along = [](auto act) { // Boost lists the points that are not negative
        for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
            const double at = Gauss::abscissa()[i], weight = Gauss::weights()[i];
            act(at, weight);
            if (at != 0) act(-at, weight);
        }
    };
    along([&](double s, double ws) { along([&](double t, double wt) { use(s, t, ws * wt); }); });
}

/// Calls use(point) for the points of a piece of an eight-node face, with five points in each direction of the square of
/// which the piece is an image; a triangle is one with two corners in one place. N_i x_xi x x_eta is of degree seven.
template <class Use> void integrate_piece(const mesh::LocalFace& piece, Use use) {
    const auto corner = [&](int i) -> Eigen::Vector2d {
        const auto node = static_cast<std::size_t>(piece.nodes[static_cast<std::size_t>(std::min(i, piece.count - 1))]);
        return {eight_nodes[node][0], eight_nodes[node][1]};
    };
    const Eigen::Vector2d a = corner(0), b = corner(1), c = corner(2), d = corner(3);
    on_square<5>([&](double s, double t, double weight) {
        const Eigen::Vector2d at = ((1 - s) * (1 - t) * a + (1 + s) * (1 - t) * b + (1 + s) * (1 + t) * c +
                                    (1 - s) * (1 + t) * d) /
                                   4,
                              along_s = ((1 - t) * (b - a) + (1 + t) * (c - d)) / 4,
                              along_t = ((1 - s) * (d - a) + (1 + s) * (c - b)) / 4;
        use(eight_node_point(at.x(), at.y(), weight * (along_s.x() * along_t.y() - along_s.y() * along_t.x())));
    });
}

Point four_node_point(double xi, double eta, double weight) {
    Point p;
    p.weight = weight;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [a, b] = eight_nodes[i];
        p.N[i] = (1 + a * xi) * (1 + b * eta) / 4;
        p.dxi[i] = a * (1 + b * eta) / 4;
        p.deta[i] = b * (1 + a * xi) / 4;
    }
    return p;
}

/// Shape functions of a face and their derivatives, with weight 1.
Point point_of(const mesh::FaceShape& face, const Vec2& at) {
    switch (face.nodes) {
    case 3: return {1, {1 - at.x() - at.y(), at.x(), at.y()}, {-1, 1}, {-1, 0, 1}};
    case 4: return four_node_point(at.x(), at.y(), 1);
    case 6: return six_node_point(at.x(), at.y(), 1);
    default: return eight_node_point(at.x(), at.y(), 1);
    }
}

/// Calls use(point) for every quadrature point.
template <class Use> void integrate(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions, Use use) {
    const auto finish = [&](Point p) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
            const Vec3& x = positions[static_cast<std::size_t>(face.nodes[i])];
            p.x_xi += p.dxi[i] * x;
            p.x_eta += p.deta[i] * x;
        }
        use(p);
    };
    if (face.count == 6) {
        if (face.whole()) return integrate_part(0, 0, 1, finish);
        if (face.pieces[0]) integrate_part(0, 0, 0.5, finish);
        if (face.pieces[1]) integrate_part(0.5, 0, 0.5, finish);
        if (face.pieces[2]) integrate_part(0, 0.5, 0.5, finish);
        if (face.pieces[3]) integrate_part(0.5, 0.5, -0.5, finish);
        return;
    }
    if (face.count == 8) {
        if (face.whole())
            return on_square<3>(
                [&](double xi, double eta, double weight) { finish(eight_node_point(xi, eta, weight)); });
        for (std::size_t piece = 0; piece < face.shape().pieces.size(); ++piece)
            if (face.pieces[piece]) integrate_piece(face.shape().pieces[piece], finish);
        return;
    }
    if (face.count == 3) {
        // N_i integrates to 1/6 over the unit triangle, and the area vector is constant
        finish({0.5, {1. / 3, 1. / 3, 1. / 3}, {-1, 1}, {-1, 0, 1}});
        return;
    }
    const double g = 1 / std::sqrt(3.0);
    for (std::size_t q = 0; q < 4; ++q) finish(four_node_point(g * eight_nodes[q][0], g * eight_nodes[q][1], 1));
}

} // namespace

namespace {
/// Natural coordinates of the nodes of a three- or six-node face.
constexpr std::array<std::array<double, 2>, 6> six_nodes{{{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}};

} // namespace

Vec2 natural_coordinates(const mesh::FaceShape& face, int node) {
    const auto [xi, eta] = (face.corners == 3 ? six_nodes.data() : eight_nodes.data())[node];
    return {xi, eta};
}

FacePoint face_point(const mesh::SurfaceFace& face, const Vec2& at, const std::vector<Vec3>& positions) {
    const Point p = point_of(face.shape(), at);
    FacePoint result;
    result.N = p.N;
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i) {
        const Vec3& x = positions[static_cast<std::size_t>(face.nodes[i])];
        result.x += p.N[i] * x;
        result.x_xi += p.dxi[i] * x;
        result.x_eta += p.deta[i] * x;
    }
    return result;
}

std::vector<PiecePoint> piece_points(const mesh::FaceShape& face, const mesh::LocalFace& piece) {
    const auto n = static_cast<std::size_t>(piece.count);
    constexpr std::array<double, 4> s_c{-1, 1, 1, -1}, t_c{-1, -1, 1, 1};
    std::vector<PiecePoint> points;
    on_square<5>([&](double s, double t, double weight) {
        PiecePoint& q = points.emplace_back();
        q.weight = weight;
        Vec2 at = Vec2::Zero();
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const std::size_t c = std::min(corner, n - 1);
            const double along_s = 1 + s_c[corner] * s, along_t = 1 + t_c[corner] * t, phi = along_s * along_t / 4;
            q.phi[c] += phi;
            q.by_s[c] += s_c[corner] * along_t / 4;
            q.by_t[c] += t_c[corner] * along_s / 4;
            at += phi * natural_coordinates(face, piece.nodes[c]);
        }
        q.N = point_of(face, at).N;
    });
    return points;
}

std::array<double, mesh::most_nodes_per_face> tributary_areas(const mesh::SurfaceFace& face,
                                                              const std::vector<Vec3>& positions) {
    std::array<double, mesh::most_nodes_per_face> areas{};
    integrate(face, positions, [&](const Point& p) {
        const double area = p.weight * p.x_xi.cross(p.x_eta).norm();
        for (std::size_t i = 0; i < areas.size(); ++i) areas[i] += p.N[i] * area;
    });
    return areas;
}

Matrix shape_products(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions) {
    const Index n = face.count;
    if (n == 3) return area(face, positions) / 12 * (Matrix::Identity(n, n) + Matrix::Ones(n, n));
    Matrix products = Matrix::Zero(n, n);
    integrate(face, positions, [&](const Point& p) {
        const Eigen::Map<const Vector> N(p.N.data(), n);
        products += p.weight * p.x_xi.cross(p.x_eta).norm() * N * N.transpose();
    });
    return products;
}

std::array<double, 4> tributary_areas(const mesh::Facet& facet, const std::vector<Vec3>& positions) {
    const auto areas = tributary_areas(mesh::plane_face(facet), positions);
    return {areas[0], areas[1], areas[2], areas[3]};
}

double area(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions) {
    double sum = 0;
    for (const double share : tributary_areas(face, positions)) sum += share;
    return sum;
}

std::array<Vec3, mesh::most_nodes_per_face> pressure_forces(const mesh::SurfaceFace& face,
                                                            const std::vector<Vec3>& positions, double pressure) {
    std::array<Vec3, mesh::most_nodes_per_face> forces;
    forces.fill(Vec3::Zero());
    integrate(face, positions, [&](const Point& p) {
        const Vec3 force = -pressure * p.weight * p.x_xi.cross(p.x_eta);
        for (std::size_t i = 0; i < forces.size(); ++i) forces[i] += p.N[i] * force;
    });
    return forces;
}

void add_pressure_forces(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions, double pressure,
                         std::vector<Vec3>& forces) {
    const auto own = pressure_forces(face, positions, pressure);
    for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i)
        forces[static_cast<std::size_t>(face.nodes[i])] += own[i];
}

Matrix pressure_tangent(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions, double pressure) {
    Matrix K = Matrix::Zero(3 * face.count, 3 * face.count);
    integrate(face, positions, [&](const Point& p) {
        for (int b = 0; b < face.count; ++b) {
            // d (x_xi x x_eta) = dN_b/dxi du x x_eta - dN_b/deta du x x_xi
            const auto j = static_cast<std::size_t>(b);
            const Vec3 arm = p.dxi[j] * p.x_eta - p.deta[j] * p.x_xi;
            Mat3 cross; // du x arm
            cross << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
            for (int a = 0; a < face.count; ++a)
                K.block<3, 3>(3 * a, 3 * b) -= pressure * p.weight * p.N[static_cast<std::size_t>(a)] * cross;
        }
    });
    return K;
}

} // namespace osculate::fe
