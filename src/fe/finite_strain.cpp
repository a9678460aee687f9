#include "fe/finite_strain.hpp"

#include <stdexcept>

namespace osculate::fe {
namespace {

template <class Material>
std::unique_ptr<ElementKernel> make(mesh::CellType type, HexFormulation formulation, const Material& material) {
    switch (type) {
    case mesh::CellType::tet4: return std::make_unique<FiniteStrainKernel<Tet4, Material, false>>(material);
    case mesh::CellType::wedge6: return std::make_unique<FiniteStrainKernel<Wedge6, Material, false>>(material);
    case mesh::CellType::tet10: return std::make_unique<FiniteStrainKernel<Tet10, Material, false>>(material);
    case mesh::CellType::hex8:
        switch (formulation) {
        case HexFormulation::full: return std::make_unique<FiniteStrainKernel<Hex8, Material, false>>(material);
        case HexFormulation::b_bar: return std::make_unique<FiniteStrainKernel<Hex8, Material, true>>(material);
        case HexFormulation::incompatible_modes:
            throw std::invalid_argument("incompatible modes are for small strain; at finite strain use b_bar or full");
        }
    }
    throw InternalError("make_kernel: unknown cell type or formulation");
}

} // namespace

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::SaintVenantKirchhoff& material) {
    return make(type, formulation, material);
}

std::unique_ptr<ElementKernel> make_kernel(mesh::CellType type, HexFormulation formulation,
                                           const material::NeoHookean& material) {
    return make(type, formulation, material);
}

} // namespace osculate::fe
