#pragma once
/// What the steps of a deck load, as loads of a scene's stages.

#include "deck/bodies.hpp"
#include "deck/load_history.hpp"
#include "deck/model.hpp"

#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osculate::deck {

/// Metres, pascals and kg/m^3 per unit of the deck.
struct Units {
    double length, stress, density;
    const char* words;
    [[nodiscard]] double force() const { return stress * length * length; } ///< N
};

/// Entries of a stage: name of a set or a body -> value as a scene has it.
struct StageLoads {
    std::map<std::string, std::string> displacement, pressure, follower_pressure, body_force, nodal_force, temperature,
        release, friction, overclosure, pairs, centrifugal, motion, force, moment;
};

/// Three components as a list at the end of a step, empty where none of them has a load in it.
[[nodiscard]] std::string end_components(std::array<LoadHistory, 3>& components, const DeckStep& step);

/// Pressures are kept face by face and gravity body by body over all steps, so that what a step changes on some faces stays on
/// the others; faces with the same history become a set.
class DeckLoads {
public:
    /// @param follow  pressures turn and stretch with their faces
    DeckLoads(DeckModel& model, const std::vector<DeckBody>& bodies, DeckSets& sets, const Units& units, bool follow);

    /// Of all steps. What has no counterpart is lost in the model.
    void write(std::vector<StageLoads>& stages);

private:
    struct FacetKey {
        bool follows = false;
        std::size_t body = 0;
        Index facet = 0; ///< of DeckBody::exterior
        auto operator<=>(const FacetKey&) const = default;
    };
    struct FacetLoad {
        LoadHistory history;
        std::vector<std::string> courses; ///< by step; empty where the step leaves it
        std::set<std::string> names;      ///< for a set
        std::string place;                ///< of the first load
    };
    struct NodeForce {
        std::array<LoadHistory, 3> components;
        std::vector<std::string> courses; ///< by step, of all three; empty where the step leaves them
        std::string place;                ///< of the first force
    };

    /// Faces that are loaded more than once, and where the first of these loads stands.
    struct Repeated {
        std::size_t faces = 0;
        std::string place;
        void count(const std::string& where) {
            if (faces++ == 0) place = where;
        }
    };

    void forget(const DeckStep& step);
    void add_pressures(const DeckStep& step);
    [[nodiscard]] std::set<std::pair<std::size_t, Index>> facets_of(const DeckPressure& p);
    void add_forces(const DeckStep& step);
    void add_gravity(const DeckStep& step);
    /// Gravity on some elements of a body each, that add up to the same in all of them.
    void add_partial_gravity(std::size_t body, const std::vector<const DeckGravity*>& parts);
    /// Of whole bodies; what a step gives a body takes the place of what it had.
    void add_centrifugal(const DeckStep& step, StageLoads& stage);
    void add_acceleration(std::size_t body, const std::string& origin, const Vec3& acceleration,
                          const std::string& amplitude);
    FacetLoad& facet_load(const FacetKey& key, const std::string& name, const std::string& place);
    void end_step(std::size_t s, StageLoads& stage);
    void write_pressures(std::vector<StageLoads>& stages);
    void write_forces(std::vector<StageLoads>& stages);
    void write_temperatures(std::vector<StageLoads>& stages);
    [[nodiscard]] std::vector<const DeckMaterial*> materials(const DeckBody& body) const;
    /// Largest of its materials.
    [[nodiscard]] double density(const DeckBody& body) const;

    DeckModel& model_;
    const std::vector<DeckBody>& bodies_;
    DeckSets& sets_;
    Units units_;
    bool follow_;
    std::map<std::array<Index, 4>, std::pair<std::size_t, Index>> exterior_; ///< by corners: body and facet
    std::map<FacetKey, FacetLoad> facets_;
    std::vector<std::array<LoadHistory, 3>> gravity_; ///< by body, N/m^3
    std::set<std::size_t> turning_;                   ///< bodies
    std::map<Index, NodeForce> forces_;               ///< by point of the deck
};

} // namespace osculate::deck
