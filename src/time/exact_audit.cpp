#include "osculate/time/exact_audit.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace osculate::time {

namespace {

constexpr double nowhere = std::numeric_limits<double>::infinity();

double distance(const contact::PlaneShape& s, const Vec3& p) {
    return p.dot(s.normal) - s.point.dot(s.normal);
}

double distance(const contact::CylinderShape& s, const Vec3& p) {
    const double d = (p - s.point).cross(s.axis).norm() - s.radius;
    return s.inside ? -d : d;
}

double distance(const contact::SphereShape& s, const Vec3& p) {
    const double d = (p - s.centre).norm() - s.radius;
    return s.inside ? -d : d;
}

double distance(const contact::ConeShape& s, const Vec3& p) {
    const Vec3 arm = p - s.apex;
    const double from = std::atan2(arm.cross(s.axis).norm(), arm.dot(s.axis)) - s.half_angle; // from the surface, rad
    const double d = from < std::numbers::pi / 2 ? arm.norm() * std::sin(from) : arm.norm();
    return s.inside ? -d : d;
}

double distance(const contact::ExtrudedShape& s, const Vec3& p) {
    constexpr int chords = 64; // of an arc
    std::vector<Vec2> line;
    double sagitta = 0;
    for (const contact::ProfilePiece& piece : s.pieces) {
        line.push_back(piece.begin);
        if (piece.bend == 0) continue;
        const Vec2 a = piece.begin - piece.centre, b = piece.end - piece.centre;
        const double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
        for (int k = 1; k < chords; ++k) line.emplace_back(piece.centre + Eigen::Rotation2Dd(turn * k / chords) * a);
        sagitta = std::max(sagitta, (1 - std::cos(turn / (2 * chords))) / std::abs(piece.bend));
    }
    line.push_back(s.pieces.back().end);
    const Vec2 q((p - s.origin).dot(s.u), (p - s.origin).dot(s.v));
    const std::size_t n = line.size() - 1;
    const auto left = [&](std::size_t k) {
        const Vec2 t = (line[k + 1] - line[k]).normalized();
        return Vec2(-t.y(), t.x());
    };
    double nearest = nowhere, side = 0;
    bool past = false;
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 along = line[k + 1] - line[k];
        const double share = along.dot(q - line[k]) / along.squaredNorm();
        const Vec2 foot = line[k] + std::clamp(share, 0.0, 1.0) * along;
        const double d = (q - foot).norm();
        if (!(d < nearest)) continue;
        nearest = d;
        // at a corner both lines have a say
        Vec2 out = left(k);
        if (share <= 0 && (k > 0 || s.closed)) out += left(k > 0 ? k - 1 : n - 1);
        if (share >= 1 && (k + 1 < n || s.closed)) out += left(k + 1 < n ? k + 1 : 0);
        side = out.dot(q - foot);
        past = !s.closed && ((k == 0 && share < 0) || (k + 1 == n && share > 1));
    }
    if (past) return nowhere;
    return side >= 0 ? nearest : -std::max(0.0, nearest - sagitta);
}

/// Largest curvature with which a shape bulges out of its solid near a point, 1/m; corners have an infinite one.
double bulge(const contact::PlaneShape&, const Vec3&) {
    return 0;
}
double bulge(const contact::CylinderShape& s, const Vec3&) {
    return s.inside ? 0 : 1 / s.radius;
}
double bulge(const contact::SphereShape& s, const Vec3&) {
    return s.inside ? 0 : 1 / s.radius;
}
double bulge(const contact::ConeShape& s, const Vec3& p) {
    return s.inside ? 0 : std::cos(s.half_angle) / (p - s.apex).cross(s.axis).norm();
}
double bulge(const contact::ExtrudedShape& s, const Vec3&) {
    double most = 0;
    for (const contact::ProfilePiece& piece : s.pieces) most = std::max(most, -piece.bend);
    for (std::size_t k = s.closed ? 0 : 1; k < s.pieces.size(); ++k) {
        const auto end = [](const contact::ProfilePiece& piece, bool last) {
            if (piece.bend == 0) return Vec2((piece.end - piece.begin).normalized());
            const Vec2 arm = (last ? piece.end : piece.begin) - piece.centre;
            return Vec2(Vec2(-arm.y(), arm.x()) * piece.bend);
        };
        const Vec2 a = end(s.pieces[k > 0 ? k - 1 : s.pieces.size() - 1], true), b = end(s.pieces[k], false);
        constexpr double smooth = 1e-9; // rad
        if (a.x() * b.y() - a.y() * b.x() < -smooth) most = nowhere;
    }
    return most;
}

/// Rotation that takes drawn positions to current ones best, and where the mean of the nodes goes.       [Kabsch 1976]
Eigen::Isometry3d placement(const model::Model& model, const model::RigidBody& rigid, const Field& x) {
    Vec3 drawn = Vec3::Zero(), now = Vec3::Zero();
    const auto count = static_cast<double>(rigid.nodes.size());
    for (const Index node : rigid.nodes) {
        drawn += model.X[static_cast<std::size_t>(node)] / count;
        now += x[static_cast<std::size_t>(node)] / count;
    }
    Mat3 A = Mat3::Zero();
    for (const Index node : rigid.nodes)
        A += (x[static_cast<std::size_t>(node)] - now) * (model.X[static_cast<std::size_t>(node)] - drawn).transpose();
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    place.linear() = nearest_rotation(A);
    place.translation() = now - place.linear() * drawn;
    return place;
}

} // namespace

double audited_distance(const contact::ExactShape& shape, const Vec3& point) {
    return std::visit([&](const auto& one) { return distance(one, point); }, shape);
}

ExactAudit::ExactAudit(const model::Model& model, const std::vector<std::vector<mesh::Facet>>& outer) : model_(model) {
    for (const model::RigidBody& rigid : model.rigid) {
        if (!rigid.shape) continue;
        std::map<Index, std::set<Index>> slaves; // body -> nodes
        for (const auto& pair : model.pairs)
            if (model::body_index(model, pair->master_nodes().front()) == rigid.body)
                slaves[model::body_index(model, pair->slaves().node.front())].insert(pair->slaves().node.begin(),
                                                                                     pair->slaves().node.end());
        Host host{&rigid, {}};
        for (auto& [body, nodes] : slaves) {
            Guest& guest = host.guests.emplace_back();
            guest.body = body;
            double sum = 0;
            for (const mesh::Facet& facet : outer[static_cast<std::size_t>(body)]) {
                sum += std::sqrt(mesh::facet_area_vector(facet, model.X).norm());
                for (const Index node : facet)
                    if (audited_distance(*rigid.shape, model.X[static_cast<std::size_t>(node)]) >= 0)
                        nodes.insert(node);
            }
            guest.nodes.assign(nodes.begin(), nodes.end());
            for (const mesh::Facet& facet : outer[static_cast<std::size_t>(body)])
                if (std::ranges::all_of(facet, [&, &all = nodes](Index node) { return all.contains(node); }))
                    guest.facets.push_back(facet);
            guest.length = sum / static_cast<double>(outer[static_cast<std::size_t>(body)].size());
        }
        if (!host.guests.empty()) hosts_.push_back(std::move(host));
    }
}

void ExactAudit::cut_facets(const contact::ExactShape& shape, const Guest& guest, const Field& x,
                            const Eigen::Isometry3d& back, contact::Intrusion& deepest) const {
    constexpr int parts = 6;                                  // of an edge
    constexpr double most_turn = 40 * std::numbers::pi / 180; // over a facet
    for (const mesh::Facet& facet : guest.facets) {
        std::array<Vec3, 4> corner;
        for (std::size_t c = 0; c < 4; ++c) // a triangle has its last corner twice
            corner[c] =
                back * x[static_cast<std::size_t>(facet.nodes[std::min(c, static_cast<std::size_t>(facet.count) - 1)])];
        const double across = std::max((corner[2] - corner[0]).norm(), (corner[3] - corner[1]).norm());
        const Vec3 middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
        if (audited_distance(shape, middle) > across) continue;
        const double curvature = std::visit([&](const auto& one) { return bulge(one, middle); }, shape);
        // what is finer than the facet is judged by its own size
        const double length = curvature * guest.length > 1 && std::isfinite(curvature) ? 1 / curvature : guest.length;
        const double sagitta = across / 8 * std::min(across * curvature, most_turn);
        for (int i = 0; i <= parts; ++i)
            for (int j = 0; j <= parts; ++j) {
                const double a = static_cast<double>(i) / parts, b = static_cast<double>(j) / parts;
                const Vec3 at =
                    (1 - b) * ((1 - a) * corner[0] + a * corner[1]) + b * ((1 - a) * corner[3] + a * corner[2]);
                const double depth = -audited_distance(shape, at), excess = depth - sagitta;
                if (!(excess * deepest.length > deepest.excess * length)) continue;
                const Vec3 place = back.inverse() * at;
                deepest = {guest.body, deepest.other, facet.nodes[0], false, true, place, depth, excess, length};
            }
    }
}

void ExactAudit::examine(const Field& x, contact::AuditResult& result) const {
    std::map<Index, double> inside(result.nodes.begin(), result.nodes.end());
    for (const Host& host : hosts_) {
        const Eigen::Isometry3d back = placement(model_, *host.rigid, x).inverse();
        for (const Guest& guest : host.guests) {
            contact::Intrusion deepest;
            for (const Index node : guest.nodes) {
                const Vec3& at = x[static_cast<std::size_t>(node)];
                const double depth = -audited_distance(*host.rigid->shape, back * at);
                if (!(depth > 0)) continue;
                double& excess = inside[node];
                excess = std::max(excess, depth);
                if (depth <= deepest.depth) continue;
                deepest = {guest.body, host.rigid->body, node, false, false, at, depth, depth, guest.length};
            }
            deepest.other = host.rigid->body;
            cut_facets(*host.rigid->shape, guest, x, back, deepest);
            if (deepest.body >= 0) result.intrusions.push_back(deepest);
        }
    }
    result.nodes.assign(inside.begin(), inside.end());
    std::ranges::sort(result.intrusions, {}, [](const contact::Intrusion& one) {
        return std::pair(std::min(one.body, one.other), std::max(one.body, one.other));
    });
}

} // namespace osculate::time
