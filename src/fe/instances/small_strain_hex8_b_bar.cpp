#include "fe/small_strain_hex.hpp"
#include "fe/small_strain_kernel.hpp"

namespace osculate::fe {

template std::unique_ptr<ElementKernel> make_small_strain_kernel<BBarHex>(const Mat6&, bool);

} // namespace osculate::fe
