#include "multigrid/coarse_matrix.hpp"

#include "multigrid/triple_product.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

namespace osculate::solve {
namespace {

constexpr Index modes = Prolongation::modes;

/// The finest grid's rows of bodies.
struct NodeRows {
    const FreeNodes& nodes;
    const NodalMatrix& bodies;

    [[nodiscard]] Index size() const { return nodes.size(); }
    void for_row(Index i, auto&& each) const { nodes.for_row(bodies, i, each); }
};

} // namespace

CoarseMatrix::CoarseMatrix(const FreeNodes& nodes, const Prolongation& P, const NodalMatrix& bodies, int threads)
    : nodes_(nodes), P_(P), threads_(threads), rows_(P.exchange(), P.aggregates(), P.first_number()), of_bodies_(rows_),
      more_(static_cast<std::size_t>(P.with_copies())) {
    rows_.lay_out(neighbours_of_product(NodeRows{nodes, bodies}, P));
    of_bodies_ = rows_.without_columns();
    take(bodies);
}

void CoarseMatrix::take(const NodalMatrix& bodies) {
    of_bodies_.set_zero(bodies_);
    add_product(NodeRows{nodes_, bodies}, P_, threads_, of_bodies_, bodies_);
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
    // the pattern depends on this coupling alone, not on those before: PETSc's sums go along patterns
    BlockRows::Neighbours more(static_cast<std::size_t>(P_.with_copies()));
    for_each([&](const Mat3&, Index, Index k, Index, Index n) {
        const Index row = P_.aggregate(k), column = P_.number(P_.aggregate(n));
        std::vector<Index>& list = more[row];
        if ((!list.empty() && list.back() == column) || of_bodies_.has(row, column)) return;
        if (list.size() == list.capacity()) make_unique(list); // many blocks join the same two aggregates
        if (4 * list.size() >= 3 * list.capacity()) list.reserve(2 * list.size() + 8);
        list.push_back(column);
    });
    std::ranges::for_each(more, make_unique);
    bool changed = more != more_;
    if (!P_.exchange().alone()) changed = sum_over_ranks({changed ? 1.0 : 0.0}).front() > 0;
    if (changed) {
        BlockRows::Neighbours of_coupling = more;
        for (Index a = 0; a < of_bodies_.rows(); ++a)
            of_bodies_.for_row(a, bodies_,
                               [&](Index number, const double*, std::size_t) { more[a].push_back(number); });
        rows_.lay_out(std::move(more));
        more_ = std::move(of_coupling);
    }
    rows_.set_zero(values_);
    for (Index a = 0; a < of_bodies_.rows(); ++a)
        of_bodies_.for_row(a, bodies_, [&](Index number, const double* first, std::size_t length) {
            BlockRows::Square block;
            for (Index r = 0; r < modes; ++r, first += length)
                for (Index m = 0; m < modes; ++m) block(r, m) = first[m];
            rows_.add(a, number, block, values_);
        });
    for_each([&](const Mat3& block, Index i, Index k, Index j, Index n) {
        rows_.add(P_.aggregate(k), P_.number(P_.aggregate(n)), P_.block(i, k).transpose() * (block * P_.block(j, n)),
                  values_);
    });
    rows_.take_from_others(values_);
    rows_.mend(values_);
    return changed;
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
        for (Index r = 0; r < modes; ++r) {
            const Index own = body[P_.number(a)];
            const Vec6 motion = R.row(modes * P_.number(a) + r).transpose();
            rows_.for_row(a, values_, [&](Index number, const double* first, std::size_t length) {
                const double* value = first + static_cast<std::size_t>(r) * length;
                for (Index m = 0; m < modes; ++m)
                    force[body[number]] += value[m] * R.row(modes * number + m).transpose();
                if (number == P_.number(a)) diagonal.segment<modes>(modes * own) += value[r] * motion.cwiseAbs2();
            });
            rows_.for_row(a, values_, [&](Index number, const double*, std::size_t) {
                const Index other = body[number];
                energy.block<modes, modes>(modes * own, modes * other) += motion * force[other].transpose();
                force[other].setZero();
            });
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

} // namespace osculate::solve
