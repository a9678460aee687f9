#include "multigrid/hubs.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::solve {

Hubs::Hubs(const FreeNodes& nodes, const NodalUnknowns& unknowns) : nodes_(nodes), hubs_(unknowns.hubs) {
    for (const NodalUnknowns::Hub& one : hubs_)
        for (const SparseIndex e : one.equation) {
            column_.push_back(e < 0 ? -1 : size_++);
            if (e >= 0) equation_.push_back(e);
        }
}

Index Hubs::hub(Index node) const {
    const auto at = std::ranges::lower_bound(hubs_, node, {}, &NodalUnknowns::Hub::node);
    return at == hubs_.end() || at->node != node ? -1 : static_cast<Index>(at - hubs_.begin());
}

void Hubs::add(const NodalBlock& block, std::vector<Entry>& B, Matrix& C) const {
    const Index h = hub(block.column);
    if (h < 0) return; // C and B tell what the rows of hubs have elsewhere
    if (const Index i = nodes_.number(block.row); i >= 0 && i < nodes_.size()) {
        B.push_back({i, h, nodes_.projection(i) * block.value * hubs_[h].frame});
        return;
    }
    const Index g = hub(block.row);
    if (g < 0) return;
    const Mat3 local = hubs_[g].frame.transpose() * block.value * hubs_[h].frame;
    for (Index r = 0; r < 3; ++r)
        for (Index c = 0; c < 3; ++c)
            if (const Index to = column_[3 * g + r], from = column_[3 * h + c]; to >= 0 && from >= 0)
                C(to, from) += local(r, c);
}

void Hubs::take(const NodalMatrix& bodies) {
    bodies_.clear();
    C_bodies_.setZero(size_, size_);
    const auto add_row = [&](Index row) {
        for (Index k = bodies.row_start[row]; k < bodies.row_start[row + 1]; ++k)
            add({row, bodies.column[k], bodies.block[k]}, bodies_, C_bodies_);
    };
    for (Index i = 0; i < nodes_.size(); ++i) add_row(nodes_.node(i));
    for (const NodalUnknowns::Hub& one : hubs_) add_row(one.node); // that of another process is empty
    if (nodes_.exchange().alone()) return;
    const std::vector<double> all = sum_over_ranks({C_bodies_.data(), C_bodies_.data() + C_bodies_.size()});
    std::ranges::copy(all, C_bodies_.data());
}

Matrix Hubs::columns(const std::vector<Entry>& B) const {
    Matrix result = Matrix::Zero(3 * nodes_.with_copies(), size_);
    for (const Entry& one : B)
        for (Index c = 0; c < 3; ++c)
            if (const Index column = column_[3 * one.hub + c]; column >= 0)
                result.block<3, 1>(3 * one.node, column) += one.block.col(c);
    return result;
}

Vector Hubs::dots(const Eigen::Ref<const Matrix>& columns, const Eigen::Ref<const Vector>& x) const {
    const Index own = 3 * nodes_.size();
    Vector result = columns.topRows(own).transpose() * x.head(own);
    if (nodes_.exchange().alone()) return result;
    const std::vector<double> all = sum_over_ranks({result.data(), result.data() + result.size()});
    std::ranges::copy(all, result.data());
    return result;
}

void Hubs::solve(const Vector& b, double energy, const Operation& multiply, const Operation& cycle, Vector& w) {
    constexpr Index most = 60;
    constexpr double small = 1e-4; // of the hub's energy: what the last iteration takes from it
    Vector r = b, z(b.size()), p, Ap(b.size());
    w.setZero(b.size());
    for (auto [k, rz] = std::pair(Index{0}, 0.0); k < most; ++k) {
        cycle(r, z);
        ++cycles_;
        const double now = dots(z, r)(0);
        if (!(now > 0)) return;
        p = k == 0 ? z : Vector(z + now / rz * p);
        rz = now;
        multiply(p, Ap);
        const double pAp = dots(p, Ap)(0);
        if (!(pAp > 0)) return; // buckles: what there is serves
        const double step = rz / pAp, won = step * rz;
        w += step * p;
        r -= step * Ap;
        energy -= won;
        if (won <= small * std::abs(energy)) return;
    }
}

FactorStatus Hubs::eliminate(std::span<const NodalBlock> coupling, const Operation& multiply, const Operation& cycle) {
    cycles_ = 0;
    if (size_ == 0) return FactorStatus::ok;
    std::vector<Entry> entries = bodies_;
    Matrix C = C_bodies_;
    for (const NodalBlock& block : coupling) add(block, entries, C);
    const Matrix B = columns(entries);
    W_.setZero(B.rows(), size_);
    Vector w(B.rows()), Aw(B.rows());
    Matrix E = (C + C.transpose()) / 2;
    for (Index q = 0; q < size_; ++q) {
        if (dots(B.col(q), B.col(q))(0) == 0) continue;
        solve(B.col(q), E(q, q), multiply, cycle, w);
        W_.col(q) = w;
    }
    for (Index q = 0; q < size_; ++q) {
        w = W_.col(q);
        multiply(w, Aw);
        E.col(q) += dots(W_, Aw) - dots(W_, B.col(q)) - dots(B, w);
    }
    scale_ = (C.diagonal().cwiseAbs()).cwiseSqrt();
    if (!(scale_.minCoeff() > 0)) return FactorStatus::singular;
    const auto D = scale_.cwiseInverse().asDiagonal();
    E_.compute(D * ((E + E.transpose()) / 2) * D);
    constexpr double loose = 1e-12;
    if (!(E_.eigenvalues().cwiseAbs().minCoeff() > loose * E_.eigenvalues().cwiseAbs().maxCoeff()))
        return FactorStatus::singular;
    return FactorStatus::ok;
}

void Hubs::correct(const double* b, double* x, const Vector& r, Vector& z) const {
    if (size_ == 0) return;
    Vector of_hubs(size_);
    for (Index q = 0; q < size_; ++q) of_hubs(q) = b[equation_[q]];
    of_hubs = (of_hubs - dots(W_, r)).cwiseQuotient(scale_);
    of_hubs = (E_.eigenvectors() * (E_.eigenvectors().transpose() * of_hubs).cwiseQuotient(E_.eigenvalues()))
                  .cwiseQuotient(scale_)
                  .eval();
    const Index own = 3 * nodes_.size();
    z.head(own) -= W_.topRows(own) * of_hubs;
    for (Index q = 0; q < size_; ++q) x[equation_[q]] = of_hubs(q);
}

} // namespace osculate::solve
