#include "multigrid/block_rows.hpp"

#include "osculate/core/error.hpp"

namespace osculate::solve {
namespace {

/// For as much, and for some growth, as bodies touch in other places: memory of other lengths would leave holes behind.
template <class Number> void make_room(std::vector<Number>& list, std::size_t size) {
    constexpr std::size_t spare = 8; // one part in eight more; pages that nobody writes take no memory
    if (list.capacity() >= size) return;
    std::vector<Number>().swap(list);
    list.reserve(size + size / spare);
}

} // namespace

void BlockRows::lay_out(Neighbours neighbours) {
    const auto in_order = [&](std::vector<Index>& list) {
        make_unique(list);
        std::ranges::stable_partition(list, [&](Index number) { return owns(number); });
    };
    for (std::vector<Index>& list : neighbours) in_order(list);
    if (!exchange_->alone()) {
        std::vector<std::vector<Index>> lists(exchange_->ranks());
        for (std::size_t r = 0; r < lists.size(); ++r)
            for (Index a = exchange_->first_from(r); a < exchange_->end_from(r); ++a) {
                lists[r].push_back(static_cast<Index>(neighbours[a].size()));
                lists[r].insert(lists[r].end(), neighbours[a].begin(), neighbours[a].end());
            }
        const auto received = send_to_each(lists);
        of_ranks_.assign(exchange_->ranks(), {});
        for (std::size_t r = 0; r < received.size(); ++r) {
            const Index* from = received[r].data();
            for (const Index a : exchange_->sent_to(r)) {
                of_ranks_[r].emplace_back(from + 1, from + 1 + *from);
                from += 1 + *from;
                neighbours[a].insert(neighbours[a].end(), of_ranks_[r].back().begin(), of_ranks_[r].back().end());
            }
        }
        for (Index a = 0; a < own_; ++a) in_order(neighbours[a]);
    }
    std::array<std::size_t, 2> blocks{}, of_own_rows{};
    for (std::size_t a = 0; a < neighbours.size(); ++a)
        for (const Index number : neighbours[a]) {
            const std::size_t p = owns(number) ? 0 : 1;
            ++blocks[p];
            if (a < static_cast<std::size_t>(own_)) ++of_own_rows[p];
        }
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        parts_[p].start.assign(1, 0);
        parts_[p].row_start.assign(1, 0);
        parts_[p].neighbour.clear();
        parts_[p].column.clear();
        parts_[p].neighbour.reserve(blocks[p]);
        make_room(parts_[p].column, modes * modes * of_own_rows[p]);
    }
    for (std::size_t a = 0; a < neighbours.size(); ++a) {
        const auto middle = std::ranges::partition_point(neighbours[a], [&](Index number) { return owns(number); });
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            Part& part = parts_[p];
            part.neighbour.insert(part.neighbour.end(), p == 0 ? neighbours[a].begin() : middle,
                                  p == 0 ? middle : neighbours[a].end());
            const std::size_t begin = part.start.back();
            part.start.push_back(part.neighbour.size());
            if (a >= static_cast<std::size_t>(own_)) continue;
            for (Index r = 0; r < modes; ++r) {
                for (std::size_t k = begin; k < part.neighbour.size(); ++k)
                    for (Index m = 0; m < modes; ++m)
                        part.column.push_back(modes * (part.neighbour[k] - (p == 0 ? first_number_ : 0)) + m);
                part.row_start.push_back(static_cast<PetscInt>(part.column.size()));
            }
        }
    }
}

void BlockRows::set_zero(Values& values) const {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
        const std::size_t size = modes * modes * parts_[p].neighbour.size();
        make_room(values[p], size);
        values[p].assign(size, 0.0);
    }
}

BlockRows BlockRows::without_columns() const {
    BlockRows rows(*exchange_, own_, first_number_);
    for (std::size_t p = 0; p < parts_.size(); ++p) rows.parts_[p] = {parts_[p].start, parts_[p].neighbour, {}, {}};
    return rows;
}

std::size_t BlockRows::slot(const Part& part, Index row, Index number) {
    const auto begin = part.neighbour.begin() + static_cast<std::ptrdiff_t>(part.start[row]),
               end = part.neighbour.begin() + static_cast<std::ptrdiff_t>(part.start[row + 1]);
    return static_cast<std::size_t>(std::lower_bound(begin, end, number) - part.neighbour.begin());
}

bool BlockRows::has(Index row, Index number) const {
    const Part& part = part_of(number);
    const std::size_t at = slot(part, row, number);
    return at < part.start[row + 1] && part.neighbour[at] == number;
}

void BlockRows::add(Index row, Index number, const Square& block, Values& to) const {
    const Part& part = part_of(number);
    const std::size_t begin = part.start[row], length = modes * (part.start[row + 1] - begin);
    require(has(row, number), "a coarse matrix was asked for a block that its pattern lacks");
    double* first = to[owns(number) ? 0 : 1].data() + modes * (modes * begin + slot(part, row, number) - begin);
    for (Index r = 0; r < modes; ++r, first += length)
        for (Index m = 0; m < modes; ++m) first[m] += block(r, m);
}

void BlockRows::take_from_others(Values& values) const {
    if (exchange_->alone()) return;
    require(of_ranks_.size() == exchange_->ranks(), "a pattern of this process alone has no rows of others");
    std::vector<std::vector<double>> lists(exchange_->ranks());
    for (std::size_t r = 0; r < lists.size(); ++r)
        for (Index a = exchange_->first_from(r); a < exchange_->end_from(r); ++a)
            for_row(a, values, [&](Index, const double* first, std::size_t length) {
                for (Index k = 0; k < modes; ++k, first += length)
                    lists[r].insert(lists[r].end(), first, first + modes);
            });
    const auto received = send_to_each(lists);
    for (std::size_t r = 0; r < received.size(); ++r) {
        const double* from = received[r].data();
        for (std::size_t k = 0; k < of_ranks_[r].size(); ++k)
            for (const Index number : of_ranks_[r][k]) {
                add(exchange_->sent_to(r)[k], number, Eigen::Map<const Square>(from), values);
                from += modes * modes;
            }
    }
}

void BlockRows::mend(Values& values) const {
    constexpr double empty = 1e-14;
    std::vector<double*> diagonal;
    double largest = 0;
    for (Index a = 0; a < own_; ++a) {
        const Index number = first_number_ + a;
        if (!has(a, number)) continue;
        const std::size_t begin = parts_[0].start[a], length = modes * (parts_[0].start[a + 1] - begin);
        double* first = values[0].data() + modes * (modes * begin + slot(parts_[0], a, number) - begin);
        for (Index r = 0; r < modes; ++r, first += length) {
            diagonal.push_back(first + r);
            largest = std::max(largest, first[r]);
        }
    }
    if (!exchange_->alone()) largest = largest_over_ranks(largest);
    for (double* d : diagonal)
        if (*d <= empty * largest) *d += largest;
}

} // namespace osculate::solve
