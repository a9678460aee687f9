#pragma once
/// The bodies of a deck, and sets of a scene for groups of their nodes and facets.

#include "deck/model.hpp"
#include "osculate/mesh/mesh.hpp"

#include <set>
#include <string>
#include <vector>

namespace osculate::deck {

/// A connected piece of a deck's mesh.
struct DeckBody {
    std::string name; ///< fit for a scene
    int piece = 0;    ///< as in a scene
    std::vector<Index> cells;
    mesh::Mesh mesh;
    std::vector<Index> points; ///< of the deck, of every node
    std::vector<mesh::Facet> exterior;
    const DeckRigid* rigid = nullptr;               ///< that it is, or a piece of
    const DeckSection* section = nullptr;           ///< the one that most of its elements have
    std::vector<const DeckSection*> other_sections; ///< of its other elements; of several that have one the last counts
    bool joined_at_nodes = false;                   ///< mesh::Repair::keep_non_manifold
    std::string formulation;                        ///< of its hexahedra
    mesh::DeckSlice slice = mesh::DeckSlice::none;
};

/// Throws mesh::MeshError where a piece is no mesh fit for use. Adds to what the model leaves out.
[[nodiscard]] std::vector<DeckBody> make_bodies(DeckModel& model);

/// Sets of a scene, made as they are asked for.
class DeckSets {
public:
    /// @param scale  metres per unit of the deck
    DeckSets(const DeckModel& model, const std::vector<DeckBody>& bodies, double scale);

    /// Names of sets that have just these points of a body: a node set of the deck, a box around them, their numbers, or a box
    /// each where points of a layer share a number. Throws mesh::MeshError where nothing tells two points apart.
    std::vector<std::string> of_points(std::size_t body, const std::vector<Index>& points, const std::string& wanted);
    /// A set with just these facets, empty where there is none. @param facets  of DeckBody::exterior
    std::string of_facets(std::size_t body, const std::vector<Index>& facets, const std::string& wanted);
    /// A surface of the deck, or a node set that serves as one; empty where the body has no share in it.
    std::string of_surface(std::size_t body, const std::string& in_capitals);

    [[nodiscard]] int body_of(Index point) const { return body_of_[static_cast<std::size_t>(point)]; }
    [[nodiscard]] bool is_rigid(Index point) const {
        return body_of(point) >= 0 && bodies_[static_cast<std::size_t>(body_of(point))].rigid != nullptr;
    }
    [[nodiscard]] Index node_of(Index point) const { return node_of_[static_cast<std::size_t>(point)]; }
    [[nodiscard]] const std::string& yaml() const { return yaml_; } ///< the entries of `sets`

private:
    /// Empty where neither a node set nor a box has just these points.
    std::string of_points_as_one(std::size_t body, const std::vector<Index>& points, const std::string& wanted);
    std::string add(std::size_t body, const std::string& wanted, const std::string& selection);
    std::string box_around(const std::vector<Index>& points) const;
    bool box_has_just(const DeckBody& body, const std::vector<Index>& points) const;
    Eigen::AlignedBox3d box_of(const std::vector<Index>& points) const;

    const DeckModel& model_;
    const std::vector<DeckBody>& bodies_;
    double scale_, tolerance_;
    std::vector<int> body_of_;
    std::vector<Index> node_of_;
    std::vector<char> numbered_alone_; ///< whether no other point of the body has its number
    std::set<std::string> taken_;
    std::map<std::string, std::string> known_; ///< body and selection -> name
    std::string yaml_;
};

} // namespace osculate::deck
