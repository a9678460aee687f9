#pragma once
/// What inputs that vary all at once have to do with an output.

#include <Eigen/Core>
#include <optional>

namespace osculate::study {

struct Sensitivity {
    /// Standardised regression coefficients: change of the output in its standard deviations for one of an input's.
    Eigen::VectorXd coefficients;
    /// Spearman's rank correlations: 1 or -1 where the output only rises or only falls with the input.
    Eigen::VectorXd rank_correlations;
    double determination = 0; ///< share of the output's variance that the linear regression explains, R^2
};

/// Of samples: a row of `inputs` for each of `outputs` (Saltelli, Chan, Scott, Sensitivity Analysis (2000), chapter 6).
/// No value for fewer than two samples more than inputs, or where an input or the output does not vary.
/// @pre all finite
[[nodiscard]] std::optional<Sensitivity> sensitivity(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& outputs);

} // namespace osculate::study
