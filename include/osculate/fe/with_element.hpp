#pragma once
/// The list of reference elements, by cell type.

#include "osculate/core/error.hpp"
#include "osculate/fe/reference_element.hpp"
#include "osculate/mesh/cell_type.hpp"

namespace osculate::fe {

/// f.operator()<E>() for the reference element of a cell type.
template <class F> decltype(auto) with_element(mesh::CellType type, F&& f) {
    switch (type) {
    case mesh::CellType::tet4: return f.template operator()<Tet4>();
    case mesh::CellType::wedge6: return f.template operator()<Wedge6>();
    case mesh::CellType::hex8: return f.template operator()<Hex8>();
    case mesh::CellType::tet10: return f.template operator()<Tet10>();
    case mesh::CellType::wedge15: return f.template operator()<Wedge15>();
    case mesh::CellType::hex20: return f.template operator()<Hex20>();
    }
    throw InternalError("cell type without a reference element");
}

} // namespace osculate::fe
