#include "app/command/mesh_command.hpp"

#include "app/command/geometry_command.hpp"
#include "app/fault.hpp"
#include "app/plan/mesh_share.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/cad_listing.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <fmt/format.h>
#include <iterator>

namespace osculate::app {

std::string describe_mesh(const MeshCommand& command) {
    try {
        if (mesh::is_cad(command.file)) return describe_geometry(command);
        if (!command.picture.empty())
            throw SceneError({fault("--picture", "a geometry: .step .stp .iges .igs .brep", "'" + command.file + "'")});
        const mesh::RawMesh raw = mesh::read_mesh_file(command.file);
        std::vector<std::string> notes;
        const mesh::Mesh m = mesh::make_mesh(raw, {command.part, command.piece, repairs_of(command.repair)}, &notes);
        fmt::memory_buffer text;
        const auto out = std::back_inserter(text);
        fmt::format_to(out, "{} nodes, {} elements:", m.node_count(), m.element_count());
        for (const mesh::ElementBlock& block : m.blocks)
            fmt::format_to(out, " {} {}", block.size(), mesh::cell_info(block.type).name);
        Eigen::AlignedBox3d box;
        for (const Vec3& x : m.nodes) box.extend(x);
        const auto vector = [](const Vec3& x) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", x[0], x[1], x[2]); };
        fmt::format_to(out, "\nfrom {} to {}\n", vector(box.min()), vector(box.max()));
        for (const auto& [name, cells] : raw.parts) fmt::format_to(out, "part {}: {} elements\n", name, cells.size());
        for (const auto& [name, facets] : m.surfaces) {
            double area = 0;
            for (const mesh::SurfaceFace& face : mesh::surface_faces(m, facets)) area += fe::area(face, m.nodes);
            fmt::format_to(out, "surface {}: {} facets, area {:.6g}\n", name, facets.size(), area);
        }
        for (const auto& [name, nodes] : m.node_sets) fmt::format_to(out, "nodes {}: {}\n", name, nodes.size());
        for (const std::string& note : notes) fmt::format_to(out, "{}\n", note);
        return fmt::to_string(text);
    } catch (const mesh::MeshError& error) {
        throw mesh_faults(error, "mesh");
    }
}

SceneError mesh_faults(const mesh::MeshError& error, const std::string& key) {
    std::vector<Fault> faults;
    for (const std::string& reason : error.reasons()) faults.push_back(fault(key, "a mesh fit for use", reason));
    return SceneError(std::move(faults));
}

} // namespace osculate::app
