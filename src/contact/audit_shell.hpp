#pragma once
/// The outer surface of a body, as the audit sees it.

#include "osculate/contact/surface_audit.hpp"

#include <vector>

namespace osculate::contact {

struct SurfaceAudit::Shell {
    struct Edge {
        Index a = -1, b = -1; ///< global nodes
    };
    std::vector<mesh::Facet> facets;
    std::vector<double> size;                    ///< (facets) root of the reference area, m
    std::vector<std::vector<Index>> neighbours;  ///< (facets) across their edges
    std::vector<Edge> edges;                     ///< each once
    std::vector<Index> nodes;                    ///< global
    std::vector<std::vector<Index>> node_facets; ///< (shell nodes)
    std::vector<std::vector<Index>> node_nodes;  ///< (shell nodes) along edges; shell nodes
    std::vector<std::vector<Index>> components;  ///< shell nodes of each connected part

    std::vector<Vec3> drawn; ///< (shell nodes) reference positions from their centre, m
    double finest = 0;       ///< smallest facet, m
    bool sound = false;      ///< does not pass through itself as it is drawn

    Shell(const std::vector<mesh::Facet>& outer, const std::vector<Vec3>& X, std::vector<Index>& shell_node);
    /// How far any node lies from where the rigid motion that fits all nodes best takes it, m.
    [[nodiscard]] double change_of_shape(const std::vector<Vec3>& x) const;

private:
    void find_components();
};

} // namespace osculate::contact
