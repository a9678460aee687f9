#pragma once
/// What an input deck says beside its mesh, as far as a scene can say it too.

#include "osculate/mesh/deck_mesh.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osculate::deck {

/// Something of a deck that the scene does not have, or not as it stands there.
struct LeftOut {
    std::string place; ///< file:line
    std::string what, why;
};

struct DeckMaterial {
    std::string name, place;
    std::optional<std::array<double, 2>> elastic;     ///< E, nu
    std::optional<std::array<double, 2>> neo_hookean; ///< C10, D1
    double density = 0;
};

struct DeckSection {
    std::vector<Index> cells;
    std::string elements, material; ///< names; the material's in capitals
    std::string place;
};

struct DeckPair {
    std::string slave, master, interaction; ///< in capitals
    bool mortar = false;                    ///< surface to surface
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

struct DeckPressure {
    std::vector<mesh::RawFace> faces;
    std::string name; ///< what the deck calls them
    double value = 0;
    std::string amplitude, place;
};

struct DeckGravity {
    std::vector<Index> cells;
    Vec3 acceleration = Vec3::Zero();
    std::string amplitude, place;
};

struct DeckStep {
    std::string place;
    bool dynamic = false, nlgeom = false, direct = false;
    double alpha = -0.05; ///< of Hilber, Hughes and Taylor; CalculiX's default
    double increment = 1, duration = 1;
    std::vector<DeckValues> held, forces;
    std::vector<DeckPressure> pressures;
    std::vector<DeckGravity> gravity;
    bool forget_held = false, forget_forces = false, forget_pressures = false; ///< OP=NEW
};

struct DeckModel {
    mesh::DeckMesh mesh;
    std::map<std::string, DeckMaterial> materials; ///< by names in capitals
    std::vector<DeckSection> sections;
    std::map<std::string, double> friction; ///< by interaction
    std::vector<DeckPair> pairs;
    std::vector<DeckValues> held; ///< in all steps
    std::map<std::string, std::vector<std::array<double, 2>>> amplitudes;
    std::vector<DeckStep> steps;
    std::vector<LeftOut> left_out;
};

/// Throws mesh::MeshError where the mesh cannot be read.
[[nodiscard]] DeckModel read_deck_model(const mesh::Deck& deck);

} // namespace osculate::deck
