#include "osculate/core/ranks.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

namespace osculate {

Share::Share(std::shared_ptr<Ranks> ranks, std::vector<int> owner)
    : ranks_(std::move(ranks)), owner_(std::move(owner)), by_owner_(owner_.size()),
      begin_(static_cast<std::size_t>(ranks_->count()) + 1, 0) {
    std::iota(by_owner_.begin(), by_owner_.end(), 0);
    std::ranges::stable_sort(by_owner_, {}, [&](Index node) { return owner_[static_cast<std::size_t>(node)]; });
    for (const int rank : owner_) ++begin_[static_cast<std::size_t>(rank) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
}

template <class Each> void Share::for_each(const std::vector<Vec3>& own, Each&& each) const {
    std::vector<int> sizes;
    for (std::size_t r = 0; r + 1 < begin_.size(); ++r) sizes.push_back(3 * (begin_[r + 1] - begin_[r]));
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    const double* first = own.empty() ? nullptr : own.front().data();
    ranks_->gather_in_turns({first, 3 * own.size()}, sizes, [&](int rank, const double* numbers) {
        for (const Index node : nodes_of(rank)) {
            each(static_cast<std::size_t>(node), Eigen::Map<const Vec3>(numbers));
            numbers += 3;
        }
    });
}

void Share::replicate(Field& field) const {
    std::vector<Vec3> own;
    own.reserve(nodes_of(ranks_->rank()).size());
    for (const Index node : nodes_of(ranks_->rank())) own.push_back(field[static_cast<std::size_t>(node)]);
    for_each(own, [&](std::size_t node, const auto& value) { field[node] = value; });
}

void Share::add(const std::vector<Vec3>& own, Field& field) const {
    for_each(own, [&](std::size_t node, const auto& value) { field[node] += value; });
}

bool Share::agree(const Field& field) const {
    std::uint64_t hash = 14695981039346656037U; // Fowler, Noll and Vo's
    for (const Vec3& value : field)
        for (const double component : value) hash = (hash ^ std::bit_cast<std::uint64_t>(component)) * 1099511628211U;
    for (const std::uint64_t half : {hash >> 32U, hash & 0xffffffffU}) { // exact as a number
        const auto own = static_cast<double>(half);
        if (ranks_->largest(own) != -ranks_->largest(-own)) return false;
    }
    return true;
}

void Ranks::gather_in_turns(std::span<const double> own, std::span<const int> sizes,
                            const std::function<void(int rank, const double* numbers)>& each, std::size_t most) {
    for (std::size_t begin = 0, end = 0; begin < sizes.size(); begin = end) {
        std::vector<int> now(sizes.size(), 0);
        std::size_t numbers = 0;
        while (end < sizes.size() && (end == begin || numbers + static_cast<std::size_t>(sizes[end]) <= most)) {
            now[end] = sizes[end];
            numbers += static_cast<std::size_t>(sizes[end++]);
        }
        some_.resize(numbers);
        const auto self = static_cast<std::size_t>(rank());
        gather(self >= begin && self < end ? own : std::span<const double>(), now, some_.data());
        const double* first = some_.data();
        for (std::size_t r = begin; r < end; first += sizes[r++]) each(static_cast<int>(r), first);
    }
}

void Ranks::sum(std::span<double> values) {
    const auto n = values.size(), ranks = static_cast<std::size_t>(count());
    std::vector<double> all(n * ranks);
    const std::vector<int> sizes(ranks, static_cast<int>(n));
    gather(values, sizes, all.data());
    for (std::size_t k = 0; k < n; ++k) {
        values[k] = all[k];
        for (std::size_t r = 1; r < ranks; ++r) values[k] += all[r * n + k];
    }
}

std::string Ranks::said_by(int rank, const std::string& own) {
    const std::string text = this->rank() == rank ? own : std::string();
    std::vector<int> sizes(static_cast<std::size_t>(count()), 0);
    sizes[static_cast<std::size_t>(rank)] = static_cast<int>(largest(static_cast<double>(text.size())));
    std::vector<double> all(static_cast<std::size_t>(sizes[static_cast<std::size_t>(rank)]));
    gather(std::vector<double>(text.begin(), text.end()), sizes, all.data());
    std::string heard;
    for (const double letter : all) heard.push_back(static_cast<char>(letter));
    return heard;
}

double Ranks::largest(double own) {
    std::vector<double> all(static_cast<std::size_t>(count()));
    const std::vector<int> sizes(all.size(), 1);
    gather({&own, 1}, sizes, all.data());
    return *std::ranges::max_element(all);
}

} // namespace osculate
