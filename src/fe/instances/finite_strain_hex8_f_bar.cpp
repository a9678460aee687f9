#include "fe/finite_strain.hpp"

namespace osculate::fe {

template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Hex8, material::SaintVenantKirchhoff, true>(const material::SaintVenantKirchhoff&, bool);
template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Hex8, material::NeoHookean, true>(const material::NeoHookean&, bool);
template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Hex8, material::J2Plasticity, true>(const material::J2Plasticity&, bool);

} // namespace osculate::fe
