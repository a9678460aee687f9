#include "osculate/linear/gathered.hpp"

#include <numeric>

namespace osculate::linear {

BlockMatrix gathered(const BlockMatrix& matrix) {
    constexpr int numbers = 9; // of a block
    const Share& share = *matrix.share();
    const auto ranks = static_cast<std::size_t>(share.ranks().count());
    std::vector<double> own; // of each row: how many blocks, their columns, and they
    for (Index i = 0; i < matrix.rows(); ++i) {
        if (!share.owns(i)) continue;
        own.push_back(matrix.row_end(i) - matrix.row_begin(i));
        for (Index k = matrix.row_begin(i); k < matrix.row_end(i); ++k) own.push_back(matrix.column(k));
        for (Index k = matrix.row_begin(i); k < matrix.row_end(i); ++k)
            own.insert(own.end(), matrix.block(k).data(), matrix.block(k).data() + numbers);
    }
    std::vector<double> length(ranks);
    const auto own_length = static_cast<double>(own.size());
    share.ranks().gather({&own_length, 1}, std::vector<int>(ranks, 1), length.data());
    const std::vector<int> sizes(length.begin(), length.end());
    std::vector<std::size_t> place(ranks + 1, 0); // of the next row of each rank
    std::partial_sum(sizes.begin(), sizes.end(), place.begin() + 1);
    std::vector<double> all(place.back());
    share.ranks().gather(own, sizes, all.data());

    std::vector<std::vector<Index>> columns(static_cast<std::size_t>(matrix.rows()));
    std::vector<const double*> blocks;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::size_t& next = place[static_cast<std::size_t>(share.owner()[i])];
        const double* row = &all[next];
        const auto count = static_cast<std::size_t>(row[0]);
        columns[i].assign(row + 1, row + 1 + count);
        blocks.push_back(row + 1 + count);
        next += 1 + count * (1 + numbers);
    }
    BlockMatrix whole(columns);
    for (Index i = 0; i < whole.rows(); ++i)
        for (Index k = whole.row_begin(i); k < whole.row_end(i); ++k)
            whole.block(k) =
                Eigen::Map<const Mat3>(blocks[static_cast<std::size_t>(i)] + numbers * (k - whole.row_begin(i)));
    return whole;
}

} // namespace osculate::linear
