#include "osculate/linear/system_matrix.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>
#include <atomic>

namespace osculate::linear {

namespace {
std::uint64_t next_pattern() {
    static std::atomic<std::uint64_t> counter{0}; // names a pattern; results never depend on its value
    return ++counter;
}
constexpr Index absent = -1;

std::vector<Index> slaves_of(const std::vector<Coupling>& couplings) {
    std::vector<Index> slaves;
    for (const Coupling& c : couplings) slaves.push_back(c.slave);
    return slaves;
}
} // namespace

SystemMatrix::SystemMatrix(const Constraints& constraints, const BlockMatrix& K, std::vector<Coupling> couplings)
    : constraints_(&constraints), K_(&K), couplings_(std::move(couplings)),
      unknowns_(constraints, slaves_of(couplings_)) {
    Index unknown = 0;
    for (Index node = 0; node < constraints.nodes(); ++node) {
        first_.push_back(unknown);
        unknown += constraints.free_components(node);
    }
    for (std::size_t j = 0; j <= couplings_.size(); ++j) first_.push_back(unknown + 3 * static_cast<Index>(j));
    for (Index node = 0; node < constraints.nodes(); ++node)
        plain_.push_back(constraints.free_components(node) == 3 && !constraints.turned(node));
    matrix_.symmetric_positive_definite = couplings_.empty();
    build_pattern();
    map_slots();
    fill_base();
    matrix_.pattern = next_pattern();
    matrix_.value = base_;
}

Index SystemMatrix::first_unknown(Index block) const {
    return first_[block];
}
Index SystemMatrix::width(Index block) const {
    return first_[block + 1] - first_[block];
}

Index SystemMatrix::equilibrium_block(Index node) const {
    return unknowns_.exchanged(node) < 0 ? node : constraints_->nodes() + unknowns_.exchanged(node);
}

const Mat3& SystemMatrix::frame(Index block) const {
    const Index node = block < constraints_->nodes() ? block : couplings_[block - constraints_->nodes()].slave;
    return constraints_->frame(node);
}

std::array<Index, 3> SystemMatrix::equilibrium_rows(Index node) const {
    return {unknowns_.equilibrium_row(node, 0), unknowns_.equilibrium_row(node, 1), unknowns_.equilibrium_row(node, 2)};
}

std::array<Index, 3> SystemMatrix::contact_rows(Index j) const {
    return {unknowns_.contact_row(j, 0), unknowns_.contact_row(j, 1), unknowns_.contact_row(j, 2)};
}

bool SystemMatrix::covers(Index j, std::span<const Index> masters) const {
    const auto& known = couplings_[j].masters;
    return std::all_of(masters.begin(), masters.end(),
                       [&](Index node) { return std::binary_search(known.begin(), known.end(), node); });
}

void SystemMatrix::build_pattern() {
    const Index nodes = constraints_->nodes(), blocks = nodes + static_cast<Index>(couplings_.size());
    std::vector<std::vector<Index>> couplings_of(
        static_cast<std::size_t>(blocks)); // row block -> couplings it sees whole
    for (Index j = 0; j < static_cast<Index>(couplings_.size()); ++j) {
        const Coupling& c = couplings_[j];
        // contact rows: with the slave's free components, and with the multiplier where any is held or taken
        const bool exchanged = unknowns_.exchanged(c.slave) == j;
        if (exchanged) couplings_of[c.slave].push_back(j);
        if (!exchanged || constraints_->free_components(c.slave) < 3) couplings_of[nodes + j].push_back(j);
        for (const Index master : c.masters) couplings_of[equilibrium_block(master)].push_back(j);
    }
    std::vector<std::vector<Index>> columns(static_cast<std::size_t>(blocks));
    for (Index node = 0; node < nodes; ++node) {
        auto& row = columns[equilibrium_block(node)];
        for (Index k = K_->row_begin(node); k < K_->row_end(node); ++k) row.push_back(K_->column(k));
    }
    for (Index j = 0; j < static_cast<Index>(couplings_.size()); ++j) {
        columns[nodes + j].push_back(nodes + j);
        columns[equilibrium_block(couplings_[j].slave)].push_back(nodes + j); // the force itself
    }
    std::vector<Index> seen(static_cast<std::size_t>(blocks), -1); // last row that has the column
    for (Index block = 0; block < blocks; ++block) {
        auto& row = columns[block];
        for (const Index column : row) seen[column] = block;
        const auto add = [&](Index column) {
            if (seen[column] == block) return;
            seen[column] = block;
            row.push_back(column);
        };
        for (const Index j : couplings_of[block]) {
            add(couplings_[j].slave);
            add(nodes + j);
            for (const Index master : couplings_[j].masters) add(master);
        }
    }

    matrix_.row_start.assign(1, 0);
    for (Index block = 0; block < blocks; ++block) {
        auto& row = columns[block];
        std::sort(row.begin(), row.end());
        row.erase(std::unique(row.begin(), row.end()), row.end());
        Index offset_in_row = 0;
        for (const Index column : row) {
            block_column_.push_back(column);
            block_offset_.push_back(offset_in_row);
            offset_in_row += width(column);
        }
        block_row_start_.push_back(static_cast<Index>(block_column_.size()));
        for (Index r = 0; r < width(block); ++r) {
            for (const Index column : row)
                for (Index c = 0; c < width(column); ++c) matrix_.column.push_back(first_unknown(column) + c);
            matrix_.row_start.push_back(static_cast<solve::SparseIndex>(matrix_.column.size()));
        }
        std::vector<Index>().swap(row);
    }
}

Index SystemMatrix::offset(Index row_block, Index column_block) const {
    const auto begin = block_column_.begin() + block_row_start_[row_block];
    const auto end = block_column_.begin() + block_row_start_[row_block + 1];
    const auto found = std::lower_bound(begin, end, column_block);
    return found == end || *found != column_block ? absent : block_offset_[found - block_column_.begin()];
}

void SystemMatrix::add(const std::array<Index, 3>& rows, Index offset_in_row, Index column_block, const Mat3& value,
                       std::vector<double>& into) const {
    const bool node = column_block < constraints_->nodes();
    const Index first = first_unknown(column_block);
    for (int c = 0; c < 3; ++c) {
        const Index unknown = node ? constraints_->equation(column_block, c) : first + c;
        if (unknown == Constraints::held) continue;
        for (int r = 0; r < 3; ++r)
            if (rows[r] != Constraints::held)
                into[matrix_.row_start[rows[r]] + offset_in_row + (unknown - first)] += value(r, c);
    }
}

void SystemMatrix::fill_base() {
    base_.assign(matrix_.column.size(), 0.0);
    for (Index node = 0; node < constraints_->nodes(); ++node) {
        const auto rows = equilibrium_rows(node);
        const Index row_block = equilibrium_block(node);
        for (Index k = K_->row_begin(node); k < K_->row_end(node); ++k) {
            const Index column = K_->column(k);
            Mat3 value = K_->block(k);
            if (constraints_->turned(node)) value = constraints_->frame(node).transpose() * value;
            if (constraints_->turned(column)) value = value * constraints_->frame(column);
            add(rows, offset(row_block, column), column, value, base_);
        }
    }
    for (Index j = 0; j < static_cast<Index>(couplings_.size()); ++j) {
        const Index block = constraints_->nodes() + j, slave = couplings_[j].slave;
        add(equilibrium_rows(slave), offset(equilibrium_block(slave), block), block, -Mat3::Identity(), base_);
    }
}

void SystemMatrix::map_slots() {
    slots_.resize(couplings_.size());
    for (Index j = 0; j < static_cast<Index>(couplings_.size()); ++j) {
        const Coupling& c = couplings_[j];
        const Index multiplier_block = constraints_->nodes() + j;
        const bool exchanged = unknowns_.exchanged(c.slave) == j;
        auto& table = slots_[j];
        table.reserve((c.masters.size() + 1) * (c.masters.size() + 2));
        const auto map_row = [&](Index row) {
            table.push_back(offset(row, c.slave));
            Index k = block_row_start_[row]; // both lists ascend
            for (const Index master : c.masters) {
                while (k < block_row_start_[row + 1] && block_column_[k] < master) ++k;
                const bool there = k < block_row_start_[row + 1] && block_column_[k] == master;
                table.push_back(there ? block_offset_[k] : absent);
            }
            table.push_back(offset(row, multiplier_block));
        };
        // row 0: contact rows in the slave's own block; rows 1..n: equilibrium of the masters
        map_row(exchanged ? c.slave : multiplier_block);
        for (const Index master : c.masters) map_row(equilibrium_block(master));
    }
}

void SystemMatrix::stiffness_changed() {
    fill_base();
    reset();
    finish();
}

void SystemMatrix::reset() {
    matrix_.value = base_;
}

void SystemMatrix::add_contact(Index j, const Mat3& D, Lane lane) {
    if (!lane.owns(couplings_[j].slave)) return;
    const Mat3& Q = frame(couplings_[j].slave);
    const Mat3 value = Q.transpose() * D * Q;
    const auto rows = contact_rows(j);
    const Index block = constraints_->nodes() + j;
    for (int r = 0; r < 3; ++r) { // rows of one contact law may live in two blocks
        std::array<Index, 3> one{Constraints::held, Constraints::held, Constraints::held};
        one[r] = rows[r];
        const Index row_block = rows[r] < constraints_->equations() ? couplings_[j].slave : block;
        add(one, offset(row_block, block), block, value, matrix_.value);
    }
}

void SystemMatrix::add_contact(Index j, std::span<const Index> masters, const Eigen::Ref<const Matrix>& A,
                               const Mat3& D, const Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, 3>>& E,
                               const Eigen::Ref<const Matrix>& G, Lane lane) {
    const Coupling& coupling = couplings_[j];
    const Index n = static_cast<Index>(masters.size()), block = constraints_->nodes() + j;
    const auto stride = static_cast<Index>(coupling.masters.size()) + 2;
    std::vector<Index> place(masters.size()); // position of each patch node in the pattern's list
    for (Index i = 0; i < n; ++i)
        place[i] = static_cast<Index>(std::lower_bound(coupling.masters.begin(), coupling.masters.end(), masters[i]) -
                                      coupling.masters.begin());

    const auto turn = [&](Index node, const Mat3& value, Index column) -> Mat3 {
        Mat3 local = value;
        if (constraints_->turned(node)) local = constraints_->frame(node).transpose() * local;
        if (constraints_->turned(column)) local = local * constraints_->frame(column);
        return local;
    };

    // contact law
    const auto rows = contact_rows(j);
    const bool one_block =
        unknowns_.exchanged(coupling.slave) != j || constraints_->free_components(coupling.slave) == 3;
    const auto add_law = [&](Index slot_column, Index column_block, const Mat3& value) {
        if (one_block) return add(rows, slots_[j][slot_column], column_block, value, matrix_.value);
        for (int r = 0; r < 3; ++r) {
            std::array<Index, 3> one{Constraints::held, Constraints::held, Constraints::held};
            one[r] = rows[r];
            const Index row_block = rows[r] < constraints_->equations() ? coupling.slave : block;
            add(one, offset(row_block, column_block), column_block, value, matrix_.value);
        }
    };
    if (lane.owns(coupling.slave)) {
        add_law(0, coupling.slave, turn(coupling.slave, A.leftCols<3>(), coupling.slave));
        for (Index i = 0; i < n; ++i)
            add_law(1 + place[i], masters[i], turn(coupling.slave, A.middleCols<3>(3 + 3 * i), masters[i]));
        add_law(stride - 1, block, turn(coupling.slave, D, coupling.slave));
    }

    // master forces, on the first of the nodes
    for (Index i = 0; i < E.rows() / 3; ++i) {
        if (!lane.owns(masters[i])) continue;
        const auto master_rows = equilibrium_rows(masters[i]);
        const Index* slot = slots_[j].data() + (1 + place[i]) * stride;
        const auto by = [&](Index k) -> Mat3 { return G.block<3, 3>(3 * i, 3 * k); };
        add(master_rows, slot[0], coupling.slave, turn(masters[i], by(0), coupling.slave), matrix_.value);
        for (Index k = 0; k < n; ++k) {
            if (plain_[masters[i]] == 0 || plain_[masters[k]] == 0) {
                add(master_rows, slot[1 + place[k]], masters[k], turn(masters[i], by(1 + k), masters[k]),
                    matrix_.value);
                continue;
            }
            const double* from = G.data() + 3 * i + (3 + 3 * k) * G.outerStride();
            for (int r = 0; r < 3; ++r) {
                double* to = &matrix_.value[matrix_.row_start[master_rows[r]] + slot[1 + place[k]]];
                for (int c = 0; c < 3; ++c) to[c] += from[r + c * G.outerStride()];
            }
        }
        add(master_rows, slot[stride - 1], block, turn(masters[i], E.middleRows<3>(3 * i), coupling.slave),
            matrix_.value);
    }
}

} // namespace osculate::linear
