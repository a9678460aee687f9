#pragma once
/// What VTK's readers say, kept from the terminal.

#include <string>
#include <vtkAlgorithm.h>
#include <vtkCommand.h>

namespace osculate::vtk {

/// Takes VTK's errors and warnings, which would otherwise go to the terminal, and keeps the first error.
class VtkErrors : public vtkCommand {
public:
    static VtkErrors* New() { return new VtkErrors; }
    vtkTypeMacro(VtkErrors, vtkCommand)

        void Execute(vtkObject*, unsigned long event, void* text) override;
    void listen_to(vtkAlgorithm& reader);

    /// The first message without VTK's preamble of source file, line and address; empty when all went well.
    [[nodiscard]] std::string reason() const;

private:
    std::string first_;
};

} // namespace osculate::vtk
