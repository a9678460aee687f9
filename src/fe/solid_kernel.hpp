#pragma once
/// What every solid element's kernel shares, whatever its strain and its material: mass, body forces and volume.

#include "osculate/core/error.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/fe/extrapolation.hpp"
#include "osculate/fe/isoparametric_map.hpp"

namespace osculate::fe {

template <ReferenceElement E> class SolidKernel : public ElementKernel {
public:
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;

    [[nodiscard]] int nodes() const final { return n; }
    [[nodiscard]] bool heated() const final { return heated_; }

    void heat(std::span<const double> strain, std::span<double> history) const final {
        require(heated_ && strain.size() == n && history.size() == this->history_size(),
                "heat: sizes do not match the element");
        const std::size_t stride = history.size() / E::points;
        const Eigen::Map<const typename E::Shape> nodal(strain.data());
        for (std::size_t q = 0; q < E::points; ++q) history[q * stride] = table_.N[q].dot(nodal);
    }

    void body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                    Eigen::Ref<Eigen::Matrix3Xd> f) const final {
        require(X.cols() == n && f.cols() == n, "body_force: sizes do not match the element");
        f.noalias() = b * shares(X).transpose();
    }

    void mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const final {
        require(X.cols() == n && Me.rows() == n && Me.cols() == n, "mass: sizes do not match the element");
        Me = rho * unit_mass(X);
    }

    void lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const final {
        require(X.cols() == n && m.size() == n, "lumped_mass: sizes do not match the element");
        if constexpr (E::degree == 1) {
            m = rho * shares(X);
        } else {
            const Eigen::Matrix<double, n, n> M = unit_mass(X);
            m = rho * M.sum() / M.trace() * M.diagonal();
        }
    }

    [[nodiscard]] double volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const final {
        require(X.cols() == n, "volume: sizes do not match the element");
        double sum = 0;
        for (std::size_t q = 0; q < mass_table_.N.size(); ++q) sum += point_volume(X, q);
        return sum;
    }

protected:
    explicit SolidKernel(bool heated) : heated_(heated) {}
    /// The thermal strain at a point: the first of its numbers in a history.
    [[nodiscard]] double thermal_strain(std::span<const double> history, std::size_t q) const {
        return heated_ && !history.empty() ? history[q * (history.size() / E::points)] : 0;
    }

    bool heated_;
    ShapeTable<E> table_{E::quadrature()};
    Eigen::Matrix<double, n, E::points> extrapolation_ = extrapolation<E>();

private:
    /// w det J at a point of the mass rule, m^3.
    [[nodiscard]] double point_volume(const Positions& X, std::size_t q) const {
        return mass_table_.rule[q].weight * jacobian<n>(X, mass_table_.dN[q]).det;
    }

    /// integral of N_a dV, m^3
    [[nodiscard]] typename E::Shape shares(const Positions& X) const {
        typename E::Shape share = E::Shape::Zero();
        for (std::size_t q = 0; q < mass_table_.N.size(); ++q) share += mass_table_.N[q] * point_volume(X, q);
        return share;
    }

    /// integral of N_a N_b dV, m^3
    [[nodiscard]] Eigen::Matrix<double, n, n> unit_mass(const Positions& X) const {
        Eigen::Matrix<double, n, n> M = Eigen::Matrix<double, n, n>::Zero();
        for (std::size_t q = 0; q < mass_table_.N.size(); ++q) {
            const typename E::Shape& N = mass_table_.N[q];
            M.noalias() += (point_volume(X, q) * N) * N.transpose();
        }
        return (M + M.transpose()) / 2;
    }

    ShapeTable<E, std::size_t{E::mass_points}> mass_table_{E::mass_quadrature()};
};

} // namespace osculate::fe
