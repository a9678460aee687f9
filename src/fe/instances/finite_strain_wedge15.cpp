#include "fe/finite_strain.hpp"

namespace osculate::fe {

template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Wedge15, material::SaintVenantKirchhoff, false>(const material::SaintVenantKirchhoff&, bool);
template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Wedge15, material::NeoHookean, false>(const material::NeoHookean&, bool);
template std::unique_ptr<ElementKernel>
make_finite_strain_kernel<Wedge15, material::J2Plasticity, false>(const material::J2Plasticity&, bool);

} // namespace osculate::fe
