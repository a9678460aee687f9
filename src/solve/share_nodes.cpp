#include "osculate/core/error.hpp"
#include "osculate/solve/join_ranks.hpp"

#include <algorithm>
#include <metis.h>
#include <numeric>
#include <utility>

namespace osculate::solve {
namespace {

/// (nodes) numbers from 0 on, the same for nodes that pairs join.
std::vector<Index> groups(std::size_t nodes, std::span<const std::pair<Index, Index>> together) {
    std::vector<Index> first(nodes);
    std::iota(first.begin(), first.end(), 0);
    const auto root = [&](Index i) {
        while (first[i] != i) i = first[i] = first[first[i]];
        return i;
    };
    for (const auto& [a, b] : together) {
        const Index one = root(a), other = root(b);
        first[std::max(one, other)] = std::min(one, other);
    }
    std::vector<Index> number(nodes, -1);
    Index count = 0;
    for (std::size_t i = 0; i < nodes; ++i) { // a root is the first of its group
        const Index own = root(static_cast<Index>(i));
        number[i] = own == static_cast<Index>(i) ? count++ : number[own];
    }
    return number;
}

/// As METIS has it.
struct Graph {
    std::vector<idx_t> start, other, shared, weight; ///< shared: of edges, empty: 1 of each
};

/// (nodes) a node with all its neighbours, where none is in another, and those left over with the neighbour that comes first.
std::vector<idx_t> clusters(const Graph& graph) {
    const std::size_t n = graph.weight.size();
    std::vector<idx_t> cluster(n, -1);
    const auto beside = [&](std::size_t i) {
        return std::span(graph.other)
            .subspan(static_cast<std::size_t>(graph.start[i]),
                     static_cast<std::size_t>(graph.start[i + 1] - graph.start[i]));
    };
    idx_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (cluster[i] >= 0 ||
            std::ranges::any_of(beside(i), [&](idx_t j) { return cluster[static_cast<std::size_t>(j)] >= 0; }))
            continue;
        for (const idx_t j : beside(i)) cluster[static_cast<std::size_t>(j)] = count;
        cluster[i] = count++;
    }
    const std::vector<idx_t> whole = cluster;
    for (std::size_t i = 0; i < n; ++i) {
        for (const idx_t j : beside(i))
            if (cluster[i] < 0) cluster[i] = whole[static_cast<std::size_t>(j)];
        if (cluster[i] < 0) cluster[i] = count++;
    }
    return cluster;
}

/// Of clusters; an edge counts as those that it stands for.
Graph clustered(const Graph& graph, const std::vector<idx_t>& cluster) {
    const auto count = static_cast<std::size_t>(std::ranges::max(cluster)) + 1;
    const Lists members = places_of(cluster, count);
    Graph coarse{{0}, {}, {}, {}};
    std::vector<idx_t> edges(count, 0), beside;
    for (std::size_t c = 0; c < count; ++c) {
        idx_t weight = 0;
        beside.clear();
        for (const Index i : members[c]) {
            weight += graph.weight[i];
            for (idx_t k = graph.start[i]; k < graph.start[i + 1]; ++k) {
                const idx_t d = cluster[static_cast<std::size_t>(graph.other[static_cast<std::size_t>(k)])];
                if (static_cast<std::size_t>(d) != c && edges[static_cast<std::size_t>(d)]++ == 0) beside.push_back(d);
            }
        }
        std::ranges::sort(beside);
        for (const idx_t d : beside) {
            coarse.other.push_back(d);
            coarse.shared.push_back(std::exchange(edges[static_cast<std::size_t>(d)], 0));
        }
        coarse.start.push_back(static_cast<idx_t>(coarse.other.size()));
        coarse.weight.push_back(weight);
    }
    return coarse;
}

std::vector<idx_t> parts_of(Graph graph, int ranks) {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 26;
    // thousandths by which a part may be larger than the mean: the slowest makes all wait
    options[METIS_OPTION_UFACTOR] = 3;
    auto nodes = static_cast<idx_t>(graph.weight.size()), parts = static_cast<idx_t>(ranks);
    idx_t constraints = 1, cut = 0;
    std::vector<idx_t> part(graph.weight.size());
    const int status = METIS_PartGraphKway(
        &nodes, &constraints, graph.start.data(), graph.other.data(), graph.weight.data(), nullptr,
        graph.shared.empty() ? nullptr : graph.shared.data(), &parts, nullptr, nullptr, options, &cut, part.data());
    if (status != METIS_OK) throw RunFailure("METIS could not share the nodes out among " + std::to_string(ranks));
    return part;
}

/// Nodes of a part from which METIS shares out clusters: it takes a tenth of the time, and parts are as even.
constexpr std::size_t large_share = 20000;

} // namespace

std::vector<int> share_nodes(const Lists& neighbours, int ranks, std::span<const std::pair<Index, Index>> together) {
    std::vector<int> owner(neighbours.size(), 0);
    if (ranks == 1 || owner.empty()) return owner;
    const std::vector<Index> group = groups(neighbours.size(), together);
    const Lists members = places_of(group, static_cast<std::size_t>(std::ranges::max(group)) + 1);
    std::vector<idx_t> start{0}, other, weight;
    std::vector<Index> beside;
    for (std::size_t g = 0; g < members.size(); ++g) {
        beside.clear();
        idx_t blocks = 0;
        for (const Index i : members[g]) {
            const std::span<const Index> near = neighbours[static_cast<std::size_t>(i)];
            blocks += static_cast<idx_t>(near.size());
            for (const Index j : near)
                if (group[j] != static_cast<Index>(g)) beside.push_back(group[j]);
        }
        std::ranges::sort(beside);
        other.insert(other.end(), beside.begin(), std::unique(beside.begin(), beside.end()));
        start.push_back(static_cast<idx_t>(other.size()));
        weight.push_back(blocks);
    }
    const Graph graph{std::move(start), std::move(other), {}, std::move(weight)};
    const bool large = graph.weight.size() > large_share * static_cast<std::size_t>(ranks);
    const std::vector<idx_t> cluster = large ? clusters(graph) : std::vector<idx_t>();
    std::vector<idx_t> part = parts_of(large ? clustered(graph, cluster) : graph, ranks);
    if (large) {
        std::vector<idx_t> of_groups;
        for (const idx_t c : cluster) of_groups.push_back(part[static_cast<std::size_t>(c)]);
        part = std::move(of_groups);
    }
    for (std::size_t i = 0; i < owner.size(); ++i)
        owner[i] = static_cast<int>(part[static_cast<std::size_t>(group[i])]);
    return owner;
}

} // namespace osculate::solve
