#pragma once
/// What an input deck says beside its mesh, as far as a scene can say it too.

#include "osculate/mesh/deck_mesh.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace osculate::deck {

/// Something of a deck that the scene does not have, or not as it stands there.
struct LeftOut {
    std::string place; ///< file:line
    std::string what, why;
    bool lost = true; ///< a load, contact, a material, a support, a step; otherwise what bodies do without
};

/// Time since a step's start and factor; times ascend, and there is a row.
using Amplitude = std::vector<std::array<double, 2>>;

struct DeckMaterial {
    std::string name, place;
    std::optional<std::array<double, 2>> elastic;     ///< E, nu
    std::optional<std::array<double, 2>> neo_hookean; ///< C10, D1
    std::vector<std::array<double, 2>> hardening;     ///< equivalent plastic strain, yield stress; empty: elastic
    std::optional<std::array<double, 9>> orthotropic; ///< E1 E2 E3, nu12 nu13 nu23, G12 G13 G23
    double density = 0;
    std::array<double, 2> damping{0, 0}; ///< of the mass, 1/s; of the stiffness, s
    double expansion = 0;                ///< thermal, 1/K; of the first row
    std::vector<std::array<double, 2>>
        expansions;  ///< temperature, expansion from `zero` to it; more than one row or none
    double zero = 0; ///< temperature from which expansions count
    std::vector<std::array<double, 3>> by_temperature; ///< temperature, E, nu; more than one row or none
};

/// Linear between the rows of a table over its first column, constant beyond.
template <std::size_t n>
[[nodiscard]] double interpolated(const std::vector<std::array<double, n>>& rows, double at, std::size_t column) {
    if (at <= rows.front()[0]) return rows.front()[column];
    for (std::size_t i = 1; i < rows.size(); ++i)
        if (at <= rows[i][0])
            return rows[i - 1][column] +
                   (rows[i][column] - rows[i - 1][column]) * (at - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0]);
    return rows.back()[column];
}

/// Temperature of points.
struct DeckTemperature {
    std::vector<Index> points;
    double value = 0;
    std::string place;
};

struct DeckSection {
    std::vector<Index> cells;
    std::string elements, material; ///< names; the material's in capitals
    std::string orientation;        ///< in capitals
    std::string place;
};

/// Pressure of an interface over its overclosure.
struct DeckOverclosure {
    enum class Form { exact, linear, exponential, tabular };
    Form form = Form::exact;
    /// Linear: the slope. Exponential: clearance, pressure. Tabular: overclosure and pressure of each row.
    std::vector<std::array<double, 2>> rows;
    [[nodiscard]] bool gives_way() const { return form != Form::exact; }
};

/// Law of an interface.
struct DeckInteraction {
    double friction = 0, stick = 0; ///< coefficient; stick slope, 0: not given
    DeckOverclosure overclosure;
    double damping = 0, tangential_damping = 0; ///< pressure over speed, traction over it
    double static_friction = 0;                 ///< 0: as friction
    bool tied = false;                          ///< surfaces do not part
};

struct DeckPair {
    std::string slave, master, interaction; ///< in capitals
    bool mortar = false;                    ///< surface to surface, and mortar
    bool tied = false;
    bool either = false;  ///< may be the slave
    double tolerance = 0; ///< of a tie's positions; 0: not given
    double adjust = 0;    ///< distance up to which slave nodes are moved onto the master; 0: none is
    std::string place;
};

/// Contact of all surfaces, or of pairs of them.
struct DeckGeneralContact {
    struct Sides {
        std::string first, second; ///< surfaces, in capitals; empty: all, or the first itself
        std::string interaction;   ///< of a law, in capitals
        std::string place;
    };
    std::string place; ///< of *CONTACT, empty where there is none
    bool all = false;  ///< all surfaces may meet
    std::vector<Sides> included, excluded, laws;
};

/// Axes of points that are not those of the deck.
struct DeckTransform {
    bool cylinder =
        false; ///< radial, tangential, axial about the line through two points; else x, and one of its plane
    std::array<Vec3, 2> points{Vec3::Zero(), Vec3::Zero()};
};

/// A body that stands for a ring.
struct DeckRing {
    std::string name, slave, master; ///< in capitals
    double tolerance = 0;            ///< of its positions; 0: not given
    int sectors = 0;                 ///< 0: nothing said
    std::array<Vec3, 2> axis{Vec3::Zero(), Vec3::Zero()};
    std::string place;
};

/// sum of factor times a component of a point = 0
struct DeckEquation {
    std::vector<std::tuple<Index, int, double>> terms; ///< point, component 0 to 2, factor
    std::string place;
};

/// Components of points that are held at a value, or forces on them.
struct DeckValues {
    std::vector<Index> points;
    int first = 0, last = 0; ///< components, 0 to 2
    double value = 0;
    std::string amplitude; ///< in capitals
    std::string place;
};

/// Elements, or nodes, that move as one, or nodes that share the loads of a reference node.
struct DeckRigid {
    std::vector<Index> cells;
    std::string elements;      ///< their name
    std::vector<Index> points; ///< of a coupling
    std::string set;           ///< their name, in capitals
    bool distributing = false;
    Index reference = -1; ///< point
    std::string place;

    [[nodiscard]] bool couples() const { return cells.empty(); }
};

/// A component of a reference node that is held at a value, or a force or moment along it.
struct DeckRigidValue {
    std::size_t rigid = 0; ///< of DeckModel
    int component = 0;     ///< 0 to 5, rotations last
    double value = 0;
    std::string amplitude; ///< in capitals
    std::string place;
};

struct DeckPressure {
    std::vector<mesh::RawFace> faces;
    std::string name;    ///< what the deck calls them
    std::string keyword; ///< DLOAD or DSLOAD
    double value = 0;
    std::string amplitude, place;
};

struct DeckGravity {
    std::vector<Index> cells;
    std::string elements; ///< their name in capitals
    Vec3 acceleration = Vec3::Zero();
    std::string amplitude, place;
};

/// CENTRIF: the square of an angular speed, and an axis.
struct DeckCentrifugal {
    std::vector<Index> cells;
    double square = 0;
    Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
    std::string place;
};

struct DeckStep {
    std::string place;
    bool dynamic = false, direct = false;
    bool nlgeom = false;        ///< its own, or of a step before it
    std::optional<bool> ramped; ///< what has no amplitude changes linearly; not given: in statics, but not in dynamics
    double alpha = -0.05;       ///< of Hilber, Hughes and Taylor; CalculiX's default
    double increment = 1, duration = 1;
    std::vector<DeckValues> held, forces;
    std::vector<DeckRigidValue> rigid_held, rigid_forces;
    std::vector<DeckPressure> pressures;
    std::vector<DeckGravity> gravity;
    std::vector<DeckCentrifugal> centrifugal;
    std::vector<DeckTemperature> temperatures;
    std::map<std::string, double> friction;             ///< by interactions, in capitals: from this step on
    std::map<std::string, DeckOverclosure> overclosure; ///< likewise
    std::vector<std::tuple<std::string, std::string, bool>>
        pairs;                                                   ///< slave, master, whether in force from this step on
    bool forget_held = false, forget_forces = false;             ///< OP=NEW
    bool forget_on_elements = false, forget_on_surfaces = false; ///< OP=NEW of *DLOAD, of *DSLOAD

    [[nodiscard]] bool ramps() const { return ramped.value_or(!dynamic); }
};

struct DeckModel {
    mesh::DeckMesh mesh;
    std::map<std::string, DeckMaterial> materials; ///< by names in capitals
    std::vector<DeckSection> sections;
    std::map<std::string, std::array<Vec3, 2>> orientations; ///< by names in capitals: first axis, and one of its plane
    std::map<std::string, DeckInteraction> interactions;     ///< by names in capitals
    std::vector<DeckPair> pairs, ties;
    DeckGeneralContact general;
    std::vector<DeckRing> rings;
    std::vector<DeckEquation> equations;
    std::vector<DeckTransform> transforms;
    std::map<Index, std::size_t> transform_of; ///< number of the last transform of a point
    std::vector<DeckValues> held;              ///< in all steps
    std::vector<DeckRigid> rigid;
    std::map<Index, std::size_t> rigid_of;  ///< number of the rigid body of a reference node
    std::map<Index, std::size_t> turned_by; ///< the same of a node whose displacements are rotations
    std::vector<DeckRigidValue> rigid_held; ///< in all steps
    std::vector<DeckTemperature> initial_temperatures;
    std::map<std::string, Amplitude> amplitudes;
    std::vector<DeckStep> steps;
    std::vector<LeftOut> left_out;

    /// Loses something of the deck.
    void lose(const std::string& place, const std::string& what, const std::string& why) {
        left_out.push_back({place, what, why, true});
    }
    /// Has something otherwise than the deck, or leaves out what bodies do without.
    void note(const std::string& place, const std::string& what, const std::string& why) {
        left_out.push_back({place, what, why, false});
    }
    /// Whether a point is on the axis of its cylindrical axes, so that no direction is radial.
    [[nodiscard]] bool on_axis(Index point) const;
    /// Axes of a point that is not, in columns.
    [[nodiscard]] Mat3 axes_of(Index point) const;
    /// nullptr for an empty name or one that there is none of. @param name  in capitals
    [[nodiscard]] const Amplitude* amplitude(const std::string& name) const {
        const auto at = amplitudes.find(name);
        return at == amplitudes.end() ? nullptr : &at->second;
    }
};

/// Throws mesh::MeshError where the mesh cannot be read.
[[nodiscard]] DeckModel read_deck_model(const mesh::Deck& deck);

} // namespace osculate::deck
