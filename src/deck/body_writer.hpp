#pragma once
/// Bodies of a scene, with their materials, from those of a deck.

#include "deck/bodies.hpp"
#include "deck/loads.hpp"
#include "deck/rigid_bodies.hpp"

#include <string>
#include <vector>

namespace osculate::deck {

class BodyWriter {
public:
    /// @param path    of the deck, as the scene names it
    /// @param nlgeom  whether a step is at finite strain: bodies have one law for all steps
    BodyWriter(DeckModel& model, const std::vector<DeckBody>& bodies, const DeckRigidBodies& rigid, const Units& units,
               std::string path, bool nlgeom)
        : model_(model), bodies_(bodies), rigid_(rigid), units_(units), path_(std::move(path)), nlgeom_(nlgeom) {}

    /// The entries of `bodies`. Adds to what the model leaves out.
    [[nodiscard]] std::string write();

private:
    /// Of a material whose moduli depend on temperature: those of the one temperature that the body has at the ends of all
    /// steps.
    std::array<double, 2> at_temperature(const DeckMaterial& m, const DeckBody& body);
    std::string orthotropic_of(const DeckSection& section, const DeckMaterial& m);
    /// @param section  null: none
    std::string material_of(const DeckBody& body, const DeckSection* section);

    DeckModel& model_;
    const std::vector<DeckBody>& bodies_;
    const DeckRigidBodies& rigid_;
    const Units& units_;
    std::string path_;
    bool nlgeom_;
};

} // namespace osculate::deck
