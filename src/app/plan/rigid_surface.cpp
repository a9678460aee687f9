#include "app/plan/rigid_surface.hpp"

#include "app/overloaded.hpp"

#include <stdexcept>

namespace osculate::app {

namespace {

contact::ExtrudedShape extruded(const scene::ExtrudedSurface& s, const Vec3& origin) {
    contact::ExtrudedShape shape;
    shape.origin = s.points.front() - origin;
    shape.along = s.direction.normalized();
    const auto across = [&](const Vec3& d) { return Vec3(d - shape.along * shape.along.dot(d)); };
    // the axis of u along the first line, in the plane of the profile
    constexpr double thin = 1e-9; // of the size of the profile
    double size = 0;
    for (const Vec3& p : s.points) size = std::max(size, across(p - s.points.front()).norm());
    const Vec3 first = across(s.points[1] - s.points[0]);
    if (!(first.norm() > thin * size)) throw std::invalid_argument("points 1 and 2 coincide, seen along the direction");
    shape.u = first.normalized();
    shape.v = shape.along.cross(shape.u);
    std::vector<Vec2> points;
    for (const Vec3& p : s.points) {
        points.emplace_back(shape.u.dot(p - s.points.front()), shape.v.dot(p - s.points.front()));
        if (const std::size_t n = points.size(); n > 1 && !((points[n - 1] - points[n - 2]).norm() > thin * size))
            throw std::invalid_argument("points " + std::to_string(n - 1) + " and " + std::to_string(n) +
                                        " coincide, seen along the direction");
    }
    if ((points.back() - points.front()).norm() <= thin * size && points.size() > 3) points.back() = points.front();
    const double left = shape.v.dot(across(s.outward).normalized());
    constexpr double least = 1e-6; // sine of the angle between outward and the first line
    if (!(std::abs(left) > least))
        throw std::invalid_argument("outward is along the first line or the direction, and tells no side of it");
    if (left < 0) { // the solid is on the right of the curve: turn the plane over
        shape.along = -shape.along;
        shape.v = -shape.v;
        for (Vec2& p : points) p.y() = -p.y();
    }
    if (s.smooth && s.fillet > 0) throw std::invalid_argument("a smooth curve has no corners for a fillet");
    shape.pieces = s.smooth ? contact::smooth_profile(points) : contact::line_profile(points, s.fillet);
    shape.closed = points.back() == points.front();
    return shape;
}

} // namespace

contact::ExactShape exact_shape(const scene::RigidSurface& surface, const Vec3& origin) {
    return std::visit(
        Overloaded{
            [&](const scene::PlaneSurface& s) -> contact::ExactShape {
                return contact::PlaneShape{s.point - origin, s.normal.normalized()};
            },
            [&](const scene::CylinderSurface& s) -> contact::ExactShape {
                return contact::CylinderShape{s.axis_point - origin, s.axis_direction.normalized(), s.radius, s.inside};
            },
            [&](const scene::SphereSurface& s) -> contact::ExactShape {
                return contact::SphereShape{s.centre - origin, s.radius, s.inside};
            },
            [&](const scene::ConeSurface& s) -> contact::ExactShape {
                return contact::ConeShape{s.apex - origin, s.axis_direction.normalized(), s.half_angle, s.inside};
            },
            [&](const scene::ExtrudedSurface& s) -> contact::ExactShape { return extruded(s, origin); },
        },
        surface);
}

Vec3 usual_reference_point(const scene::RigidSurface& surface) {
    return std::visit(Overloaded{
                          [](const scene::PlaneSurface& s) { return s.point; },
                          [](const scene::CylinderSurface& s) { return s.axis_point; },
                          [](const scene::SphereSurface& s) { return s.centre; },
                          [](const scene::ConeSurface& s) { return s.apex; },
                          [](const scene::ExtrudedSurface& s) { return s.points.front(); },
                      },
                      surface);
}

std::string master_set(const scene::MasterSpec& master) {
    return master.rigid_surface.empty() ? master.set : surface_set(master.rigid_surface);
}

std::string surface_set(const std::string& body) {
    return body + " (rigid surface)";
}

} // namespace osculate::app
