#include "osculate/mesh/vtk_threads.hpp"

#include <vtkSMPTools.h> // no valid C++20 in VTK 9.1: this file is compiled as C++17

namespace osculate::mesh {

void use_no_vtk_threads() {
    static const bool once = vtkSMPTools::SetBackend("Sequential");
    (void)once;
}

} // namespace osculate::mesh
