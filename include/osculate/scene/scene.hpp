#pragma once
/// A validated scene in SI units: the user's input with every default filled in, nothing else.

#include "osculate/core/choices.hpp"
#include "osculate/core/types.hpp"
#include "osculate/scene/body.hpp"
#include "osculate/scene/course.hpp"
#include "osculate/scene/named.hpp"
#include "osculate/scene/output.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace osculate::scene {

// ---- sets: parts of a body's exterior, or of its nodes ---------------------------------------------------------------

struct SelectNamed {
    std::string name;   ///< a surface or node set of the mesh
    bool nodes = false; ///< a node set; false: a surface
    bool operator==(const SelectNamed&) const = default;
};
struct SelectPlane {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
    bool operator==(const SelectPlane&) const = default;
};
struct SelectCylinder {
    Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
    double radius = 1;
    bool operator==(const SelectCylinder&) const = default;
};
struct SelectNormal {
    Vec3 direction = Vec3::UnitZ();
    double angle = 0.5; ///< largest angle between facet normal and direction, rad
    bool operator==(const SelectNormal&) const = default;
};

struct SelectNumbers {
    std::vector<int> numbers; ///< of nodes in the mesh file
    bool operator==(const SelectNumbers&) const = default;
};

/// The named surface of the mesh that is nearest to a point.
struct SelectNearest {
    Vec3 point = Vec3::Zero();
    bool operator==(const SelectNearest&) const = default;
};

/// The node that is nearest to a point.
struct SelectNode {
    Vec3 point = Vec3::Zero();
    bool operator==(const SelectNode&) const = default;
};

struct SetSpec {
    std::string body;
    std::variant<SelectNamed, SelectPlane, SelectCylinder, SelectBox, SelectNormal, SelectNumbers, SelectNearest,
                 SelectNode>
        select;
    bool operator==(const SetSpec&) const = default;
};

// ---- supports: constraints that hold for the whole run ---------------------------------------------------------------

/// An axis of rotation.
struct Axis {
    Vec3 point = Vec3::Zero(); ///< m
    Vec3 direction = Vec3::UnitZ();
    bool operator==(const Axis&) const = default;
};

/// Displacement components of a set that are held at zero or driven by the stages.
struct Support {
    std::array<bool, 3> fixed{false, false, false}; ///< held at zero along axes[0..2]
    Mat3 axes = Mat3::Identity();                   ///< columns: directions "x", "y", "z" for this set
    std::optional<Axis>
        cylinder;          ///< "x", "y", "z" are radial, tangential and axial at every node; axes do not count then
    bool symmetry = false; ///< mirror plane: fixed is {true, false, false} and column 0 of the axes is its normal
    bool operator==(const Support&) const = default;
};

// ---- contact ---------------------------------------------------------------------------------------------------------

struct FacetsSurface {
    double hysteresis = 0.03; ///< of the facet size: overhang, or lead of another facet, at which a node changes
    bool operator==(const FacetsSurface&) const = default;
};

enum class RadialBasis { automatic, multiquadric, r3, r5 };

struct RpimSurface {
    int ring = 2;
    RadialBasis basis = RadialBasis::automatic;
    double R = 1.42, q = 1.03; ///< of the multiquadric
    int m = 6;                 ///< terms of the polynomial basis, 3 or 6
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
    double hysteresis = 0.03;
    bool operator==(const RpimSurface&) const = default;
};

struct BlendSurface {
    int ring = 2; ///< rings of facets around a vertex that form its patch
    RadialBasis basis = RadialBasis::automatic;
    double R = 1.42, q = 1.03; ///< of the multiquadric
    int m = 6;
    PatchCoordinates coordinates = PatchCoordinates::equal_length;
    bool operator==(const BlendSurface&) const = default;
};

/// Facets or a blend, whichever suits the master.
struct AutomaticSurface {
    bool operator==(const AutomaticSurface&) const = default;
};

struct MasterSpec {
    std::string set;
    std::string rigid_surface; ///< a body with an exact surface, in place of the set; empty: not given
    std::variant<AutomaticSurface, FacetsSurface, RpimSurface, BlendSurface> surface;
    bool operator==(const MasterSpec&) const = default;
};

struct ExactContact {
    bool operator==(const ExactContact&) const = default;
};
struct LinearOverclosure {
    double stiffness = 0; ///< Pa/m
    bool operator==(const LinearOverclosure&) const = default;
};
/// See contact::Overclosure.
struct ExponentialOverclosure {
    double pressure = 0, clearance = 0; ///< Pa, m
    bool operator==(const ExponentialOverclosure&) const = default;
};
struct TabularOverclosure {
    Table table; ///< overclosure, m; pressure, Pa
    bool operator==(const TabularOverclosure&) const = default;
};
using PressureOverclosure = std::variant<ExactContact, LinearOverclosure, ExponentialOverclosure, TabularOverclosure>;

struct Pair {
    std::string slave; ///< set
    MasterSpec master;
    std::array<std::string, 2> between{};         ///< sets, in place of slave and master.set; empty: not given
    std::optional<Discretisation> discretisation; ///< none: automatic
    double friction = 0;                          ///< Coulomb's coefficient mu
    std::optional<double> static_friction;        ///< of nodes that do not slide; none: the same
    PressureOverclosure pressure_overclosure;
    double damping = 0;                    ///< of an interface that gives way, in dynamics, Pa s/m
    double tangential_damping = 0;         ///< against sliding, in dynamics, Pa s/m
    std::optional<double> stick_stiffness; ///< Pa/m; none: nodes stick exactly
    std::optional<double> adjust;          ///< slave nodes as near as this are moved onto the master at the start, m
    double closing_tolerance = 0.02;       ///< of the facet size: the first solve closes nodes with a smaller gap
    double initial_overlap_limit = 0.1;    ///< of the facet size: a deeper initial overlap is a fault
    double stiffness_scale =
        1; ///< factor on the estimated c of the complementarity function; see docs/theory.md, section 5
    bool operator==(const Pair&) const = default;
};

/// What differs between two of the bodies in general contact, or between all bodies of two finishes.
struct GeneralRule {
    std::array<std::string, 2> between{};  ///< bodies or finishes
    std::optional<double> friction;        ///< none: that of all
    std::optional<double> static_friction; ///< none: that of all, or friction where the rule gives that
    bool contact = true;                   ///< false: they do not meet
    bool operator==(const GeneralRule&) const = default;
};

enum class GeneralSurface { automatic, facets, blend };

/// Contact of all outer surfaces.
struct GeneralContact {
    double friction = 0;                                ///< Coulomb's coefficient mu
    std::optional<double> static_friction;              ///< of nodes that do not slide; none: the same
    GeneralSurface surface = GeneralSurface::automatic; ///< of masters
    std::optional<Discretisation> discretisation;       ///< none: automatic
    double closing_tolerance = Pair{}.closing_tolerance;
    double initial_overlap_limit = Pair{}.initial_overlap_limit;
    double stiffness_scale = 1;
    Named<GeneralRule> pairs; ///< the last rule that names two bodies counts
    bool operator==(const GeneralContact&) const = default;
};

// ---- stages ------------------------------------------------------------------------------------------------------------

struct GeneralisedAlpha {
    double rho_inf = 0.8; ///< spectral radius at infinite frequency
    bool operator==(const GeneralisedAlpha&) const = default;
};
struct Newmark {
    double beta = 0.25, gamma = 0.5;
    bool operator==(const Newmark&) const = default;
};
struct Hht {
    double alpha = -0.1;
    bool operator==(const Hht&) const = default;
};
struct BackwardEuler {
    bool operator==(const BackwardEuler&) const = default;
};

enum class MassMatrix { consistent, lumped };
enum class ContactMass { kept, redistributed };
enum class Impacts { automatic, resolved, inelastic };

struct StaticAnalysis {
    bool operator==(const StaticAnalysis&) const = default;
};
struct DynamicAnalysis {
    std::variant<GeneralisedAlpha, Newmark, Hht, BackwardEuler> integrator;
    MassMatrix mass = MassMatrix::consistent;
    ContactMass contact_mass = ContactMass::redistributed;
    /// Rayleigh's C = mass_damping M + stiffness_damping K, 1/s and s; without stiffness_damping a rule gives it.
    double mass_damping = 0;
    std::optional<double> stiffness_damping;
    Impacts impacts = Impacts::automatic;
    bool operator==(const DynamicAnalysis&) const = default;
};

/// A length, or a fraction of a local length.
struct RelativeLength {
    double value = 0;    ///< m, or the fraction
    bool metres = false; ///< written with a unit
    bool operator==(const RelativeLength&) const = default;
};

enum class StepSize { controlled, fixed };

/// Criteria for an attempted step; if it violates one, it is repeated with a smaller dt.
struct StepControl {
    /// A fraction is relative to the facet size. Default: 0.05 in dynamics, 0.5 in statics.
    std::optional<RelativeLength> allowed_interpenetration;
    /// Whether dynamic steps are cut to limit their errors: by velocity_error and closing_energy, or by
    /// error_tolerance.
    StepSize step_size = StepSize::controlled;
    double velocity_error = 0.002; ///< of bodies' centres per step, divided by the speed if all energy were kinetic
    double closing_energy = 0.001; ///< energy lost in closing gaps per dynamic step, of all energy so far
    std::optional<double> error_tolerance; ///< of the displacement per dynamic step, m; replaces velocity_error
    double energy_tolerance = 0.01; ///< rise beyond external work per dynamic step, of kinetic plus strain energy
    double growth = 2;              ///< factor on dt after an easy step, up to the stage's step
    bool operator==(const StepControl&) const = default;
};

/// Force of a body that turns, on the undeformed body: density * speed^2 * distance from the axis.
struct Centrifugal {
    Axis axis;
    double speed = 0; ///< rad/s
    bool operator==(const Centrifugal&) const = default;
};

/// Every constant value is reached at the end of the stage. Values that the stage does not name stay; those with a
/// course over time stay at its last value.
struct Stage {
    std::variant<StaticAnalysis, DynamicAnalysis> analysis;
    double duration = 1; ///< s
    int steps = 1;
    StepControl control;
    bool ramp = true; ///< linear from the last value; false: the full value from the first step on
    Named<std::array<std::optional<Course>, 3>> displacement; ///< set -> components along the support's axes, m
    Named<std::array<bool, 3>>
        release;                     ///< set -> components that neither its support nor an earlier stage holds any more
    Named<Course> follower_pressure; ///< set -> pressure on the current area, along the current normal, Pa
    Named<Course> pressure;          ///< set -> dead pressure on the reference area, Pa, > 0 pushes into the body
    Named<std::array<Course, 3>> body_force;         ///< body -> N/m^3
    Named<Centrifugal> centrifugal;                  ///< body ->
    Named<std::array<Course, 3>> nodal_force;        ///< set -> on each of its nodes, N
    Named<double> friction;                          ///< pair -> coefficient from this stage on
    Named<PressureOverclosure> pressure_overclosure; ///< pair -> its law from this stage on
    Named<bool> pairs;                               ///< pair -> whether it is in force from this stage on
    Named<Course> temperature;                       ///< body or set -> above that at which it has no thermal strain, K
    Named<std::array<std::optional<Course>, 6>>
        motion; ///< rigid body or coupling -> displacement and rotation components, m, rad
    Named<std::array<Course, 3>> force, moment; ///< rigid body or coupling -> at its reference point, N, N m
    bool operator==(const Stage&) const = default;
};

struct Solver {
    double tolerance = 1e-9;     ///< largest residual, divided by the step's reference force
    int max_iterations = 30;     ///< Newton iterations of one solve
    double smallest_step = 1e-3; ///< fraction of the stage's step below which the run fails
    bool predictor = true;       ///< move driven bodies rigidly by the prescribed increment before the first iteration
    LinearSolver linear_solver = LinearSolver::automatic;
    bool stabilisation = true;  ///< springs under bodies that nothing holds yet, removed before a step is accepted
    bool audit = true;          ///< look for penetration of bodies after every solved step
    double audited_depth = 0.1; ///< allowed depth beyond the sagitta of smooth surfaces, of the facet size
    bool operator==(const Solver&) const = default;
};

// ---- expectation ---------------------------------------------------------------------------------------------------------

enum class Outcome { completed, gives_up };

/// The expected result of a run, compared with its checks.
struct Expectation {
    /// Penetration, of the facet size, in statics. Contact is exact: on a closed node the solver leaves a gap of the
    /// order of tolerance * force / c, with c ~ E A / h about 1e-9 of the elastic strain. This is a thousand times
    /// more.
    static constexpr double exact = 1e-6;

    Outcome outcome = Outcome::completed;
    std::string cause; ///< words in the message of a run that fails
    /// Fraction of the acting forces. The solver leaves a residual of solver.tolerance times a reference force in the
    /// mean square over n degrees of freedom, sqrt(n) times that in a sum: 1e-6 for 1e-9 and a million.
    double force_balance = 1e-6;
    /// Fraction of the largest energy, over the whole run: as much as one step may cause, see StepControl.
    double energy_growth = StepControl{}.energy_tolerance;
    std::optional<double>
        penetration; ///< of the facet size; default: the stage's bound in dynamics, `exact` in statics
    bool operator==(const Expectation&) const = default;
};

enum class CouplingKind { rigid, distributing };

/// Nodes of a body that deforms and a reference point: they follow it as one, or share its loads.
struct Coupling {
    std::string set;
    CouplingKind kind = CouplingKind::rigid;
    std::optional<Vec3> reference_point; ///< m; none: the mean of the nodes
    std::array<bool, 6> fixed{};         ///< displacement and rotation components held at zero
    bool operator==(const Coupling&) const = default;
};

/// Two surfaces that move as one.
struct Tie {
    std::string slave, master;      ///< sets
    std::optional<double> distance; ///< m; none: a part of the master's facet size
    bool operator==(const Tie&) const = default;
};

/// A body that stands for a whole ring of bodies, each turned against the one before by the same angle.
struct CyclicSymmetry {
    std::string slave, master; ///< sets of nodes, where the sector ends and where it begins
    Axis axis;
    int sectors = 2;
    std::optional<double> distance; ///< m; none: a part of the least distance of the set's nodes
    bool operator==(const CyclicSymmetry&) const = default;
};

/// sum over the terms of factor . displacement = 0, the displacement of a set being the mean of its nodes' or, for the set
/// called `each`, that of one node after the other.
struct Equation {
    std::string each;  ///< set; empty: one equation
    Named<Vec3> terms; ///< set -> factors of its displacement
    bool operator==(const Equation&) const = default;
};

struct Scene {
    std::string name;            ///< valid as file name: letters, digits, _ and -
    std::string description;     ///< free text
    std::string directory;       ///< folder of the scene file, absolute
    Vec3 gravity = Vec3::Zero(); ///< m/s^2, on every body with a density, in every stage
    Named<Body> bodies;
    Named<SetSpec> sets;
    Named<Vec3> imperfections; ///< set -> by how much its nodes are moved before the run, m
    Named<Support> supports;   ///< keyed by set
    Named<Coupling> couplings;
    Named<Tie> ties;
    Named<CyclicSymmetry> cyclic;
    Named<Equation> equations;
    std::optional<GeneralContact> general; ///< contact.general
    Named<Pair> contact;                   ///< the other keys of contact
    Named<Stage> stages;
    Solver solver;
    Output output;
    std::optional<Expectation> expect; ///< not given: no judgement
    bool operator==(const Scene&) const = default;
};

/// The value called `name`, or nullptr.
template <class T> [[nodiscard]] const T* find(const Named<T>& named, const std::string& name) {
    for (const auto& [key, value] : named)
        if (key == name) return &value;
    return nullptr;
}

} // namespace osculate::scene
