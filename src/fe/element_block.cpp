#include "osculate/fe/element_block.hpp"

#include "fe/kernel_instances.hpp"
#include "osculate/core/error.hpp"
#include "osculate/fe/with_element.hpp"

#include <stdexcept>
#include <type_traits>

namespace osculate::fe {

namespace {

/// Of shapes that are no hexahedra, formulations of these mean nothing.
template <class E> void refuse(HexFormulation formulation) {
    if (std::is_same_v<E, Hex8> && formulation == HexFormulation::reduced)
        throw std::invalid_argument(
            "reduced is for hex20; a hex8 with one point has no stiffness against hourglass modes");
    if (std::is_same_v<E, Hex20> && formulation != HexFormulation::full && formulation != HexFormulation::reduced)
        throw std::invalid_argument("b_bar and incompatible_modes are for hex8; a hex20 is full or reduced");
}

template <class Material>
std::unique_ptr<ElementKernel> make(mesh::CellType type, HexFormulation formulation, const Material& material,
                                    bool heated) {
    return with_element(type, [&]<class E>() -> std::unique_ptr<ElementKernel> {
        if constexpr (std::is_same_v<E, Hex8>) {
            if (formulation == HexFormulation::incompatible_modes)
                throw std::invalid_argument(
                    "incompatible modes are for small strain; at finite strain use b_bar or full");
            if (formulation == HexFormulation::b_bar)
                return make_finite_strain_kernel<E, Material, true>(material, heated);
        }
        refuse<E>(formulation);
        if constexpr (std::is_same_v<E, Hex20>)
            if (formulation == HexFormulation::reduced)
                return make_finite_strain_kernel<Hex20Reduced, Material, false>(material, heated);
        return make_finite_strain_kernel<E, Material, false>(material, heated);
    });
}

} // namespace

namespace {
std::unique_ptr<ElementKernel> make_linear(mesh::CellType type, HexFormulation formulation, const Mat6& stiffness,
                                           bool heated) {
    return with_element(type, [&]<class E>() -> std::unique_ptr<ElementKernel> {
        if constexpr (std::is_same_v<E, Hex8>) {
            if (formulation == HexFormulation::b_bar) return make_small_strain_kernel<BBarHex>(stiffness, heated);
            if (formulation == HexFormulation::incompatible_modes)
                return make_small_strain_kernel<IncompatibleModesHex>(stiffness, heated);
        }
        refuse<E>(formulation);
        if constexpr (std::is_same_v<E, Hex20>)
            if (formulation == HexFormulation::reduced)
                return make_small_strain_kernel<DisplacementStrain<Hex20Reduced>>(stiffness, heated);
        return make_small_strain_kernel<DisplacementStrain<E>>(stiffness, heated);
    });
}
} // namespace

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::LinearElastic& material, bool heated) {
    return make_linear(type, formulation, material.stiffness(), heated);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::Orthotropic& material, bool heated) {
    return make_linear(type, formulation, material.stiffness(), heated);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::SaintVenantKirchhoff& material, bool heated) {
    return make(type, formulation, material, heated);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::NeoHookean& material, bool heated) {
    return make(type, formulation, material, heated);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::J2Plasticity& material, bool heated) {
    return make(type, formulation, material, heated);
}

} // namespace osculate::fe
