#pragma once
/// Kernels of small-strain elements, whatever their formulation.

#include "fe/kernel_instances.hpp"
#include "fe/small_strain.hpp"
#include "fe/solid_kernel.hpp"
#include "osculate/core/error.hpp"

#include <algorithm>

namespace osculate::fe {

template <class Formulation> class SmallStrainKernel final : public SolidKernel<typename Formulation::Element> {
    using E = typename Formulation::Element;
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;

public:
    SmallStrainKernel(const Mat6& stiffness, bool heated) : SolidKernel<E>(heated), D_(stiffness), formulation_(D_) {}

    void stiffness(const Eigen::Ref<const Eigen::Matrix3Xd>& X, Eigen::Ref<Matrix> Ke) const override {
        require(X.cols() == n && Ke.rows() == 3 * n && Ke.cols() == 3 * n, "stiffness: sizes do not match the element");
        StrainPoints<E> points;
        formulation_(this->table_, Positions(X), points);
        Eigen::Matrix<double, 3 * n, 3 * n> K = Eigen::Matrix<double, 3 * n, 3 * n>::Zero();
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            const Eigen::Matrix<double, 6, 3 * n> DB = D_ * points.B[q] * points.volumes[q];
            K.noalias() += points.B[q].transpose() * DB;
        }
        Ke = (K + K.transpose()) / 2;
    }

    [[nodiscard]] bool linear() const override { return !this->heated_; }
    [[nodiscard]] std::size_t history_size() const override { return this->heated_ ? std::size_t{E::points} : 0; }
    [[nodiscard]] bool finite_strain() const override { return false; }

    Deformation energy(const ElementState& state, double& W) const override {
        require(state.X.cols() == n && state.u.cols() == n, "energy: sizes do not match the element");
        W = 0;
        StrainPoints<E> points;
        formulation_(this->table_, Positions(state.X), points);
        const Positions displacement = state.u;
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            const Vec6 strain = elastic(points.B[q] * displacement.reshaped(), state.history, q);
            W += strain.dot(D_ * strain) / 2 * points.volumes[q];
        }
        return {};
    }

    Deformation update(const ElementStep& step, std::span<double> history,
                       Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        require(step.X.cols() == n && step.u.cols() == n && f.cols() == n, "update: sizes do not match the element");
        if (this->heated_) std::ranges::copy(step.history_start, history.begin());
        StrainPoints<E> points;
        formulation_(this->table_, Positions(step.X), points);
        const Positions displacement = felt(step);
        Positions sum = Positions::Zero();
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            const Vec6 sigma = D_ * elastic(points.B[q] * displacement.reshaped(), step.history_start, q);
            sum.reshaped() += points.B[q].transpose() * (sigma * points.volumes[q]);
        }
        f = sum;
        return {};
    }

    Deformation tangent(const ElementStep& step, Eigen::Ref<Matrix> Ke) const override {
        stiffness(step.X, Ke);
        if (step.mean) Ke *= step.mean->end_weight + step.mean->viscosity;
        return {};
    }

    Deformation nodal_stress(const ElementState& state, Eigen::Ref<Matrix> stress) const override {
        require(state.X.cols() == n && state.u.cols() == n && stress.rows() == 6 && stress.cols() == n,
                "nodal_stress: sizes do not match the element");
        StrainPoints<E> points;
        formulation_(this->table_, Positions(state.X), points);
        const Positions displacement = state.u;
        Eigen::Matrix<double, 6, E::points> sigma;
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            sigma.col(static_cast<int>(q)) = D_ * elastic(points.B[q] * displacement.reshaped(), state.history, q);
        }
        stress.noalias() = sigma * this->extrapolation_.transpose();
        return {};
    }

private:
    /// A strain less the thermal one.
    [[nodiscard]] Vec6 elastic(Vec6 strain, std::span<const double> history, std::size_t q) const {
        if (this->heated_) strain.template head<3>().array() -= this->thermal_strain(history, q);
        return strain;
    }
    /// The displacements whose stress acts.
    [[nodiscard]] static Positions felt(const ElementStep& step) {
        if (!step.mean) return step.u;
        require(step.u_start.cols() == n, "update: a mean over a step wants its start");
        const double w = step.mean->end_weight;
        return w * step.u + (1 - w) * step.u_start + step.mean->viscosity * (step.u - step.u_start);
    }

    Mat6 D_;
    Formulation formulation_;
};

template <class Formulation>
std::unique_ptr<ElementKernel> make_small_strain_kernel(const Mat6& stiffness, bool heated) {
    return std::make_unique<SmallStrainKernel<Formulation>>(stiffness, heated);
}

} // namespace osculate::fe
