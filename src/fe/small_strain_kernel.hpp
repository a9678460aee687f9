#pragma once
/// Kernels of small-strain elements, whatever their formulation.

#include "fe/kernel_instances.hpp"
#include "fe/small_strain.hpp"
#include "fe/solid_kernel.hpp"

namespace osculate::fe {

template <class Formulation> class SmallStrainKernel final : public SolidKernel<typename Formulation::Element> {
    using E = typename Formulation::Element;
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;

public:
    explicit SmallStrainKernel(const material::LinearElastic& material) : D_(material.stiffness()), formulation_(D_) {}

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

    [[nodiscard]] bool linear() const override { return true; }

    Deformation energy(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>& u,
                       double& W) const override {
        require(X.cols() == n && u.cols() == n, "energy: sizes do not match the element");
        W = 0;
        StrainPoints<E> points;
        formulation_(this->table_, Positions(X), points);
        const Positions displacement = u;
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            const Vec6 strain = points.B[q] * displacement.reshaped();
            W += strain.dot(D_ * strain) / 2 * points.volumes[q];
        }
        return {};
    }

    Deformation internal_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>& u,
                               Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        require(X.cols() == n && u.cols() == n && f.cols() == n, "internal_force: sizes do not match the element");
        StrainPoints<E> points;
        formulation_(this->table_, Positions(X), points);
        const Positions displacement = u;
        Positions sum = Positions::Zero();
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            const Vec6 sigma = D_ * (points.B[q] * displacement.reshaped());
            sum.reshaped() += points.B[q].transpose() * (sigma * points.volumes[q]);
        }
        f = sum;
        return {};
    }

    Deformation tangent(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>&,
                        Eigen::Ref<Matrix> Ke) const override {
        stiffness(X, Ke);
        return {};
    }

    Deformation step_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>& u0,
                           const Eigen::Ref<const Eigen::Matrix3Xd>& u1, const StepMean& mean,
                           Eigen::Ref<Eigen::Matrix3Xd> f) const override {
        const double w = mean.end_weight;
        const Positions u = w * u1 + (1 - w) * u0 + mean.viscosity * (u1 - u0);
        return internal_force(X, u, f);
    }

    Deformation step_tangent(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>&,
                             const Eigen::Ref<const Eigen::Matrix3Xd>&, const StepMean& mean,
                             Eigen::Ref<Matrix> Ke) const override {
        stiffness(X, Ke);
        Ke *= mean.end_weight + mean.viscosity;
        return {};
    }

    Deformation nodal_stress(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Eigen::Ref<const Eigen::Matrix3Xd>& u,
                             Eigen::Ref<Matrix> stress) const override {
        require(X.cols() == n && u.cols() == n && stress.rows() == 6 && stress.cols() == n,
                "nodal_stress: sizes do not match the element");
        StrainPoints<E> points;
        formulation_(this->table_, Positions(X), points);
        const Positions displacement = u;
        Eigen::Matrix<double, 6, E::points> sigma;
        for (std::size_t q = 0; q < points.B.size(); ++q) {
            sigma.col(static_cast<int>(q)) = D_ * (points.B[q] * displacement.reshaped());
        }
        stress.noalias() = sigma * this->extrapolation_.transpose();
        return {};
    }

private:
    Mat6 D_;
    Formulation formulation_;
};

template <class Formulation>
std::unique_ptr<ElementKernel> make_small_strain_kernel(const material::LinearElastic& material) {
    return std::make_unique<SmallStrainKernel<Formulation>>(material);
}

} // namespace osculate::fe
