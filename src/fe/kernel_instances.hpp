#pragma once
/// Kernels by element, formulation and material: each is compiled once, in src/fe/instances.

#include "osculate/fe/element_block.hpp"

#include <memory>

namespace osculate::fe {

/// @tparam Formulation  of fe/small_strain.hpp
/// @param stiffness     d stress / d strain
template <class Formulation>
[[nodiscard]] std::unique_ptr<ElementKernel> make_small_strain_kernel(const Mat6& stiffness, bool heated);

/// @tparam E               reference element
/// @tparam mean_dilatation see FiniteStrainKernel
template <class E, class Material, bool mean_dilatation>
[[nodiscard]] std::unique_ptr<ElementKernel> make_finite_strain_kernel(const Material& material, bool heated);

} // namespace osculate::fe
