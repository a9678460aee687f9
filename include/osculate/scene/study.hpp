#pragma once
/// A study of error against run time, read from a YAML file.

#include "osculate/scene/aggregate.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/scene/scene.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace osculate::scene {

/// A formula as written, and its place.
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
    std::string scene; ///< absolute path; empty: the study's scene
    std::vector<StudySetting> settings;
    Named<double> parameters;
    std::optional<double> number{}; ///< where all values of the axis are numbers, with one unit or none
};

/// What a sampled axis varies, all at once from value to value: parameters of its values.
struct SampledVariable {
    std::string name, unit; ///< unit as written
    bool logarithmic = false;
};

struct StudyAxis {
    std::string name;
    std::vector<AxisValue> values;
    std::string unit{};                       ///< of AxisValue::number, as written
    std::vector<SampledVariable> variables{}; ///< of a sampled axis
};

/// An axis as abscissa: the axis itself, or a parameter of its values.
struct StudyCoordinate {
    std::size_t axis = 0;
    std::string name, unit{};
    bool logarithmic = false;
    bool sampled = false; ///< other parameters change with it
};

/// A quantity over an axis: one curve for every combination of the others.
struct StudyCurves {
    std::string name;
    std::size_t quantity = 0;
    StudyCoordinate over;
    bool logarithmic = false; ///< the quantity's own axis
};

/// A quantity over two axes: one map for every combination of the others.
struct StudyContours {
    std::string name;
    std::size_t quantity = 0;
    std::array<StudyCoordinate, 2> over;
};

enum class RowSource { summary, contact, body, history };
enum class ErrorNorm { rms, max, mean };

struct StudyQuantity {
    std::string name, label, unit;
    RowSource source = RowSource::summary;
    std::string part;                 ///< the pair or body
    StudyText value;                  ///< an Aggregate; or
    StudyText of;                     ///< a formula of a row, with
    std::string reduce = "last";      ///< the reduction of its rows to a number; or
    StudyText exact;                  ///< the exact value in every row
    ErrorNorm norm = ErrorNorm::rms;  ///< norm of the difference
    bool area = false;                ///< weights nodes by their area
    StudyText where, order_by, scale; ///< scale divides the norm
    StudyText reference;              ///< a formula of numbers, or "finest"
    bool relative = true;             ///< error divided by |reference|, unless that is 0
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
    std::string scene; ///< absolute path; may be empty if an axis gives it
    std::vector<StudySetting> settings;
    Named<StudyText> constants;
    std::vector<StudyAxis> axes;
    std::vector<std::vector<std::vector<std::size_t>>> leave_out; ///< for each axis its values; empty: all
    std::vector<StudyQuantity> quantities;
    int refine = -1; ///< axis; -1: none
    StudyText abscissa;
    std::string abscissa_label;
    std::vector<std::size_t> colour_by; ///< axes
    std::vector<std::size_t> problems;  ///< axes whose values are different problems, not different methods for one
    std::vector<StudyCurves> curves;
    std::vector<StudyContours> contours;
    int repeats = 1;

    /// All combinations to run; the last axis changes fastest.
    [[nodiscard]] std::vector<Combination> combinations() const;
    /// "surface=blend,mesh=fine": valid as folder name.
    [[nodiscard]] std::string id(const Combination& combination) const;
    [[nodiscard]] std::string scene_of(const Combination& combination) const;
    /// Settings of a combination in the order in which they apply, without those of the command line.
    [[nodiscard]] std::vector<StudySetting> settings_of(const Combination& combination) const;
    /// The same with those of the command line; last come settings for the output that the study needs from a run.
    [[nodiscard]] std::vector<Override> overrides_of(const Combination& combination,
                                                     const std::vector<Override>& command_line) const;
    /// Values of the axes `problems`: errors are compared only between combinations where these are equal.
    [[nodiscard]] Combination problem_of(const Combination& combination) const;
    /// Parameters and <axis>_index of a combination, in the same order for every combination.
    [[nodiscard]] Named<double> parameters_of(const Combination& combination) const;
    /// Where a value of an axis lies on the coordinate; none where it has a name only.
    [[nodiscard]] std::optional<double> place_of(const StudyCoordinate& coordinate, std::size_t value) const;
};

/// Column names of a contact or a body quantity, and names of the numbers of every run.
[[nodiscard]] const std::vector<std::string>& contact_columns();
[[nodiscard]] const std::vector<std::string>& body_columns();
[[nodiscard]] const std::vector<std::string>& run_numbers();
/// Columns of history.csv that a run of the scene may write, with '_' for '-' as in formulas.
[[nodiscard]] std::vector<std::string> history_columns(const Scene& scene);

/// Values that every formula of the study knows besides columns: run_numbers(), parameters, constants; if two have the
/// same name, the later one.
/// @param run  values of run_numbers()
/// @pre the study's formulas can be parsed
[[nodiscard]] Numbers numbers_of(const Study& study, const Combination& combination, const NamedFunctions& functions,
                                 const std::vector<double>& run);
/// Columns of a quantity's rows, without those whose name is also that of a number.
/// @param scene  of any combination
[[nodiscard]] std::vector<std::string> visible_columns(const StudyQuantity& quantity, const Scene& scene,
                                                       const std::vector<std::string>& numbers);

/// Whether the file is a study of runs, not one of surfaces.
[[nodiscard]] bool is_run_study(const std::string& path);

/// Reads a study and the scene of every combination.
/// @param functions     that formulas may call
/// @param command_line  settings of every run
/// @throws SceneError with all faults; those of a setting contain its place in the study
[[nodiscard]] Study read_study(const std::string& path, const NamedFunctions& functions,
                               const std::vector<Override>& command_line = {});

/// Sets the place of a setting's fault to that of the setting in the study.
[[nodiscard]] Fault placed(Fault fault, const Study& study, const Combination& combination);

} // namespace osculate::scene
