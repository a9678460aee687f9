#include "osculate/model/contact_pair.hpp"

#include "osculate/contact/mortar.hpp"

#include <algorithm>
#include <limits>
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
                         std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                         std::shared_ptr<const contact::MasterSurface> master, const ContactOptions& options,
                         const contact::SmoothSlave* smooth)
    : name_(std::move(name)), slaves_(std::move(slaves)), surface_(std::move(surface)),
      master_nodes_(std::move(master_nodes)), master_(std::move(master)),
      search_(*surface_, vertices(X), centre(X, slaves_.node)), options_(options),
      discretisation_(make_discretisation(*this, X, smooth)) {
    finest_ = std::numeric_limits<double>::infinity();
    for (Index f = 0; f < surface_->facet_count(); ++f)
        finest_ = std::min({finest_, surface_->facet_size(f), thickness(f)});
    if (master_nodes_.image.empty()) return;
    std::map<Index, Index> own; // node -> vertex
    for (std::size_t v = 0; v < master_nodes_.node.size(); ++v)
        if (master_nodes_.image[v] == 0) own[master_nodes_.node[v]] = static_cast<Index>(v);
    for (const Index node : master_nodes_.node) own_vertex_.push_back(own.at(node));
}

double ContactPair::thickness(Index facet) const {
    double least = std::numeric_limits<double>::infinity();
    if (!master_nodes_.thickness.empty())
        for (const Index v : surface_->facet_vertices(facet)) least = std::min(least, master_nodes_.thickness[v]);
    return least;
}

std::vector<Vec3> ContactPair::vertices(const std::vector<Vec3>& x) const {
    std::vector<Vec3> v(master_nodes_.node.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] = x[master_nodes_.node[i]];
        if (mirrored()) v[i] = image_of(static_cast<Index>(i))(v[i]);
    }
    return v;
}

ContactHistory ContactPair::initial_history() const {
    const std::size_t n = slaves_.node.size();
    return {std::vector<Vec3>(n, Vec3::Zero()), std::vector<contact::Status>(n, contact::Status::open),
            std::vector<Index>(n, -1), master_};
}

} // namespace osculate::model
