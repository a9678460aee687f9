#include "scene/describe_parts.hpp"
#include "scene/frame.hpp"

#include <algorithm>
#include <numbers>

namespace osculate::scene {

namespace {

// Point, direction and box of the geometric selections.
void point(Visitor& v, const char* name, const char* meaning, Vec3& value) {
    v.vector({.name = name, .meaning = meaning, .unit = dimension::length, .range = range::position, .required = true},
             value);
}
void direction(Visitor& v, const char* name, const char* meaning, Vec3& value) {
    v.vector({.name = name, .meaning = meaning, .range = range::direction, .required = true, .direction = true}, value);
}

void describe(Visitor& v, SelectPlane& s) {
    point(v, "point", "A point of the plane.", s.point);
    direction(v, "normal", "Normal of the plane.", s.normal);
}

void describe(Visitor& v, SelectCylinder& s) {
    point(v, "point", "A point of the axis.", s.point);
    direction(v, "axis", "Direction of the axis.", s.axis);
    v.number(
        {.name = "radius", .meaning = "Radius.", .unit = dimension::length, .range = range::size, .required = true},
        s.radius);
}

void describe(Visitor& v, SelectNormal& s) {
    direction(v, "direction", "Direction that outward normals are compared with.", s.direction);
    v.number({.name = "angle",
              .meaning = "Largest angle between a facet's normal and the direction.",
              .unit = dimension::angle,
              .range = {.low = 0, .high = std::numbers::pi, .open_low = true}},
             s.angle);
}

void describe(Visitor& v, SelectNearest& s) {
    point(v, "point", "A point on that surface, away from its edges, or close to it.", s.point);
}

void describe(Visitor& v, SelectNode& s) {
    point(v, "point", "A point that is nearer to the node than to any other.", s.point);
}

} // namespace

void describe(Visitor& v, SelectBox& s) {
    point(v, "min", "Lower corner.", s.min);
    point(v, "max", "Upper corner.", s.max);
}

void describe(Visitor& v, SetSpec& set) {
    v.text({.name = "body", .meaning = "Body the set belongs to.", .required = true, .names = Names::body}, set.body);
    static const Words tags{"surface", "nodes",        "plane",   "cylinder", "box",
                            "normal",  "node_numbers", "nearest", "node"};
    constexpr std::size_t nodes = 1; // surface and nodes are both a SelectNamed
    const std::size_t index = set.select.index();
    const auto* by_name = std::get_if<SelectNamed>(&set.select);
    const auto name = [&v](const Key& key, SelectNamed& s) { v.text(key, s.name); };
    const auto group = [&](const char* tag, const char* meaning) {
        v.group({.name = tag, .meaning = meaning}, [&] {
            std::visit(
                [&]<class S>(S& s) {
                    if constexpr (!std::is_same_v<S, SelectNamed> && !std::is_same_v<S, SelectNumbers>) describe(v, s);
                },
                set.select);
        });
    };
    v.one_of(
        {.tags = tags,
         .active = by_name ? (by_name->nodes ? nodes : 0) : index + 1,
         .required = true,
         .choose =
             [&](std::size_t i) {
                 emplace(set.select, i <= nodes ? 0 : i - 1, std::make_index_sequence<8>{});
                 if (i == nodes) std::get<SelectNamed>(set.select).nodes = true;
             },
         .describe =
             [&](std::size_t i) {
                 switch (i) {
                 case 0:
                     return name({.name = "surface", .meaning = "A surface that the mesh names.", .required = true},
                                 std::get<SelectNamed>(set.select));
                 case nodes:
                     return name({.name = "nodes", .meaning = "A node set that the mesh names.", .required = true},
                                 std::get<SelectNamed>(set.select));
                 case 2: return group("plane", "Exterior facets in a plane.");
                 case 3: return group("cylinder", "Exterior facets on a cylinder.");
                 case 4: return group("box", "Exterior facets inside a box.");
                 case 5: return group("normal", "Exterior facets that face a direction.");
                 case 7:
                     return group("nearest", "The surface that the mesh names, such as face_<number> of a geometry, "
                                             "nearest to a point.");
                 case 8: return group("node", "The node nearest to a point, on the surface or inside.");
                 default:
                     return v.integers({.name = "node_numbers",
                                        .meaning = "Nodes by their numbers in the mesh file.",
                                        .range = {.low = 0, .high = 2147483647},
                                        .required = true},
                                       std::get<SelectNumbers>(set.select).numbers);
                 }
             }});
}

void describe(Visitor& v, Support& support) {
    static const Words tags{"fix", "symmetry"};
    v.one_of({.tags = tags,
              .active = support.symmetry ? std::size_t{1} : std::size_t{0},
              .required = false,
              .choose =
                  [&](std::size_t i) {
                      support.symmetry = i == 1;
                      support.fixed = {support.symmetry, false, false};
                  },
              .describe =
                  [&](std::size_t i) {
                      if (i == 1) {
                          Vec3 normal = support.axes.col(0);
                          v.vector({.name = "symmetry",
                                    .meaning = "Mirror plane with this normal: displacement along it is held at zero.",
                                    .range = range::direction,
                                    .direction = true,
                                    .default_text = "none"},
                                   normal);
                          support.axes = frame_about(normal);
                          return;
                      }
                      std::vector<std::string> fixed;
                      for (std::size_t a = 0; a < 3; ++a)
                          if (support.fixed[a]) fixed.push_back(axis_words[a]);
                      v.words({.name = "fix", .meaning = "Components held at zero.", .default_text = "none"},
                              axis_words, fixed);
                      for (std::size_t a = 0; a < 3; ++a)
                          support.fixed[a] = std::ranges::count(fixed, axis_words[a]) > 0;
                  }});
    if (support.symmetry) return;
    v.axes({.name = "axes",
            .meaning = "The directions that x and y mean for this set, made orthonormal; z is normal to both."},
           support.axes);
    bool about = support.cylinder.has_value();
    Axis axis = support.cylinder.value_or(Axis{});
    v.optional_group({.name = "cylinder",
                      .meaning =
                          "Instead of axes: x, y and z mean radial, tangential and axial about this axis, at each "
                          "node of the undeformed set."},
                     about, [&] { describe(v, axis); });
    support.cylinder = about ? std::optional(axis) : std::nullopt;
}

void describe(Visitor& v, Axis& axis) {
    v.vector({.name = "point",
              .meaning = "A point of the axis.",
              .unit = dimension::length,
              .range = range::position,
              .required = true},
             axis.point);
    v.vector({.name = "axis",
              .meaning = "Direction of the axis.",
              .range = range::direction,
              .required = true,
              .direction = true},
             axis.direction);
}

} // namespace osculate::scene
