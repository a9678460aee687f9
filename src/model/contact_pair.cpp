#include "osculate/model/contact_pair.hpp"

#include "osculate/contact/mortar.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace osculate::model {

namespace {
Vec3 centre(const std::vector<Vec3>& x, const std::vector<Index>& nodes) {
    Vec3 sum = Vec3::Zero();
    for (const Index node : nodes) sum += x[node];
    return sum / static_cast<double>(nodes.size());
}

std::unique_ptr<const contact::Discretisation> make_discretisation(const ContactPair& pair, const std::vector<Vec3>& X,
                                                                   const contact::SmoothSlave* smooth) {
    if (pair.slaves().edges) return contact::make_edge_discretisation(pair.surface(), pair.slaves().edges->meet);
    if (pair.options().discretisation == Discretisation::node) return contact::make_node_discretisation(pair.surface());
    std::map<Index, Index> number;
    std::vector<Vec3> positions;
    for (Index j = 0; j < pair.size(); ++j) {
        number[pair.slaves().node[j]] = j;
        positions.push_back(X[pair.slaves().node[j]]);
    }
    std::vector<contact::SlaveFacet> facets;
    for (const mesh::Facet& facet : pair.slaves().facets) {
        contact::SlaveFacet& own = facets.emplace_back();
        own.count = facet.count;
        for (std::size_t c = 0; c < static_cast<std::size_t>(facet.count); ++c) own.node[c] = number.at(facet.nodes[c]);
    }
    if (pair.options().discretisation == Discretisation::petrov_galerkin)
        return contact::make_petrov_galerkin(pair.surface(), pair.vertices(X), facets, positions,
                                             pair.slaves().in_plane);
    return std::make_unique<contact::Mortar>(pair.surface(), facets, positions, pair.slaves().in_plane, smooth);
}
} // namespace

ContactPair::ContactPair(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                         std::shared_ptr<const MasterSide> master_side, const ContactOptions& options,
                         const contact::SmoothSlave* smooth)
    : name_(std::move(name)), slaves_(std::move(slaves)), side_(std::move(master_side)),
      search_(side_->search(), vertices(X), centre(X, slaves_.node)), options_(options),
      discretisation_(make_discretisation(*this, X, smooth)) {}

ContactPair::ContactPair(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                         std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                         std::shared_ptr<const contact::MasterSurface> master, const ContactOptions& options,
                         const contact::SmoothSlave* smooth)
    : ContactPair(std::move(name), X, std::move(slaves),
                  std::make_shared<const MasterSide>(std::move(surface), std::move(master_nodes), std::move(master)),
                  options, smooth) {}

ContactPair::ContactPair(const ContactPair& other, const ContactOptions& options)
    : name_(other.name_), slaves_(other.slaves_), side_(other.side_), search_(other.search_), options_(options),
      discretisation_(other.discretisation_->clone()) {}

ContactHistory ContactPair::initial_history() const {
    const std::size_t n = slaves_.node.size();
    return {nullptr,
            std::vector<Vec3>(n, Vec3::Zero()),
            std::vector<contact::Status>(n, contact::Status::open),
            std::vector<Index>(n, -1),
            master(),
            {}};
}

std::pair<contact::SharpEdge, contact::SharpEdge> ContactPair::edges(Index j, const std::vector<Vec3>& x,
                                                                     const std::vector<Vec3>& vertices) const {
    const contact::EdgesThatMeet& edge = slaves_.edges->meet[static_cast<std::size_t>(j)];
    const Index first = surface().vertex_count(); // of the numbers of the slave's nodes
    return {contact::slave_edge(j, edge, [&](Index number) -> const Vec3& { return x[node(first + number)]; }),
            contact::sharp_edge(surface(), edge.half_edge, vertices)};
}

ContactHistory opened(std::shared_ptr<const ContactPair> pair) {
    ContactHistory history = pair->initial_history();
    history.pair = std::move(pair);
    return history;
}

} // namespace osculate::model
