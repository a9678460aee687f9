#include "vtk/vtk_errors.hpp"

#include <cctype>
#include <vtkExecutive.h>

namespace osculate::vtk {

void VtkErrors::Execute(vtkObject*, unsigned long event, void* text) {
    if (event == vtkCommand::ErrorEvent && first_.empty() && text != nullptr) first_ = static_cast<char*>(text);
}

void VtkErrors::listen_to(vtkAlgorithm& reader) {
    reader.AddObserver(vtkCommand::ErrorEvent, this);
    reader.AddObserver(vtkCommand::WarningEvent, this);
    reader.GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this);
}

std::string VtkErrors::reason() const {
    std::string text = first_;
    if (const auto preamble = text.find("): "); preamble != std::string::npos) text.erase(0, preamble + 3);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    return first_.empty() || !text.empty() ? text : "VTK cannot read it";
}

} // namespace osculate::vtk
