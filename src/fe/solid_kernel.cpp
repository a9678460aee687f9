#include "fe/solid_kernel.hpp"

#include "osculate/core/error.hpp"
#include "osculate/fe/extrapolation.hpp"

namespace osculate::fe {

template <ReferenceElement E>
SolidKernel<E>::SolidKernel(bool heated)
    : heated_(heated), table_(E::quadrature()), extrapolation_(extrapolation<E>()), mass_table_(E::mass_quadrature()) {}

template <ReferenceElement E>
void SolidKernel<E>::heat(std::span<const double> strain, std::span<double> history) const {
    require(heated_ && strain.size() == n && history.size() == this->history_size(),
            "heat: sizes do not match the element");
    const std::size_t stride = history.size() / E::points;
    const Eigen::Map<const typename E::Shape> nodal(strain.data());
    for (std::size_t q = 0; q < E::points; ++q) history[q * stride] = table_.N[q].dot(nodal);
}

template <ReferenceElement E>
void SolidKernel<E>::body_force(const Eigen::Ref<const Eigen::Matrix3Xd>& X, const Vec3& b,
                                Eigen::Ref<Eigen::Matrix3Xd> f) const {
    require(X.cols() == n && f.cols() == n, "body_force: sizes do not match the element");
    f.noalias() = b * shares(X).transpose();
}

template <ReferenceElement E>
void SolidKernel<E>::mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Matrix> Me) const {
    require(X.cols() == n && Me.rows() == n && Me.cols() == n, "mass: sizes do not match the element");
    Me = rho * unit_mass(X);
}

template <ReferenceElement E>
void SolidKernel<E>::lumped_mass(const Eigen::Ref<const Eigen::Matrix3Xd>& X, double rho, Eigen::Ref<Vector> m) const {
    require(X.cols() == n && m.size() == n, "lumped_mass: sizes do not match the element");
    if constexpr (E::degree == 1) {
        m = rho * shares(X);
    } else {
        const Eigen::Matrix<double, n, n> M = unit_mass(X);
        m = rho * M.sum() / M.trace() * M.diagonal();
    }
}

template <ReferenceElement E> double SolidKernel<E>::volume(const Eigen::Ref<const Eigen::Matrix3Xd>& X) const {
    require(X.cols() == n, "volume: sizes do not match the element");
    double sum = 0;
    for (std::size_t q = 0; q < mass_table_.N.size(); ++q) sum += point_volume(X, q);
    return sum;
}

/// w det J at a point of the mass rule, m^3.
template <ReferenceElement E> double SolidKernel<E>::point_volume(const Positions& X, std::size_t q) const {
    return mass_table_.rule[q].weight * jacobian<n>(X, mass_table_.dN[q]).det;
}

/// integral of N_a dV, m^3
template <ReferenceElement E> typename E::Shape SolidKernel<E>::shares(const Positions& X) const {
    typename E::Shape share = E::Shape::Zero();
    for (std::size_t q = 0; q < mass_table_.N.size(); ++q) share += mass_table_.N[q] * point_volume(X, q);
    return share;
}

/// integral of N_a N_b dV, m^3
template <ReferenceElement E> auto SolidKernel<E>::unit_mass(const Positions& X) const -> Eigen::Matrix<double, n, n> {
    Eigen::Matrix<double, n, n> M = Eigen::Matrix<double, n, n>::Zero();
    for (std::size_t q = 0; q < mass_table_.N.size(); ++q) {
        const typename E::Shape& N = mass_table_.N[q];
        M.noalias() += (point_volume(X, q) * N) * N.transpose();
    }
    return (M + M.transpose()) / 2;
}

template class SolidKernel<Hex8>;
template class SolidKernel<Hex20>;
template class SolidKernel<Hex20Reduced>;
template class SolidKernel<Tet4>;
template class SolidKernel<Tet10>;
template class SolidKernel<Wedge6>;
template class SolidKernel<Wedge15>;

} // namespace osculate::fe
