#include "osculate/fe/element_block.hpp"

#include "fe/kernel_instances.hpp"
#include "fe/small_strain.hpp"
#include "osculate/core/error.hpp"

#include <stdexcept>

namespace osculate::fe {

namespace {

template <class Material>
std::unique_ptr<ElementKernel> make(mesh::CellType type, HexFormulation formulation, const Material& material) {
    switch (type) {
    case mesh::CellType::tet4: return make_finite_strain_kernel<Tet4, Material, false>(material);
    case mesh::CellType::wedge6: return make_finite_strain_kernel<Wedge6, Material, false>(material);
    case mesh::CellType::tet10: return make_finite_strain_kernel<Tet10, Material, false>(material);
    case mesh::CellType::hex8:
        switch (formulation) {
        case HexFormulation::full: return make_finite_strain_kernel<Hex8, Material, false>(material);
        case HexFormulation::b_bar: return make_finite_strain_kernel<Hex8, Material, true>(material);
        case HexFormulation::incompatible_modes:
            throw std::invalid_argument("incompatible modes are for small strain; at finite strain use b_bar or full");
        }
    }
    throw InternalError("make_kernel: unknown cell type or formulation");
}

} // namespace

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::LinearElastic& material) {
    switch (type) {
    case mesh::CellType::tet4: return make_small_strain_kernel<DisplacementStrain<Tet4>>(material);
    case mesh::CellType::wedge6: return make_small_strain_kernel<DisplacementStrain<Wedge6>>(material);
    case mesh::CellType::tet10: return make_small_strain_kernel<DisplacementStrain<Tet10>>(material);
    case mesh::CellType::hex8:
        switch (formulation) {
        case HexFormulation::full: return make_small_strain_kernel<DisplacementStrain<Hex8>>(material);
        case HexFormulation::b_bar: return make_small_strain_kernel<BBarHex>(material);
        case HexFormulation::incompatible_modes: return make_small_strain_kernel<IncompatibleModesHex>(material);
        }
    }
    throw InternalError("make_kernel: unknown cell type or formulation");
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::SaintVenantKirchhoff& material) {
    return make(type, formulation, material);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::NeoHookean& material) {
    return make(type, formulation, material);
}

} // namespace osculate::fe
