#pragma once
/// What a study of error against run time asks for, read from a YAML file.

#include "osculate/scene/aggregate.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/scene/scene.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

/// A formula as written, and where.
struct StudyText {
    std::string text{};
    int line = 0, column = 0;
    [[nodiscard]] bool empty() const { return text.empty(); }
};

struct StudySetting {
    Override change;
    int line = 0, column = 0;
};

struct AxisValue {
    std::string name;
    std::string scene; ///< absolute path; empty: that of the study
    std::vector<StudySetting> settings;
    Named<double> parameters;
};

struct StudyAxis {
    std::string name;
    std::vector<AxisValue> values;
};

enum class RowSource { summary, contact, body, history };
enum class ErrorNorm { rms, max, mean };

struct StudyQuantity {
    std::string name, label, unit;
    RowSource source = RowSource::summary;
    std::string part;                 ///< the pair or body
    StudyText value;                  ///< an Aggregate; or
    StudyText of;                     ///< a formula of a row, with
    std::string reduce = "last";      ///< how it becomes a number, or
    StudyText exact;                  ///< what it should be in every row
    ErrorNorm norm = ErrorNorm::rms;  ///< of their difference
    bool area = false;                ///< nodes weigh by their area
    StudyText where, order_by, scale; ///< scale divides the norm
    StudyText reference;              ///< a formula of numbers, or "finest"
    bool relative = true;             ///< error over |reference|, where that is not 0
    bool plot = true;

    [[nodiscard]] bool finest() const { return reference.text == "finest"; }
    [[nodiscard]] bool has_error() const { return !reference.empty() || !exact.empty(); }
};

/// Index of the value of every axis.
using Combination = std::vector<std::size_t>;

struct Study {
    std::string name; ///< the file's stem
    std::string path; ///< as given
    std::string title, problem, source, defects;
    std::string scene; ///< absolute path; may be empty where an axis gives it
    std::vector<StudySetting> settings;
    Named<StudyText> constants;
    std::vector<StudyAxis> axes;
    std::vector<std::vector<std::vector<std::size_t>>> leave_out; ///< by axis: values; empty stands for all
    std::vector<StudyQuantity> quantities;
    int refine = -1; ///< axis; -1: none
    StudyText abscissa;
    std::string abscissa_label;
    std::vector<std::size_t> colour_by; ///< axes
    std::vector<std::size_t> problems;  ///< axes whose values are other problems, not other ways to solve one
    int repeats = 1;

    /// Everything that is to be run, the last axis fastest.
    [[nodiscard]] std::vector<Combination> combinations() const;
    /// "surface=blend,mesh=fine": fit for a folder's name.
    [[nodiscard]] std::string id(const Combination& combination) const;
    [[nodiscard]] std::string scene_of(const Combination& combination) const;
    /// Settings of a combination in the order of their application, without those of the command line.
    [[nodiscard]] std::vector<StudySetting> settings_of(const Combination& combination) const;
    /// The same and what the study needs to see of a run, which comes last.
    [[nodiscard]] std::vector<Override> overrides_of(const Combination& combination,
                                                     const std::vector<Override>& command_line) const;
    /// Values of the axes `problems`: errors are compared where they are the same.
    [[nodiscard]] Combination problem_of(const Combination& combination) const;
    /// Parameters and <axis>_index of a combination, in an order that is that of every other.
    [[nodiscard]] Named<double> parameters_of(const Combination& combination) const;
};

/// Columns of the rows of a contact or body quantity, and the numbers of every run.
[[nodiscard]] const std::vector<std::string>& contact_columns();
[[nodiscard]] const std::vector<std::string>& body_columns();
[[nodiscard]] const std::vector<std::string>& run_numbers();
/// Columns of history.csv that a run of the scene may write, as formulas know them: '_' for '-'.
[[nodiscard]] std::vector<std::string> history_columns(const Scene& scene);

/// What every formula of the study knows besides columns: run_numbers(), parameters, constants; where two have one name,
/// the later one.
/// @param run  values of run_numbers()
/// @pre the study's formulas can be read
[[nodiscard]] Numbers numbers_of(const Study& study, const Combination& combination, const NamedFunctions& functions,
                                 const std::vector<double>& run);
/// Columns of a quantity's rows that no number hides.
/// @param scene  of any combination
[[nodiscard]] std::vector<std::string> visible_columns(const StudyQuantity& quantity, const Scene& scene,
                                                       const std::vector<std::string>& numbers);

/// Whether the file is a study of this kind; one of surfaces is not.
[[nodiscard]] bool is_run_study(const std::string& path);

/// Reads a study and the scene of every combination.
/// @param functions     that formulas may call
/// @param command_line  settings of every run
/// @throws SceneError with all faults; those of a setting name its place in the study
[[nodiscard]] Study read_study(const std::string& path, const NamedFunctions& functions,
                               const std::vector<Override>& command_line = {});

/// Gives the fault of a setting the place of that setting in the study.
[[nodiscard]] Fault placed(Fault fault, const Study& study, const Combination& combination);

} // namespace osculate::scene
