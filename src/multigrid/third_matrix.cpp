#include "multigrid/third_matrix.hpp"

#include "multigrid/copied_rows.hpp"
#include "multigrid/petsc_check.hpp"
#include "multigrid/triple_product.hpp"

#include <utility>

namespace osculate::solve {
namespace {

using Row = std::vector<std::pair<Index, BlockRows::Square>>; ///< by numbers of aggregates, ascending

/// Of one aggregate of the grid above.
Row row_of(Mat P, Index number) {
    Row row;
    for (Index r = 0; r < BlockRows::modes; ++r) {
        PetscInt count = 0;
        const PetscInt* column = nullptr;
        const double* value = nullptr;
        check(MatGetRow(P, BlockRows::modes * number + r, &count, &column, &value));
        for (PetscInt k = 0; k < count; ++k) {
            const Index of = column[k] / BlockRows::modes;
            auto at = std::ranges::lower_bound(row, of, {}, [](const auto& entry) { return entry.first; });
            if (at == row.end() || at->first != of) at = row.insert(at, {of, BlockRows::Square::Zero()});
            at->second(r, column[k] % BlockRows::modes) = value[k];
        }
        check(MatRestoreRow(P, BlockRows::modes * number + r, &count, &column, &value));
    }
    return row;
}

/// Of one's own rows, then of copied ones from their owners.
InterpolationRows<BlockRows::Square> rows_with_copies(Mat P, const BlockRows& A, const Exchange& exchange) {
    InterpolationRows<BlockRows::Square> rows;
    for (Index i = 0; i < A.own(); ++i) rows.push_back(row_of(P, A.first_number() + i));
    rows.resize(static_cast<std::size_t>(exchange.end_from(exchange.ranks() - 1)));
    add_copied_rows(exchange, rows);
    return rows;
}

/// First number of each rank's share, from PETSc's ranges of unknowns, and the number of all.
std::vector<Index> firsts(const PetscInt* ranges, std::size_t ranks) {
    std::vector<Index> first;
    for (std::size_t r = 0; r <= ranks; ++r) {
        require(ranges[r] % BlockRows::modes == 0, "grids have six unknowns for each aggregate");
        first.push_back(ranges[r] / BlockRows::modes);
    }
    return first;
}

/// Copies of what others own, whose numbers are ascending.
Exchange exchange_of(const std::vector<Index>& own, const std::vector<Index>& others, const std::vector<Index>& first) {
    std::vector<int> owner;
    for (const Index number : others)
        owner.push_back(static_cast<int>(std::ranges::upper_bound(first, number) - first.begin()) - 1);
    return {own, others, owner};
}

std::vector<Index> numbers(Index first, Index count) {
    std::vector<Index> list;
    for (Index k = 0; k < count; ++k) list.push_back(first + k);
    return list;
}

/// One's own rows of A, in numbers of the interpolation's rows.
struct AggregateRows {
    const BlockRows& A;
    const BlockRows::Values& values;
    const std::vector<Index>& row_of_others;

    [[nodiscard]] Index size() const { return A.own(); }
    void for_row(Index i, auto&& each) const {
        std::size_t k = A.first_of_others(i);
        A.for_row(i, values, [&](Index number, const double* first, std::size_t length) {
            const Index j = A.owns(number) ? number - A.first_number() : row_of_others[k++];
            using Block = Eigen::Map<const BlockRows::Square, Eigen::Unaligned, Eigen::OuterStride<>>;
            each(j, Block(first, Eigen::OuterStride<>(static_cast<std::ptrdiff_t>(length))));
        });
    }
};

} // namespace

AggregateInterpolation::AggregateInterpolation(Mat P, const BlockRows& A) {
    const std::size_t ranks = A.exchange().ranks();
    const PetscInt *rows_of_ranks = nullptr, *columns_of_ranks = nullptr;
    check(MatGetOwnershipRanges(P, &rows_of_ranks));
    check(MatGetOwnershipRangesColumn(P, &columns_of_ranks));
    std::vector<Index> copied(A.of_others().begin(),
                              A.of_others().begin() + static_cast<std::ptrdiff_t>(A.first_of_others(A.own())));
    row_of_others_ = copied;
    make_unique(copied);
    for (Index& row : row_of_others_)
        row = A.own() + static_cast<Index>(std::ranges::lower_bound(copied, row) - copied.begin());
    const std::vector<Row> rows =
        rows_with_copies(P, A, exchange_of(numbers(A.first_number(), A.own()), copied, firsts(rows_of_ranks, ranks)));

    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    const std::vector<Index> first = firsts(columns_of_ranks, ranks);
    first_number_ = first[static_cast<std::size_t>(rank)];
    aggregates_ = first[static_cast<std::size_t>(rank) + 1] - first_number_;
    const auto own = [&](Index number) { return number >= first_number_ && number < first_number_ + aggregates_; };
    std::vector<Index> others;
    for (const Row& row : rows)
        for (const auto& entry : row)
            if (!own(entry.first)) others.push_back(entry.first);
    make_unique(others);
    number_ = numbers(first_number_, aggregates_);
    exchange_ = exchange_of(number_, others, first);
    number_.insert(number_.end(), others.begin(), others.end());
    for (const Row& row : rows) {
        for (const auto& [number, block] : row) {
            aggregate_.push_back(
                own(number)
                    ? number - first_number_
                    : aggregates_ + static_cast<Index>(std::ranges::lower_bound(others, number) - others.begin()));
            block_.push_back(block);
        }
        start_.push_back(static_cast<Index>(aggregate_.size()));
    }
}

ThirdMatrix::ThirdMatrix(Mat P, const BlockRows& A, const BlockRows::Values& values, int threads)
    : A_(A), threads_(threads), P_(P, A), rows_(P_.exchange(), P_.aggregates(), P_.first_number()) {
    rows_.lay_out(neighbours_of_product(AggregateRows{A, values, P_.row_of_others()}, P_));
    take(values);
}

void ThirdMatrix::take(const BlockRows::Values& A) {
    rows_.set_zero(values_);
    add_product(AggregateRows{A_, A, P_.row_of_others()}, P_, threads_, rows_, values_);
    rows_.take_from_others(values_);
    rows_.mend(values_);
}

} // namespace osculate::solve
