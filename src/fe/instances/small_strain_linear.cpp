#include "fe/small_strain_kernel.hpp"

namespace osculate::fe {

template std::unique_ptr<ElementKernel>
make_small_strain_kernel<DisplacementStrain<Tet4>>(const material::LinearElastic&);
template std::unique_ptr<ElementKernel>
make_small_strain_kernel<DisplacementStrain<Wedge6>>(const material::LinearElastic&);

} // namespace osculate::fe
