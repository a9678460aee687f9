#include "osculate/study/sensitivity.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace osculate::study {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Mean 0 and norm 1; zero where the values differ by no more than round-off.
VectorXd standardised(const VectorXd& values) {
    const VectorXd centred = values.array() - values.mean();
    constexpr double round_off = 1e-12;
    if (centred.lpNorm<Eigen::Infinity>() <= round_off * values.lpNorm<Eigen::Infinity>())
        return VectorXd::Zero(values.size());
    const VectorXd scaled = centred / centred.lpNorm<Eigen::Infinity>(); // squares of large numbers overflow
    return scaled.normalized();
}

/// Place of each value among all; equal values share the mean of theirs.
VectorXd ranks(const VectorXd& values) {
    std::vector<Index> order(static_cast<std::size_t>(values.size()));
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [&](Index i) { return values[i]; });
    VectorXd result(values.size());
    for (std::size_t first = 0; first < order.size();) {
        std::size_t end = first;
        while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
        for (std::size_t i = first; i < end; ++i) result[order[i]] = 0.5 * static_cast<double>(first + end - 1);
        first = end;
    }
    return result;
}

} // namespace

std::optional<Sensitivity> sensitivity(const Eigen::MatrixXd& inputs, const VectorXd& outputs) {
    const Index variables = inputs.cols();
    if (variables == 0 || inputs.rows() < variables + 2) return std::nullopt;
    const VectorXd output = standardised(outputs);
    if (output.isZero(0)) return std::nullopt;
    Eigen::MatrixXd x(inputs.rows(), variables);
    for (Index v = 0; v < variables; ++v) {
        x.col(v) = standardised(inputs.col(v));
        if (x.col(v).isZero(0)) return std::nullopt;
    }
    Sensitivity result;
    result.coefficients = x.colPivHouseholderQr().solve(output);
    result.determination = 1 - (output - x * result.coefficients).squaredNorm();
    const VectorXd rank = standardised(ranks(outputs));
    result.rank_correlations.resize(variables);
    for (Index v = 0; v < variables; ++v) result.rank_correlations[v] = standardised(ranks(inputs.col(v))).dot(rank);
    return result;
}

} // namespace osculate::study
