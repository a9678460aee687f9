#include "osculate/linear/body_compliance.hpp"

#include <algorithm>

namespace osculate::linear {

BodyCompliance::BodyCompliance(const Constraints& constraints, Index first_node, Index nodes, std::vector<Index> kept,
                               std::vector<Index> sprung)
    : constraints_(constraints), first_node_(first_node), nodes_(nodes), kept_(std::move(kept)),
      sprung_(std::move(sprung)) {
    // equations ascend with the nodes
    first_ = constraints.equations();
    for (Index node = first_node; node < first_node + nodes; ++node)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints.equation(node, k); e != Constraints::held) {
                first_ = std::min(first_, e);
                last_ = e + 1;
            }
    std::vector<solve::SparseIndex> own;
    for (const Index node : kept_)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints.equation(node, k); e != Constraints::held) {
                equations_.push_back(e);
                own.push_back(e - first_);
            }
    solver_ = solve::make_condensing_cholesky(std::move(own));
}

solve::FactorStatus BodyCompliance::factorise(const solve::SparseMatrix& K, double spring) {
    const bool fresh = K_.pattern != K.pattern;
    if (fresh) {
        K_.row_start.assign(1, 0);
        K_.column.clear();
        for (Index e = first_; e < last_; ++e) {
            for (auto k = K.row_start[e]; k < K.row_start[e + 1]; ++k) K_.column.push_back(K.column[k] - first_);
            K_.row_start.push_back(static_cast<solve::SparseIndex>(K_.column.size()));
        }
        K_.symmetric_positive_definite = true;
        K_.pattern = K.pattern;
    }
    if (first_ < last_) K_.value.assign(K.value.begin() + K.row_start[first_], K.value.begin() + K.row_start[last_]);
    for (const Index node : sprung_)
        for (int k = 0; k < 3; ++k)
            if (const Index e = constraints_.equation(node, k); e != Constraints::held) {
                const Index row = e - first_;
                const auto begin = K_.column.begin() + K_.row_start[row],
                           end = K_.column.begin() + K_.row_start[row + 1];
                K_.value[std::lower_bound(begin, end, row) - K_.column.begin()] += spring;
            }
    ++K_.revision;
    const solve::FactorStatus status = solver_->factorise(K_);
    factorised_ = status == solve::FactorStatus::ok;
    spring_ = spring;
    if (factorised_ && !equations_.empty()) W_ = solver_->compliance();
    return status;
}

} // namespace osculate::linear
