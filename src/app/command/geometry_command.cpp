#include "app/command/geometry_command.hpp"

#include "app/fault.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/escaped.hpp"
#include "osculate/mesh/cad_listing.hpp"
#include "osculate/report/picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <map>

namespace osculate::app {

namespace {

using mesh::CadEntity;
using mesh::CadListing;
using Rows = std::vector<std::vector<std::string>>;

/// Of a part of 1e-6 of the geometry's size what is left of zero is round-off.
std::string vector(const Vec3& x, double size) {
    const Vec3 clean = (x.array().abs() > 1e-6 * size).select(x, 0.0);
    return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", clean[0], clean[1], clean[2]);
}

std::string number(double value) {
    return value > 0 ? fmt::format("{:.5g}", value) : "";
}

std::string aligned(const Rows& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) {
            if (widths.size() <= c) widths.push_back(0);
            widths[c] = std::max(widths[c], row[c].size());
        }
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format("{:{}}  ", row[c], widths[c]);
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

Vec3 middle(const CadListing& listing, const std::array<int, 3>& t) {
    Vec3 sum = Vec3::Zero();
    for (const int p : t) sum += listing.points[static_cast<std::size_t>(p)];
    return sum / 3;
}

/// A point of the triangulation that is far from the face's edges, as `nearest` of a set wants it: the middle of the triangle
/// whose distance from the border is largest.
Vec3 point_on(const CadListing& listing, std::size_t face) {
    std::map<std::pair<int, int>, int> sides;
    for (const auto& t : listing.triangles[face])
        for (std::size_t k = 0; k < 3; ++k) ++sides[std::minmax(t[k], t[(k + 1) % 3])];
    std::vector<Vec3> border;
    for (const auto& [side, count] : sides)
        if (count == 1)
            for (const int p : {side.first, side.second}) border.push_back(listing.points[static_cast<std::size_t>(p)]);
    Vec3 best = listing.faces[face].centre;
    double farthest = -1;
    for (const auto& t : listing.triangles[face]) {
        const Vec3 at = middle(listing, t);
        double near = std::numeric_limits<double>::infinity();
        for (const Vec3& b : border) near = std::min(near, (at - b).squaredNorm());
        if (near > farthest) {
            farthest = near;
            best = at;
        }
    }
    return best;
}

/// Of the triangles of a solid's faces, which are up to 1 % of a radius within round faces. Gmsh's boxes are up to several per
/// cent too large there.
Eigen::AlignedBox3d box_of(const CadListing& listing, int solid) {
    Eigen::AlignedBox3d box;
    for (std::size_t f = 0; f < listing.faces.size(); ++f)
        if (std::ranges::count(listing.faces[f].of, solid) > 0)
            for (const auto& t : listing.triangles[f])
                for (const int p : t) box.extend(listing.points[static_cast<std::size_t>(p)]);
    return box;
}

std::string quoted(const std::string& name) {
    return name.empty() ? "" : "'" + name + "'";
}

/// The faces as parts that do not move, each in a colour of its own.
report::MovingSurfaces surfaces_of(const CadListing& listing) {
    report::MovingSurfaces surfaces;
    surfaces.times = {0};
    for (std::size_t f = 0; f < listing.faces.size(); ++f) {
        report::MovingPart& part = surfaces.parts.emplace_back();
        part.name = fmt::format("face_{}", listing.faces[f].tag);
        std::map<int, std::uint32_t> number;
        for (const auto& t : listing.triangles[f]) {
            std::array<std::uint32_t, 4> corners{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [at, fresh] = number.emplace(t[k], static_cast<std::uint32_t>(part.points.size()));
                if (fresh) {
                    part.nodes.push_back(t[k]);
                    part.points.push_back(listing.points[static_cast<std::size_t>(t[k])]);
                }
                corners[k] = at->second;
            }
            corners[3] = corners[2];
            part.facets.push_back(corners);
        }
        // neighbours get colours far apart: steps of the golden ratio
        constexpr double golden = 0.6180339887498949;
        const double colour = std::fmod(golden * static_cast<double>(f), 1.0);
        part.fields.push_back({"displacement", "m", false, {3, {std::vector<float>(3 * part.points.size(), 0)}}});
        part.fields.push_back(
            {"face", "", false, {1, {std::vector<float>(part.points.size(), static_cast<float>(colour))}}});
    }
    return surfaces;
}

/// Seen from two opposite sides, so that every face of a convex body is in one of them.
std::string picture(const CadListing& listing, const std::string& title) {
    const report::MovingSurfaces surfaces = surfaces_of(listing);
    std::vector<std::vector<Vec3>> things;
    for (const auto& triangles : listing.triangles) {
        auto& points = things.emplace_back();
        for (const auto& t : triangles) points.push_back(middle(listing, t));
    }
    report::PictureOptions options;
    options.width = options.height = 900;
    options.field = {"face", "", 0, 1};
    options.outlines = true;
    const int head = 50;
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" "
                                  "xmlns:xlink=\"http://www.w3.org/1999/xlink\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
                                  "height=\"{1}\" font-family=\"sans-serif\" font-size=\"20\" "
                                  "text-anchor=\"middle\">\n<rect width=\"{0}\" height=\"{1}\" "
                                  "fill=\"#fff\"/>\n<text x=\"24\" y=\"34\" text-anchor=\"start\">{2}</text>\n",
                                  2 * options.width, options.height + head, escaped(title));
    for (int side = 0; side < 2; ++side) {
        if (side == 1) options.towards_eye = -options.towards_eye;
        const report::PictureWithPlaces seen = report::draw(surfaces, 0, options, things);
        const int left = side * options.width;
        svg += fmt::format(
            "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" xlink:href=\"data:image/png;base64,{}\"/>\n", left,
            head, options.width, options.height, report::base64(seen.png));
        for (std::size_t f = 0; f < things.size(); ++f)
            if (const auto& at = seen.places[f])
                svg += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"#111\" stroke=\"#fff\" stroke-width=\"5\" "
                                   "stroke-linejoin=\"round\" paint-order=\"stroke\">{}</text>\n",
                                   left + at->x(), head + at->y() + 7, listing.faces[f].tag);
    }
    return svg + "</svg>\n";
}

void write_picture(const std::string& path, const std::string& svg) {
    std::ofstream file(path, std::ios::binary);
    file << svg;
    if (!file.flush()) throw SceneError({fault("--picture", "a file that can be written", "'" + path + "'")});
}

} // namespace

std::string describe_geometry(const MeshCommand& command) {
    if (!command.part.empty() || command.piece != 0 || !command.repair.empty())
        throw SceneError({fault("mesh", "--part, --piece and --repair with a mesh", "a geometry, which has none yet")});
    const CadListing listing = mesh::list_cad(command.file);
    Eigen::AlignedBox3d box;
    for (const Vec3& x : listing.points) box.extend(x);
    const double size = box.diagonal().norm();
    const auto count = [](std::size_t n, const char* what) {
        return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
    };
    std::string text = fmt::format("{}, {}, {}; from {} to {} m\n", count(listing.solids.size(), "solid"),
                                   count(listing.faces.size(), "face"), count(listing.edges.size(), "edge"),
                                   vector(box.min(), size), vector(box.max(), size));
    Rows rows{{"solid", "name", "volume, m^3", "centre of mass, m", "from", "to"}};
    for (const CadEntity& s : listing.solids) {
        const Eigen::AlignedBox3d own = box_of(listing, s.tag);
        rows.push_back({fmt::format("volume_{}", s.tag), quoted(s.name), number(s.measure), vector(s.centre, size),
                        vector(own.min(), size), vector(own.max(), size)});
    }
    text += "\n" + aligned(rows);
    rows = {{"surface", "name", "type", "area, m^2", "radius, m", "axis", "a point on it, m", "of"}};
    for (std::size_t f = 0; f < listing.faces.size(); ++f) {
        const CadEntity& face = listing.faces[f];
        std::string of;
        for (const int solid : face.of) of += (of.empty() ? "" : ", ") + fmt::format("volume_{}", solid);
        rows.push_back({fmt::format("face_{}", face.tag), quoted(face.name), face.type, number(face.measure),
                        number(face.radius), face.axis.isZero() ? "" : vector(face.axis, 1),
                        vector(point_on(listing, f), size), of});
    }
    text += "\n" + aligned(rows);
    rows = {{"edge", "type", "length, m", "radius, m", "axis", "centre of mass, m", "between"}};
    for (const CadEntity& edge : listing.edges) {
        std::string between;
        for (const int face : edge.of) between += (between.empty() ? "" : ", ") + fmt::format("face_{}", face);
        rows.push_back({std::to_string(edge.tag), edge.type, number(edge.measure), number(edge.radius),
                        edge.axis.isZero() ? "" : vector(edge.axis, 1), vector(edge.centre, size), between});
    }
    text += "\n" + aligned(rows);
    if (!command.picture.empty()) {
        write_picture(command.picture, picture(listing, std::filesystem::path(command.file).filename().string()));
        text += "\n" + command.picture + " shows the numbers of the faces, from two sides\n";
    }
    return text;
}

} // namespace osculate::app
