#pragma once
/// Kernels by element, formulation and material: each is compiled once, in src/fe/instances.

#include "osculate/fe/element_block.hpp"
#include "osculate/fe/reference_element.hpp"

#include <memory>

namespace osculate::fe {

template <ReferenceElement E> struct DisplacementStrain;
struct BBarHex;
struct IncompatibleModesHex;

/// @tparam Formulation  one of these
/// @param stiffness     d stress / d strain
template <class Formulation>
[[nodiscard]] std::unique_ptr<ElementKernel> make_small_strain_kernel(const Mat6& stiffness, bool heated);

/// @tparam E               reference element
/// @tparam mean_dilatation see FiniteStrainKernel
template <class E, class Material, bool mean_dilatation>
[[nodiscard]] std::unique_ptr<ElementKernel> make_finite_strain_kernel(const Material& material, bool heated);

} // namespace osculate::fe
