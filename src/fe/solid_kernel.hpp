#pragma once
/// What every solid element's kernel shares, whatever its strain and its material: mass, body forces and volume.

#include "osculate/fe/element_block.hpp"
#include "osculate/fe/isoparametric_map.hpp"

namespace osculate::fe {

/// Compiled once for each element, in solid_kernel.cpp.
template <ReferenceElement E> class SolidKernel : public ElementKernel {
public:
    static constexpr int n = E::nodes;
    using Positions = Eigen::Matrix<double, 3, n>;

    [[nodiscard]] int nodes() const final { return n; }
    [[nodiscard]] bool heated() const final { return heated_; }
    void heat(std::span<const double> strain, std::span<double> history) const final;
    void body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                    Eigen::Ref<Eigen::Matrix3Xd> f) const final;
    void mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const final;
    void lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const final;
    [[nodiscard]] double volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const final;

protected:
    explicit SolidKernel(bool heated);
    /// The thermal strain at a point: the first of its numbers in a history.
    [[nodiscard]] double thermal_strain(std::span<const double> history, std::size_t q) const {
        return heated_ && !history.empty() ? history[q * (history.size() / E::points)] : 0;
    }

    bool heated_;
    ShapeTable<E> table_;
    Eigen::Matrix<double, n, E::points> extrapolation_; ///< from the points to the nodes

private:
    [[nodiscard]] double point_volume(const Positions& X, std::size_t q) const;
    [[nodiscard]] typename E::Shape shares(const Positions& X) const;
    [[nodiscard]] auto unit_mass(const Positions& X) const -> Eigen::Matrix<double, n, n>;

    ShapeTable<E, std::size_t{E::mass_points}> mass_table_;
};

} // namespace osculate::fe
