#pragma once
/// Rows of 6 x 6 blocks below the finest grid.

#include "multigrid/exchange.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <petscsystypes.h>
#include <vector>

namespace osculate::solve {

/// A matrix over aggregates, in two parts, both in rows of single entries: columns of one's own aggregates, and of those of other
/// processes. PETSc works on them in place. Behind the rows of one's own aggregates come those of copies, where a process has a
/// part of the sum that their owners take.
class BlockRows {
public:
    static constexpr Index modes = 6; ///< of an aggregate
    using Square = Eigen::Matrix<double, modes, modes, Eigen::RowMajor>;
    using Values = std::array<std::vector<double>, 2>;  ///< of both parts
    using Neighbours = std::vector<std::vector<Index>>; ///< (rows) numbers of aggregates among those of all processes

    /// @param exchange      of aggregates; must outlive this object
    /// @param own           aggregates, numbered from `first_number` on
    BlockRows(const Exchange& exchange, Index own, Index first_number)
        : exchange_(&exchange), own_(own), first_number_(first_number) {}

    /// Makes the pattern, in the memory of the one before, where it is enough.
    /// @param neighbours  in any order, of copies too; one's own get what other processes have for them
    void lay_out(Neighbours neighbours);
    /// In the memory that they have, where it is enough.
    void set_zero(Values& values) const;
    [[nodiscard]] bool has(Index row, Index number) const;
    /// to += block in its place, which there must be
    void add(Index row, Index number, const Square& block, Values& to) const;
    /// Adds what other processes have for one's own rows.
    void take_from_others(Values& values) const;
    /// Unknowns without stiffness, of aggregates with fewer motions than six, get a diagonal for smoothers to divide by.
    void mend(Values& values) const;

    /// The same pattern for values of this process alone: not for PETSc, nor for take_from_others().
    [[nodiscard]] BlockRows without_columns() const;
    [[nodiscard]] Index rows() const { return static_cast<Index>(parts_[0].start.size()) - 1; } ///< with copies
    [[nodiscard]] Index own() const { return own_; }
    [[nodiscard]] Index first_number() const { return first_number_; }
    [[nodiscard]] const Exchange& exchange() const { return *exchange_; }
    [[nodiscard]] bool owns(Index number) const { return number >= first_number_ && number < first_number_ + own_; }
    /// (blocks) of the second part, row by row
    [[nodiscard]] const std::vector<Index>& of_others() const { return parts_[1].neighbour; }
    [[nodiscard]] std::size_t first_of_others(Index row) const { return parts_[1].start[row]; }
    /// Calls each(number, first entry, entries from one of its rows to the next) for the blocks of a row: one's own columns first.
    void for_row(Index row, const Values& values, auto&& each) const {
        for (std::size_t p = 0; p < parts_.size(); ++p) {
            const Part& part = parts_[p];
            const std::size_t begin = part.start[row], end = part.start[row + 1];
            for (std::size_t k = begin; k < end; ++k)
                each(part.neighbour[k], values[p].data() + modes * (modes * begin + k - begin), modes * (end - begin));
        }
    }

    /// For PETSc, of one's own rows: columns of the first part count from one's own first, those of the second among all. It
    /// renumbers the second.
    [[nodiscard]] PetscInt* row_start(std::size_t part) { return parts_[part].row_start.data(); }
    [[nodiscard]] PetscInt* column(std::size_t part) { return parts_[part].column.data(); }

private:
    struct Part {
        std::vector<std::size_t> start; ///< (rows + 1) of blocks
        std::vector<Index> neighbour;   ///< (blocks) ascending in a row
        std::vector<PetscInt> row_start, column;
    };
    [[nodiscard]] const Part& part_of(Index number) const { return parts_[owns(number) ? 0 : 1]; }
    /// Position of a block in its part.
    [[nodiscard]] static std::size_t slot(const Part& part, Index row, Index number);

    const Exchange* exchange_;
    Index own_, first_number_;
    std::array<Part, 2> parts_;
    std::vector<Neighbours> of_ranks_; ///< (ranks) what each has for the rows that it copies, as it sends them
};

} // namespace osculate::solve
