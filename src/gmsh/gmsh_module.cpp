/// mesh::read_gmsh and mesh::mesh_cad by Gmsh: a module of its own, as Gmsh and Open CASCADE are large and may be missing.

#include "gmsh/check_msh.hpp"
#include "gmsh/contact_size.hpp"
#include "gmsh/session.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/quality.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <gmsh.h>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sys/mman.h>
#include <unistd.h>
#include <unordered_map>

namespace osculate::mesh {
namespace {

constexpr double pi = std::numbers::pi;

std::string physical_name(int dimension, int tag) {
    std::string name;
    gmsh::model::getPhysicalName(dimension, tag, name);
    return name.empty() ? "physical_" + std::to_string(tag) : name;
}

class Model {
public:
    Model(std::string file, RawMesh& raw, double unit) : raw_(raw), unit_(unit) { raw_.file = std::move(file); }

    void take() {
        take_nodes();
        gmsh::vectorpair entities;
        gmsh::model::getEntities(entities);
        for (const auto& [dimension, tag] : entities) {
            if (dimension == 3)
                take_volume(tag);
            else
                take_boundary(dimension, tag);
        }
        for (auto& [name, set] : raw_.node_sets) {
            std::sort(set.begin(), set.end());
            set.erase(std::unique(set.begin(), set.end()), set.end());
        }
    }

    /// Puts points on a grid of 1e-10 of the mesh's extent: Gmsh's differ in their last digit from run to run.
    void round_points() {
        Eigen::AlignedBox3d box;
        for (const Vec3& x : raw_.points) box.extend(x);
        if (box.isEmpty() || !(box.diagonal().norm() > 0)) return;
        const double step = std::ldexp(1.0, std::ilogb(box.diagonal().norm()) - 32);
        for (Vec3& x : raw_.points) x = step * (x / step).array().round().matrix();
    }

    /// Makes tet4 cells tet10, with the middle nodes of edges of the boundary on the geometry. Gmsh's own middle nodes
    /// differ in their last digits from run to run.
    void add_middle_nodes() {
        std::map<Edge, std::pair<int, int>> boundary; // dimension and tag; curves before the surfaces that they bound
        for (const int dimension : {1, 2}) {
            gmsh::vectorpair entities;
            gmsh::model::getEntities(entities, dimension);
            for (const auto& [same, tag] : entities)
                for (const Elements& some : elements_of(dimension, tag))
                    for (std::size_t e = 0; e < some.tags.size(); ++e)
                        for (int i = 0; i < (dimension == 1 ? 1 : some.node_count); ++i) {
                            const std::size_t* nodes =
                                some.nodes.data() + e * static_cast<std::size_t>(some.node_count);
                            boundary.try_emplace(edge(number(nodes[i]), number(nodes[(i + 1) % some.node_count])),
                                                 dimension, tag);
                        }
        }
        std::map<Edge, Index> middle;
        for (const RawCell& cell : raw_.cells)
            for (const auto& [a, b] : tet_edges) middle.try_emplace(edge(cell.nodes[a], cell.nodes[b]), -1);
        std::int64_t id = raw_.point_ids.empty() ? 0 : raw_.point_ids.back();
        for (auto& [ends, node] : middle) {
            node = static_cast<Index>(raw_.points.size());
            const auto on = boundary.find(ends);
            raw_.points.push_back(on == boundary.end() ? straight(ends) : on_geometry(ends, on->second));
            raw_.point_ids.push_back(++id);
            raw_.elsewhere.push_back(0);
        }
        for (RawCell& cell : raw_.cells) {
            cell.type = CellType::tet10;
            for (std::size_t i = 0; i < tet_edges.size(); ++i)
                cell.nodes[4 + i] = middle.at(edge(cell.nodes[tet_edges[i][0]], cell.nodes[tet_edges[i][1]]));
        }
        for (auto& [name, faces] : raw_.surfaces)
            for (RawFace& face : faces) {
                if (face.count != 3) continue;
                face.count = 6;
                for (std::size_t i = 0; i < 3; ++i)
                    face.nodes[3 + i] = middle.at(edge(face.nodes[i], face.nodes[(i + 1) % 3]));
            }
        // Where the geometry bends too much for the elements, edges are straight.
        constexpr int rounds = 10;
        for (int round = 0; round < rounds; ++round) {
            bool any = false;
            for (const RawCell& cell : raw_.cells) {
                if (bad_corner(cell.type, {cell.nodes.data(), 10}, raw_.points) < 0) continue;
                any = true;
                for (std::size_t i = 0; i < tet_edges.size(); ++i)
                    raw_.points[static_cast<std::size_t>(cell.nodes[4 + i])] =
                        straight(edge(cell.nodes[tet_edges[i][0]], cell.nodes[tet_edges[i][1]]));
            }
            if (!any) break;
        }
    }

private:
    using Edge = std::pair<Index, Index>; ///< in ascending order
    static constexpr std::array<std::array<std::size_t, 2>, 6> tet_edges{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

    static Edge edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

    [[nodiscard]] Vec3 straight(const Edge& ends) const {
        return 0.5 *
               (raw_.points[static_cast<std::size_t>(ends.first)] + raw_.points[static_cast<std::size_t>(ends.second)]);
    }

    /// The point of a curve or a surface nearest to the middle of an edge; the middle where that is far off.
    [[nodiscard]] Vec3 on_geometry(const Edge& ends, const std::pair<int, int>& entity) const {
        const Vec3 middle = straight(ends), seen = middle / unit_;
        std::vector<double> closest, parametric;
        gmsh::model::getClosestPoint(entity.first, entity.second, {seen[0], seen[1], seen[2]}, closest, parametric);
        if (closest.size() != 3) return middle;
        const Vec3 x = unit_ * Vec3(closest[0], closest[1], closest[2]);
        const double half = (raw_.points[static_cast<std::size_t>(ends.first)] - middle).norm();
        return x.allFinite() && (x - middle).norm() < half ? x : middle;
    }

    struct Elements {
        int type = 0, node_count = 0, dimension = 0;
        std::string name;
        std::vector<std::size_t> tags, nodes;
    };

    std::vector<Elements> elements_of(int dimension, int tag) const {
        std::vector<int> types;
        std::vector<std::vector<std::size_t>> tags, nodes;
        gmsh::model::mesh::getElements(types, tags, nodes, dimension, tag);
        std::vector<Elements> all;
        for (std::size_t t = 0; t < types.size(); ++t) {
            Elements& one = all.emplace_back();
            one.type = types[t];
            one.tags = std::move(tags[t]);
            one.nodes = std::move(nodes[t]);
            int order = 0, primary = 0;
            std::vector<double> local;
            gmsh::model::mesh::getElementProperties(one.type, one.name, one.dimension, order, one.node_count, local,
                                                    primary);
            if (one.nodes.size() != one.tags.size() * static_cast<std::size_t>(one.node_count))
                throw MeshError(raw_.file, "elements with a wrong number of nodes");
        }
        return all;
    }

    void take_nodes() {
        std::vector<std::size_t> tags;
        std::vector<double> x, parametric;
        gmsh::model::mesh::getNodes(tags, x, parametric);
        if (tags.size() > std::numeric_limits<Index>::max() / 3) throw MeshError(raw_.file, "too many nodes");
        std::vector<std::size_t> order(tags.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return tags[a] < tags[b]; });
        raw_.points.reserve(tags.size());
        for (const std::size_t k : order) {
            number_.emplace(tags[k], static_cast<Index>(raw_.points.size()));
            raw_.point_ids.push_back(static_cast<std::int64_t>(tags[k]));
            raw_.points.emplace_back(unit_ * x[3 * k], unit_ * x[3 * k + 1], unit_ * x[3 * k + 2]);
        }
        raw_.elsewhere.assign(raw_.points.size(), 0);
    }

    Index number(std::size_t tag) const {
        const auto found = number_.find(tag);
        if (found == number_.end())
            throw MeshError(raw_.file, "an element has node " + std::to_string(tag) + ", which does not exist");
        return found->second;
    }

    void take_volume(int tag) {
        std::vector<Index> members;
        for (const Elements& some : elements_of(3, tag)) {
            const CellInfo* to = find_cell_type([&](const CellInfo& info) { return info.gmsh == some.type; });
            if (to == nullptr && !some.tags.empty())
                throw MeshError(raw_.file, "element " + std::to_string(some.tags.front()) + " is a " + some.name +
                                               "; only " + cell_names("and", [](const CellInfo&) { return true; }) +
                                               " are read");
            for (std::size_t e = 0; e < some.tags.size(); ++e) {
                RawCell cell;
                cell.id = static_cast<std::int64_t>(some.tags[e]);
                cell.type = to->type;
                for (int i = 0; i < cell.count(); ++i)
                    cell.nodes[i] =
                        number(some.nodes[e * static_cast<std::size_t>(some.node_count) +
                                          static_cast<std::size_t>(to->from_gmsh[static_cast<std::size_t>(i)])]);
                members.push_back(static_cast<Index>(raw_.cells.size()));
                raw_.cells.push_back(cell);
            }
        }
        if (members.empty()) return;
        for (const std::string& name : names_of(3, tag, "volume_")) {
            std::vector<Index>& part = raw_.parts[name];
            part.insert(part.end(), members.begin(), members.end());
        }
    }

    /// Faces of surfaces, nodes of curves and points.
    void take_boundary(int dimension, int tag) {
        const std::vector<std::string> names = names_of(dimension, tag, dimension == 2 ? "face_" : "");
        for (const Elements& some : elements_of(dimension, tag)) {
            const FaceShape* const shape = find_face_shape([&](const FaceShape& s) { return s.gmsh == some.type; });
            const int count = shape == nullptr ? 0 : shape->nodes;
            for (std::size_t e = 0; e < some.tags.size(); ++e) {
                const std::size_t* nodes = some.nodes.data() + e * static_cast<std::size_t>(some.node_count);
                RawFace face;
                face.count = count;
                for (int i = 0; i < some.node_count; ++i) {
                    const Index n = number(nodes[i]);
                    raw_.elsewhere[static_cast<std::size_t>(n)] = 1;
                    if (dimension < 2)
                        for (const std::string& name : names) raw_.node_sets[name].push_back(n);
                    else if (i < count)
                        face.nodes[static_cast<std::size_t>(i)] = n;
                }
                if (dimension < 2 || names.empty()) continue;
                if (count == 0) // no face of any cell that is read
                    continue;
                for (const std::string& name : names) raw_.surfaces[name].push_back(face);
            }
        }
    }

    /// Of the physical groups of an entity, of the entity itself, and its number behind a word, unless that is empty.
    static std::vector<std::string> names_of(int dimension, int tag, const std::string& word) {
        std::vector<std::string> names;
        std::vector<int> groups;
        gmsh::model::getPhysicalGroupsForEntity(dimension, tag, groups);
        for (const int group : groups) names.push_back(physical_name(dimension, std::abs(group)));
        std::string own;
        gmsh::model::getEntityName(dimension, tag, own);
        if (const std::size_t slash = own.rfind('/'); slash != std::string::npos) own.erase(0, slash + 1);
        if (!own.empty() && !word.empty()) names.push_back(own);
        if (!word.empty()) names.push_back(word + std::to_string(tag));
        std::sort(names.begin(), names.end());
        names.erase(std::unique(names.begin(), names.end()), names.end());
        return names;
    }

    RawMesh& raw_;
    double unit_;
    std::unordered_map<std::size_t, Index> number_;
};

/// A file in memory: Gmsh reads files only, and this one has been looked at.
class MemoryFile {
public:
    MemoryFile(const std::string& file, const std::string& text) {
        if (handle_ < 0) throw MeshError(file, std::string("cannot be held in memory: ") + std::strerror(errno));
        // a copy of the handle, which the stream closes
        const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(fdopen(dup(handle_), "wb"), std::fclose);
        const bool written = stream && std::fwrite(text.data(), 1, text.size(), stream.get()) == text.size();
        if (written && std::fflush(stream.get()) == 0) return;
        const std::string reason = std::strerror(errno);
        close(handle_);
        throw MeshError(file, "cannot be held in memory: " + reason);
    }
    ~MemoryFile() { close(handle_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(handle_); }

private:
    int handle_ = memfd_create("mesh", MFD_CLOEXEC);
};

constexpr double most_elements = 2e7; ///< elements of a geometry

/// How many cubes fill a box, if their edges have the length size_at(distance from the point); counts to a little above
/// `most_elements`.
double cubes(const Eigen::AlignedBox3d& box, const Vec3& point, const std::function<double(double)>& size_at) {
    double count = 0, left = box.volume(), distance = box.exteriorDistance(point);
    while (left > 0 && count <= most_elements) { // shells around the point, one cube thick
        const double size = size_at(distance), end = distance + size;
        const double shell = std::min(left, 4 * pi / 3 * (std::pow(end, 3) - std::pow(distance, 3)));
        count += shell / std::pow(size, 3);
        left -= shell;
        distance = end;
    }
    return count;
}

/// Sizes that Gmsh asks for, at points of the geometry, while this lives.
class SizeCallback {
public:
    explicit SizeCallback(std::function<double(const Vec3&)> size_at) {
        // later versions also give the size so far, of curvature, and take what comes back in its place
        gmsh::model::mesh::setSizeCallback(
            [at = std::move(size_at)](int, int, double x, double y, double z, auto... so_far) {
                return std::min({at({x, y, z}), so_far...});
            });
    }
    ~SizeCallback() {
        try {
            gmsh::model::mesh::removeSizeCallback();
        } catch (...) { // nothing is left to be done
        }
    }
    SizeCallback(const SizeCallback&) = delete;
    SizeCallback& operator=(const SizeCallback&) = delete;
};

} // namespace
} // namespace osculate::mesh

using namespace osculate::mesh;
using osculate::Vec3;

extern "C" void osculate_gmsh_read(const std::string* path, RawMesh* mesh) {
    check_exists(*path);
    const MemoryFile checked(*path, checked_msh(*path));
    guarded(*path, [&] {
        gmsh::merge(checked.path());
        Model(*path, *mesh, 1).take();
    });
}

extern "C" void osculate_gmsh_mesh_cad(const CadOptions* options, RawMesh* mesh) {
    check_exists(options->file);
    guarded(options->file, [&] {
        const double unit = open_geometry(options->file);
        double low[3], high[3], diagonal = 0;
        gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
        for (int d = 0; d < 3; ++d) diagonal += (high[d] - low[d]) * (high[d] - low[d]);
        diagonal = std::sqrt(diagonal);
        const double usual = 0.1 * diagonal; // Gmsh takes none larger but for its factor of all sizes
        const double size = options->size > 0 ? options->size / unit : usual;
        const double factor = std::max(1.0, std::ceil(size / usual));
        const Eigen::AlignedBox3d box(Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2]));
        const Vec3 point = options->focus.point / unit;
        const auto size_at = [&, focus = options->focus](double distance) {
            return focus.size_at(distance * unit, size * unit) / unit;
        };
        // What would not end is refused before it begins.
        std::optional<ContactSize> contact;
        if (options->contact.size > 0 && !options->meeting.empty()) contact.emplace(options->contact, options->meeting);
        if (cubes(box, point, size_at) + (contact ? contact->cubes(box.volume() * unit * unit * unit) : 0) >
            most_elements)
            throw MeshError(options->file, "elements of that size would be more than 2e7: the geometry is " +
                                               std::to_string(diagonal * unit) + " m across");
        const SizeCallback sizes([&](const Vec3& x) {
            const double all = size_at((x - point).norm());
            return (contact ? contact->at(x * unit, all * unit) / unit : all) / factor;
        });
        gmsh::option::setNumber("Mesh.MeshSizeFactor", factor);
        gmsh::option::setNumber("Mesh.MeshSizeMax", size / factor);
        gmsh::option::setNumber("Mesh.MeshSizeMin", options->smallest / unit / factor);
        gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", options->per_circle * factor);
        gmsh::option::setNumber("Mesh.Algorithm", 6);   // frontal Delaunay
        gmsh::option::setNumber("Mesh.Algorithm3D", 1); // Delaunay; HXT works with threads
        gmsh::option::setNumber("Mesh.RandomSeed", 1);
        gmsh::model::mesh::generate(3);
        Model model(options->file, *mesh, unit);
        model.take();
        model.round_points();
        if (options->quadratic) {
            model.add_middle_nodes();
            model.round_points();
        }
    });
}
