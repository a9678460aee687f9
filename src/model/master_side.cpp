#include "osculate/model/master_side.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace osculate::model {

MasterSide::MasterSide(std::unique_ptr<const mesh::HalfEdgeSurface> surface, MasterNodes nodes,
                       std::shared_ptr<const contact::MasterSurface> shape)
    : surface_(std::move(surface)), nodes_(std::move(nodes)), shape_(std::move(shape)), search_(*surface_),
      finest_(std::numeric_limits<double>::infinity()) {
    for (Index f = 0; f < surface_->facet_count(); ++f)
        finest_ = std::min({finest_, surface_->facet_size(f), thickness(f)});
    if (nodes_.image.empty()) return;
    std::map<Index, Index> own; // node -> vertex
    for (std::size_t v = 0; v < nodes_.node.size(); ++v)
        if (nodes_.image[v] == 0) own[nodes_.node[v]] = static_cast<Index>(v);
    for (const Index node : nodes_.node) own_vertex_.push_back(own.at(node));
}

double MasterSide::thickness(Index facet) const {
    double least = std::numeric_limits<double>::infinity();
    if (!nodes_.thickness.empty())
        for (const Index v : surface_->facet_vertices(facet)) least = std::min(least, nodes_.thickness[v]);
    return least;
}

std::vector<Vec3> MasterSide::vertices(const std::vector<Vec3>& x) const {
    std::vector<Vec3> v(nodes_.node.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
        v[i] = x[nodes_.node[i]];
        if (mirrored()) v[i] = image_of(static_cast<Index>(i))(v[i]);
    }
    return v;
}

} // namespace osculate::model
