#pragma once
/// Studies of surface approximations: errors of every method on every mesh of every surface, as tables and plots.

#include "osculate/output/output_folder.hpp"
#include "osculate/scene/surface_study.hpp"
#include "osculate/study/errors.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// One method on one mesh of one surface.
struct StudyRow {
    std::string surface, method;
    int mesh = 0; ///< 1, 2, ...
    Index facets = 0, vertices = 0;
    double size = 0; ///< mean facet size, m
    study::Errors errors;
    Index fallbacks = 0;
    double cpu_seconds = 0; ///< to build the surface and measure it
};

struct StudyResult {
    std::vector<StudyRow> rows; ///< surface by surface, mesh by mesh, methods in the order of the study

    /// Row of a method on a mesh; InternalError if there is none.
    [[nodiscard]] const StudyRow& row(const std::string& surface, int mesh, const std::string& method) const;
    /// Number of meshes per surface.
    [[nodiscard]] int meshes() const;
};

/// A kind of error in a study, and its name.
struct ErrorKind {
    const char *name, *unit;
    study::ErrorMeasure study::Errors::*measure;
};
[[nodiscard]] const std::vector<ErrorKind>& error_kinds();

/// Exponent p of error ~ size^p over the given rows: least squares of the logarithms.
[[nodiscard]] double fitted_order(const std::vector<const StudyRow*>& rows, const ErrorKind& kind);

/// @throws SceneError if the meshes of a file do not fit
[[nodiscard]] StudyResult run_surface_study(const scene::SurfaceStudy& study, int threads);

/// Files that write_surface_study() may write.
[[nodiscard]] std::vector<std::string> surface_study_files(const scene::SurfaceStudy& study);

/// Writes study.csv, study.md, study.gp and, with gnuplot, the plots study_<surface>.svg and .png.
/// @returns a message about the plots
std::string write_surface_study(const scene::SurfaceStudy& study, const StudyResult& result,
                                output::OutputFolder& files);

} // namespace osculate::app
