#include "osculate/linear/dependence.hpp"

#include <algorithm>

namespace osculate::linear {

void Dependence::set(Index node, std::vector<Carrier> carriers, const Mat3& rests, const Mat3& keeps) {
    Index& place = list_[static_cast<std::size_t>(node)];
    if (place < 0) {
        place = static_cast<Index>(nodes_.size());
        nodes_.push_back(node);
        carriers_.emplace_back();
        rests_.emplace_back();
        keeps_.emplace_back();
    }
    carriers_[static_cast<std::size_t>(place)] = std::move(carriers);
    rests_[static_cast<std::size_t>(place)] = rests;
    keeps_[static_cast<std::size_t>(place)] = keeps;
}

void Dependence::move(Field& du) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        Vec3 moved = keeps_[i] * du[nodes_[i]];
        for (const Carrier& carrier : carriers_[i]) moved += carrier.moves * du[carrier.node];
        du[nodes_[i]] = moved;
    }
}

void Dependence::fold(Field& f) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        for (const Carrier& carrier : carriers_[i]) f[carrier.node] += carrier.loads * f[nodes_[i]];
        f[nodes_[i]] = ((rests_[i] + keeps_[i]) * f[nodes_[i]]).eval();
    }
}

void Dependence::fold_magnitudes(Field& sums) const {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        for (const Carrier& carrier : carriers_[i]) sums[carrier.node] += carrier.loads.cwiseAbs() * sums[nodes_[i]];
        sums[nodes_[i]] = (keeps_[i].cwiseAbs() * sums[nodes_[i]]).eval();
    }
}

bool any_depends(const Dependence& dependence, Index slave, std::span<const Index> masters) {
    return dependence.depends(slave) ||
           std::ranges::any_of(masters, [&](Index node) { return dependence.depends(node); });
}

namespace {
void add_once(std::vector<Index>& list, Index node) {
    if (std::ranges::find(list, node) == list.end()) list.push_back(node);
}
} // namespace

void replace_dependent(const Dependence& dependence, Index slave, std::vector<Index>& masters) {
    std::vector<Index> list;
    std::vector<Index> carriers; // few, where the masters are many
    const auto carry = [&](Index node) {
        for (const Dependence::Carrier& carrier : dependence.carriers(node)) add_once(carriers, carrier.node);
    };
    for (const Index node : masters)
        if (dependence.depends(node)) carry(node);
    for (const Index node : masters)
        if (dependence.owns(node)) list.push_back(node);
    if (dependence.depends(slave)) carry(slave);
    list.insert(list.end(), carriers.begin(), carriers.end());
    masters = std::move(list);
}

FoldedContact::FoldedContact(const Dependence& dependence, Index slave, std::span<const Index> nodes,
                             const Eigen::Ref<const Matrix>& by_A,
                             const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& by_E,
                             const Eigen::Ref<const Matrix>& by_G) {
    const Index n = static_cast<Index>(nodes.size()), m = by_E.rows() / 3;
    for (Index i = 0; i < m; ++i)
        if (dependence.owns(nodes[i])) masters.push_back(nodes[i]); // repeated where the patch repeats it
    const Index own = static_cast<Index>(masters.size());
    std::vector<Index> carriers;
    const auto carry = [&](Index node) {
        for (const Dependence::Carrier& carrier : dependence.carriers(node)) add_once(carriers, carrier.node);
    };
    for (const Index node : nodes)
        if (dependence.depends(node)) carry(node);
    if (dependence.depends(slave)) carry(slave);
    masters.insert(masters.end(), carriers.begin(), carriers.end());
    const Index loaded = static_cast<Index>(masters.size());
    for (Index i = m; i < n; ++i)
        if (dependence.owns(nodes[i])) masters.push_back(nodes[i]);

    // place of each node of the patch, -1 for those without equations of their own
    std::vector<Index> place(static_cast<std::size_t>(n), -1);
    for (Index i = 0, first = 0, rest = loaded; i < n; ++i)
        if (dependence.owns(nodes[i])) place[i] = i < m ? first++ : rest++;
    const auto place_of = [&](Index carrier) {
        return own + static_cast<Index>(std::ranges::find(carriers, carrier) - carriers.begin());
    };
    const auto columns = static_cast<Index>(masters.size());

    // columns
    const auto fold_columns = [&](const Eigen::Ref<const Matrix>& from) {
        Matrix to = Matrix::Zero(from.rows(), 3 + 3 * columns);
        const auto add = [&](Index node, Index at, const auto& block) {
            if (at >= 0) to.middleCols<3>(3 + 3 * at) += block * dependence.keeps(node);
            if (!dependence.depends(node)) return;
            for (const Dependence::Carrier& carrier : dependence.carriers(node))
                to.middleCols<3>(3 + 3 * place_of(carrier.node)) += block * carrier.moves;
        };
        add(slave, -1, from.leftCols<3>());
        to.leftCols<3>() = from.leftCols<3>() * dependence.keeps(slave);
        for (Index i = 0; i < n; ++i) add(nodes[i], place[i], from.middleCols<3>(3 + 3 * i));
        return to;
    };
    A = fold_columns(by_A);

    // rows
    const auto fold_rows = [&](const Matrix& from) {
        Matrix to = Matrix::Zero(3 * loaded, from.cols());
        for (Index i = 0; i < m; ++i) {
            if (place[i] >= 0) to.middleRows<3>(3 * place[i]) += dependence.keeps(nodes[i]) * from.middleRows<3>(3 * i);
            if (!dependence.depends(nodes[i])) continue;
            for (const Dependence::Carrier& carrier : dependence.carriers(nodes[i]))
                to.middleRows<3>(3 * place_of(carrier.node)) += carrier.loads * from.middleRows<3>(3 * i);
        }
        return to;
    };
    E = fold_rows(by_E);
    if (dependence.depends(slave)) // its force, on the left of the equilibrium, as far as others carry it
        for (const Dependence::Carrier& carrier : dependence.carriers(slave))
            E.middleRows<3>(3 * place_of(carrier.node)) -= carrier.loads;
    if (by_G.size() > 0) G = fold_rows(fold_columns(by_G));
}

} // namespace osculate::linear
