#include "multigrid/coarse_matrix.hpp"

#include "osculate/core/parallel.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace osculate::solve {
namespace {

constexpr Index modes = Prolongation::modes;

void make_unique(std::vector<Index>& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

} // namespace

CoarseMatrix::CoarseMatrix(const FreeNodes& nodes, const Prolongation& P, const NodalMatrix& bodies, int threads)
    : nodes_(nodes), P_(P), threads_(threads) {
    // a node's aggregates meet those of its neighbours
    Neighbours neighbours(static_cast<std::size_t>(P.with_copies()));
    std::vector<Index> reached;
    for (Index i = 0; i < nodes.size(); ++i) {
        reached.clear();
        nodes.for_row(bodies, i, [&](Index j, const Mat3&) {
            for (Index k = P.row_begin(j); k < P.row_end(j); ++k) reached.push_back(P.number(P.aggregate(k)));
        });
        make_unique(reached);
        for (Index k = P.row_begin(i); k < P.row_end(i); ++k) {
            std::vector<Index>& list = neighbours[P.aggregate(k)];
            if (std::ranges::includes(list, reached)) continue;
            list.insert(list.end(), reached.begin(), reached.end());
            make_unique(list);
        }
    }
    lay_out(neighbours);
    take(bodies);
}

void CoarseMatrix::lay_out(Neighbours& neighbours) {
    if (const Exchange& exchange = P_.exchange(); !exchange.alone()) {
        std::vector<std::vector<Index>> lists(exchange.ranks());
        for (std::size_t r = 0; r < lists.size(); ++r)
            for (Index a = exchange.first_from(r); a < exchange.end_from(r); ++a) {
                lists[r].push_back(static_cast<Index>(neighbours[a].size()));
                lists[r].insert(lists[r].end(), neighbours[a].begin(), neighbours[a].end());
            }
        const auto received = send_to_each(lists);
        of_others_.assign(exchange.ranks(), {});
        for (std::size_t r = 0; r < received.size(); ++r) {
            const Index* from = received[r].data();
            for (const Index a : exchange.sent_to(r)) {
                of_others_[r].emplace_back(from + 1, from + 1 + *from);
                from += 1 + *from;
                neighbours[a].insert(neighbours[a].end(), of_others_[r].back().begin(), of_others_[r].back().end());
                make_unique(neighbours[a]);
            }
        }
    }
    start_.assign(1, 0);
    neighbour_.clear();
    row_start_.assign(1, 0);
    column_.clear();
    for (const std::vector<Index>& row : neighbours) {
        neighbour_.insert(neighbour_.end(), row.begin(), row.end());
        start_.push_back(neighbour_.size());
        for (Index r = 0; r < modes; ++r) {
            for (const Index a : row)
                for (Index m = 0; m < modes; ++m) column_.push_back(modes * a + m);
            row_start_.push_back(static_cast<PetscInt>(column_.size()));
        }
    }
    bodies_.assign(column_.size(), 0.0);
}

std::size_t CoarseMatrix::slot(Index row, Index column) const {
    const auto begin = neighbour_.begin() + static_cast<std::ptrdiff_t>(start_[row]),
               end = neighbour_.begin() + static_cast<std::ptrdiff_t>(start_[row + 1]);
    return static_cast<std::size_t>(std::lower_bound(begin, end, column) - neighbour_.begin());
}

void CoarseMatrix::add(Index row, std::size_t slot, const Square& block, std::vector<double>& to) const {
    const std::size_t length = modes * (start_[row + 1] - start_[row]);
    double* first = to.data() + modes * modes * start_[row] + modes * (slot - start_[row]);
    for (Index r = 0; r < modes; ++r, first += length)
        for (Index m = 0; m < modes; ++m) first[m] += block(r, m);
}

void CoarseMatrix::take_from_others(std::vector<double>& values) const {
    const Exchange& exchange = P_.exchange();
    if (exchange.alone()) return;
    constexpr std::size_t square = modes * modes;
    std::vector<std::vector<double>> lists(exchange.ranks());
    for (std::size_t r = 0; r < lists.size(); ++r)
        lists[r].assign(values.begin() + static_cast<std::ptrdiff_t>(square * start_[exchange.first_from(r)]),
                        values.begin() + static_cast<std::ptrdiff_t>(square * start_[exchange.end_from(r)]));
    const auto received = send_to_each(lists);
    for (std::size_t r = 0; r < received.size(); ++r) {
        const double* from = received[r].data();
        for (std::size_t k = 0; k < of_others_[r].size(); ++k) {
            const Index row = exchange.sent_to(r)[k];
            const std::vector<Index>& numbers = of_others_[r][k];
            for (std::size_t n = 0; n < numbers.size(); ++n) {
                Square block;
                for (std::size_t c = 0; c < square; ++c)
                    block(static_cast<Index>(c / modes), static_cast<Index>(c % modes)) =
                        from[c / modes * modes * numbers.size() + modes * n + c % modes];
                add(row, slot(row, numbers[n]), block, values);
            }
            from += square * numbers.size();
        }
    }
}

void CoarseMatrix::take(const NodalMatrix& bodies) {
    std::ranges::fill(bodies_, 0.0);
    const Index at_once = 256 * threads_; // rows of A P that are held
    std::vector<Row> rows(static_cast<std::size_t>(std::min(at_once, nodes_.size())));
    for (Index first = 0; first < nodes_.size(); first += at_once) {
        const Index count = std::min(at_once, nodes_.size() - first);
        parallel_for(threads_, count, [&](Index begin, Index end) {
            std::vector<Index> place(static_cast<std::size_t>(P_.with_copies()), -1);
            for (Index n = begin; n < end; ++n) {
                auto& [reached, product] = rows[n];
                reached.clear();
                product.clear();
                nodes_.for_row(bodies, first + n, [&](Index j, const Mat3& block) {
                    for (Index k = P_.row_begin(j); k < P_.row_end(j); ++k) {
                        Index& at = place[P_.aggregate(k)];
                        if (at < 0) {
                            at = static_cast<Index>(reached.size());
                            reached.push_back(P_.aggregate(k));
                            product.emplace_back(Prolongation::Block::Zero());
                        }
                        product[at].noalias() += block * P_.block(j, k);
                    }
                });
                for (const Index a : reached) place[a] = -1;
            }
        });
        parallel_lanes(threads_, [&](Lane lane) {
            for (Index n = 0; n < count; ++n) {
                const Index i = first + n;
                for (Index k = P_.row_begin(i); k < P_.row_end(i); ++k) {
                    const Index row = P_.aggregate(k);
                    if (!lane.owns(row)) continue;
                    const auto transposed = P_.block(i, k).transpose().eval();
                    for (std::size_t m = 0; m < rows[n].reached.size(); ++m)
                        add(row, slot(row, P_.number(rows[n].reached[m])), transposed * rows[n].product[m], bodies_);
                }
            }
        });
    }
}

bool CoarseMatrix::couple(const Coupling& coupling) {
    const auto for_each = [&](auto&& each) {
        for (Index r = 0; r < coupling.rows(); ++r)
            for (Index b = coupling.begin(r); b < coupling.end(r); ++b) {
                const Index i = coupling.row(r), j = coupling.column(b);
                for (Index k = P_.row_begin(i); k < P_.row_end(i); ++k)
                    for (Index n = P_.row_begin(j); n < P_.row_end(j); ++n) each(coupling.block(b), i, k, j, n);
            }
    };
    Neighbours more(static_cast<std::size_t>(P_.with_copies()));
    bool grown = false;
    for_each([&](const Mat3&, Index, Index k, Index, Index n) {
        const Index row = P_.aggregate(k), column = P_.number(P_.aggregate(n));
        if (const std::size_t at = slot(row, column); at < start_[row + 1] && neighbour_[at] == column) return;
        more[row].push_back(column);
        grown = true;
    });
    if (!P_.exchange().alone()) grown = sum_over_ranks({grown ? 1.0 : 0.0}).front() > 0;
    if (grown) {
        const std::vector<std::size_t> start = start_;
        const std::vector<double> values = std::move(bodies_);
        for (Index a = 0; a < P_.with_copies(); ++a) {
            more[a].insert(more[a].end(), neighbour_.begin() + static_cast<std::ptrdiff_t>(start[a]),
                           neighbour_.begin() + static_cast<std::ptrdiff_t>(start[a + 1]));
            make_unique(more[a]);
        }
        const std::vector<Index> old = neighbour_;
        lay_out(more);
        for (Index a = 0; a < P_.with_copies(); ++a)
            for (std::size_t k = start[a]; k < start[a + 1]; ++k) {
                const double* from = values.data() + modes * modes * start[a] + modes * (k - start[a]);
                Square block;
                for (Index r = 0; r < modes; ++r, from += modes * (start[a + 1] - start[a]))
                    for (Index m = 0; m < modes; ++m) block(r, m) = from[m];
                add(a, slot(a, old[k]), block, bodies_);
            }
    }
    value_ = bodies_;
    for_each([&](const Mat3& block, Index i, Index k, Index j, Index n) {
        const Index row = P_.aggregate(k);
        add(row, slot(row, P_.number(P_.aggregate(n))), P_.block(i, k).transpose() * (block * P_.block(j, n)), value_);
    });
    take_from_others(value_);
    mend();
    return grown;
}

bool CoarseMatrix::loose() const {
    constexpr double nothing = 1e-12; // P, in single precision, leaves a motion without strain some 1e-14
    const Matrix& R = P_.near_kernel();
    const std::vector<Index>& body = P_.body();
    const Index bodies = body.empty() ? 0 : *std::ranges::max_element(body) + 1;
    Matrix energy = Matrix::Zero(modes * bodies, modes * bodies);
    Vector diagonal = Vector::Zero(modes * bodies);
    std::vector<Vec6> force(static_cast<std::size_t>(bodies), Vec6::Zero()); // on a row by the motions of each body
    for (Index a = 0; a < P_.aggregates(); ++a)
        for (Index row = modes * a; row < modes * (a + 1); ++row) {
            const Index own = body[P_.number(a)], number = modes * P_.first_number() + row;
            const Vec6 motion = R.row(number).transpose();
            for (PetscInt k = row_start_[row]; k < row_start_[row + 1]; ++k) {
                force[body[column_[k] / modes]] += value_[k] * R.row(column_[k]).transpose();
                if (column_[k] == number) diagonal.segment<modes>(modes * own) += value_[k] * motion.cwiseAbs2();
            }
            for (std::size_t k = start_[a]; k < start_[a + 1]; ++k) {
                const Index other = body[neighbour_[k]];
                energy.block<modes, modes>(modes * own, modes * other) += motion * force[other].transpose();
                force[other].setZero();
            }
        }
    if (!P_.exchange().alone()) {
        const auto add_up = [](auto&& values) {
            const std::vector<double> sum = sum_over_ranks({values.data(), values.data() + values.size()});
            std::ranges::copy(sum, values.data());
        };
        add_up(energy);
        add_up(diagonal);
    }
    const Vector scale = (diagonal.array() > 0).select(diagonal.array().max(1e-300).rsqrt(), 0.0);
    energy = (scale.asDiagonal() * (energy + energy.transpose()) * scale.asDiagonal() / 2).eval();
    for (Index i = 0; i < scale.size(); ++i)
        if (scale(i) == 0) energy(i, i) = 1; // held by supports alone
    return energy.size() > 0 &&
           Eigen::SelfAdjointEigenSolver<Matrix>(energy, Eigen::EigenvaluesOnly).eigenvalues()(0) < nothing;
}

void CoarseMatrix::mend() {
    constexpr double empty = 1e-14;
    std::vector<double*> diagonal;
    double largest = 0;
    for (PetscInt i = 0; i < rows(); ++i)
        for (PetscInt k = row_start_[i]; k < row_start_[i + 1]; ++k)
            if (column_[k] == modes * P_.first_number() + i) {
                diagonal.push_back(&value_[k]);
                largest = std::max(largest, value_[k]);
            }
    if (!P_.exchange().alone()) largest = largest_over_ranks(largest);
    for (double* d : diagonal)
        if (*d <= empty * largest) *d += largest;
}

} // namespace osculate::solve
