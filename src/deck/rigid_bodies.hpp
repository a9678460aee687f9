#pragma once
/// Rigid bodies of a scene, with what fixes, moves and loads them.

#include "deck/bodies.hpp"
#include "deck/loads.hpp"

#include <array>
#include <string>
#include <vector>

namespace osculate::deck {

class DeckRigidBodies {
public:
    /// Adds motions, forces and moments to the stages.
    DeckRigidBodies(DeckModel& model, const std::vector<DeckBody>& bodies, DeckSets& sets, const Units& units,
                    std::vector<StageLoads>& stages);

    /// The value of `rigid` of a body that is.
    [[nodiscard]] std::string of(const DeckBody& body) const;
    /// The entries of `couplings`.
    [[nodiscard]] const std::string& couplings() const { return couplings_; }

private:
    struct Motion {
        std::array<bool, 6> fixed{};              ///< in all steps
        std::array<bool, 6> held{};               ///< in all steps, or driven
        std::vector<std::string> motions;         ///< by step
        std::vector<std::string> forces, moments; ///< by step
    };
    Motion motion_of(std::size_t rigid);
    void hold(std::size_t rigid, std::size_t component, Motion& motion);
    void load(std::size_t rigid, Motion& motion);
    [[nodiscard]] double density(const DeckBody& body) const;
    void couple(std::size_t rigid, const std::vector<DeckBody>& bodies, DeckSets& sets,
                std::vector<StageLoads>& stages);
    void put(const std::string& name, const Motion& motion, std::vector<StageLoads>& stages) const;
    [[nodiscard]] std::string at_reference(std::size_t rigid) const;
    [[nodiscard]] std::string fixed(const Motion& motion) const;

    DeckModel& model_;
    const Units& units_;
    std::vector<Motion> motions_; ///< of DeckModel::rigid
    std::set<std::string> taken_; ///< names of bodies and couplings
    std::string couplings_;
};

} // namespace osculate::deck
