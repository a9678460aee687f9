#pragma once
/// The reader of studies of runs: its parts are in study_reader.cpp, study_axes.cpp, study_quantities.cpp and study_plots.cpp.

#include "osculate/scene/study.hpp"
#include "scene/tree_reader.hpp"

#include <filesystem>

namespace osculate::scene {

/// What a variable of a sampled axis may be, in its unit.
struct SampledRange {
    Words keys{}; ///< that it is set for
    Place place{};
    double from = 0, to = 0;
    std::string unit{};
    bool logarithmic = false;
};

class StudyReader {
public:
    StudyReader(const Tree& tree, std::string path, const NamedFunctions& functions, std::vector<Fault>& faults)
        : tree_(tree), functions_(functions), faults_(faults), reader_(names_, faults) {
        study_.path = std::move(path);
        study_.name = study_.title = std::filesystem::path(study_.path).stem().string();
    }

    /// @post a study with faults may lack anything
    Study read() {
        reader_.read(tree_, [&] { document(); });
        return std::move(study_);
    }

private:
    void document();
    void axis(const std::string& name, StudyAxis& axis);
    void listed_values(const Tree& key, StudyAxis& axis);
    void named_value(const Tree& entry, StudyAxis& axis);
    void scene_files(const Tree& pattern, StudyAxis& axis);
    void sampled_values(StudyAxis& axis);
    void sampled_variable(const std::string& name, SampledRange& range);
    void compare_parameters(const Tree& at, const StudyAxis& axis);
    void leave_out(const Tree& list);
    void quantity(StudyQuantity& q);
    void axis_list(const char* name, std::vector<std::size_t>& axes);
    void plots();
    void curves(StudyCurves& curves);
    void contours(StudyContours& contours);
    /// The quantity that a plot names, or none with a fault.
    [[nodiscard]] std::size_t plotted_quantity();
    /// What a name of an axis or of a parameter stands for; none with a fault.
    std::optional<StudyCoordinate> coordinate(const Tree& at, const Key& key);
    /// Curves where the study names none: of quantities without a reference over every axis of numbers.
    void add_curves();

    void text(const char* name, const char* what, StudyText& value);
    void settings(const Tree* map, std::vector<StudySetting>& list);
    [[nodiscard]] std::string scene_path(const Tree& tree);
    /// Index of the axis a tree names, or -1 with a fault.
    int axis_named(const Tree& at, const Key& key);
    void name_fault(const Tree& at, const std::string& key, const std::string& expected) {
        faults_.push_back(fault_at(at.key_place, key, expected, "'" + at.key + "'"));
    }

    const Tree& tree_;
    const NamedFunctions& functions_;
    std::vector<Fault>& faults_;
    const KnownNames names_{};
    TreeReader reader_;
    Study study_;
};

/// What a name of a parameter or of an axis has to be.
inline constexpr const char* variable_rule = "a name of letters, digits and _ that formulas do not know yet";

} // namespace osculate::scene
