#pragma once
/// Output of a run: fields of frames, probes, plots.

#include "osculate/core/types.hpp"
#include "osculate/scene/named.hpp"

#include <numbers>
#include <string>
#include <variant>
#include <vector>

namespace osculate::scene {

// ---- probes: values over time, in probes/NAME.csv ------------------------------------------------------------------------

/// Fields at a material point, interpolated within its element.
struct PointProbe {
    std::string body;
    Vec3 at = Vec3::Zero(); ///< reference position, m
    std::vector<std::string> fields{"displacement"};
    bool operator==(const PointProbe&) const = default;
};

/// Fields along a straight line through a body.
struct LineProbe {
    std::string body;
    Vec3 from = Vec3::Zero(), to = Vec3::UnitX(); ///< reference positions, m
    int samples = 51;
    std::vector<std::string> fields{"displacement", "stress"};
    bool operator==(const LineProbe&) const = default;
};

/// Fields of a pair's slave surface along a straight line.
struct ContactLineProbe {
    std::string pair;
    Vec3 from = Vec3::Zero(), to = Vec3::UnitX(); ///< m; every sample uses the closest point of the surface
    int samples = 51;
    std::vector<std::string> fields{"normal_stress"};
    bool operator==(const ContactLineProbe&) const = default;
};

/// Fields of a pair's slave surface along an arc.
struct ContactArcProbe {
    std::string pair;
    Vec3 centre = Vec3::Zero(), axis = Vec3::UnitZ(); ///< m, a direction
    Vec3 from = Vec3::UnitX();                        ///< m; start, which fixes the radius
    double angle = 2 * std::numbers::pi;              ///< rad, about the axis
    int samples = 73;
    std::vector<std::string> fields{"normal_stress"};
    bool operator==(const ContactArcProbe&) const = default;
};

/// Fields of a set's nodes, reduced to numbers.
struct NodesProbe {
    std::string set;
    std::vector<std::string> fields{"displacement"};
    std::vector<std::string> reduce{"mean"};
    bool operator==(const NodesProbe&) const = default;
};

/// Fields of a pair's slave nodes, reduced to numbers.
struct SlaveNodesProbe {
    std::string pair;
    std::vector<std::string> fields{"normal_stress"};
    std::vector<std::string> reduce{"max"};
    bool operator==(const SlaveNodesProbe&) const = default;
};

/// Force and moment through a plane cut of a body.
struct SectionForceProbe {
    std::string body;
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ(); ///< of the plane, reference configuration
    bool operator==(const SectionForceProbe&) const = default;
};

/// What contact does to a set: resultant, centre and pressures.
struct ContactForceProbe {
    std::string set;
    Vec3 point = Vec3::Zero(); ///< m; moments are about it
    bool operator==(const ContactForceProbe&) const = default;
};

struct Probe {
    std::variant<PointProbe, LineProbe, ContactLineProbe, ContactArcProbe, NodesProbe, SlaveNodesProbe,
                 ContactForceProbe, SectionForceProbe>
        kind;
    int every = 1; ///< accepted steps between rows
    bool operator==(const Probe&) const = default;
};

// ---- plots: drawn at the end of a run, in plots/NAME.{csv,gp,svg,png} ----------------------------------------------------

/// Formulas over the columns of a table. `pair.*.normal` stands for every matching column: one curve each.
struct Curve {
    std::string rows = "history"; ///< or the name of a probe
    std::string x = "time", y;
    std::string where; ///< uses only rows where this formula is not 0; empty: all
    bool last = false; ///< only the rows of the last time
    bool operator==(const Curve&) const = default;
};

struct Plot {
    std::string title, x_label, y_label; ///< empty: the plot's name, the formulas
    Named<Curve> curves;
    bool operator==(const Plot&) const = default;
};

/// Derivatives of the tables by a number of the scene, in derivatives/NAME.
struct Derivative {
    std::string key;      ///< dotted path of the number, as for --set
    double change = 1e-5; ///< of the number, relative to it, by which it is made
    double step = 0;      ///< change itself, SI; 0: the relative one counts
    bool operator==(const Derivative&) const = default;
};

/// What a run ends with, for its derivatives by many numbers.
struct MeanDisplacement {
    std::string set;
    Vec3 direction = Vec3::UnitZ();
    bool operator==(const MeanDisplacement&) const = default;
};
struct PairForce {
    std::string pair;
    Vec3 direction = Vec3::UnitZ();
    bool operator==(const PairForce&) const = default;
};
struct SupportForce {
    std::string set;
    Vec3 direction = Vec3::UnitZ();
    bool operator==(const SupportForce&) const = default;
};

/// Derivatives of one quantity at the end of the run by numbers of the scene, in gradients/NAME.csv.
struct Gradient {
    std::variant<MeanDisplacement, PairForce, SupportForce> of;
    Named<Derivative> by;
    bool operator==(const Gradient&) const = default;
};

struct Output {
    std::string template_name = "contact";  ///< or the absolute path of a user's template
    std::vector<std::string> body_fields;   ///< see output::all_fields
    std::vector<std::string> slave_fields;  ///< of the slave surfaces
    std::vector<std::string> master_fields; ///< of the masters
    bool history_pairs = true;
    bool history_reactions = true;
    bool iterations = false; ///< write iterations.csv
    int frame_every = 1;     ///< accepted steps between frames; 0: none
    Named<Probe> probes;
    Named<Plot> plots;
    Named<Derivative> derivatives;
    Named<Gradient> gradients;
    bool paraview = false;      ///< write show_in_paraview.py next to the series
    bool report = false;        ///< write report.html at the end
    bool failed_iterate = true; ///< write the last iterate of a failed run
    bool operator==(const Output&) const = default;
};

} // namespace osculate::scene
