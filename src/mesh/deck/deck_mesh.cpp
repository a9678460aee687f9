#include "osculate/mesh/deck_mesh.hpp"

#include "mesh/deck/elements.hpp"
#include "mesh/deck/numbers.hpp"
#include "mesh/deck/planes.hpp"
#include "mesh/deck/reading.hpp"
#include "mesh/deck/sets.hpp"
#include "mesh/deck/shells.hpp"
#include "mesh/deck/surfaces.hpp"

#include <algorithm>
#include <utility>

namespace osculate::mesh {
namespace {

/// Name of the type of an *ELEMENT line, in capitals; empty where none is given.
std::string type_name(const DeckCard& card) {
    const std::string* given = card.parameter("TYPE");
    return given == nullptr ? "" : in_capitals(*given);
}

class Reader {
public:
    explicit Reader(const Deck& deck) : deck_(deck), reading_{deck} {}

    DeckMesh read() {
        mesh_.raw.instances = deck_.instances;
        mesh_.raw.file = deck_.files.empty() ? "" : deck_.files.front();
        read_all_nodes();
        points_.index(reading_);
        for (const DeckCard& card : deck_.cards)
            if (card.keyword == "ELEMENT") read_elements(card);
        mesh_.raw.elsewhere.assign(mesh_.raw.points.size(), 0);
        cells_.index(reading_);
        read_sets_and_surfaces();
        reading_.faults.throw_if_any();
        mesh_.raw.node_sets = node_sets_.take_sets();
        mesh_.raw.parts = element_sets_.take_sets();
        mesh_.node_set_names = node_sets_.take_names();
        mesh_.element_set_names = element_sets_.take_names();
        mesh_.point_order = points_.take_order();
        mesh_.cell_order = cells_.take_order();
        return std::move(mesh_);
    }

private:
    void read_all_nodes() {
        for (const DeckCard& card : deck_.cards) {
            if (card.keyword == "SYSTEM") reading_.fault(card, "*SYSTEM: nodes in other axes are not read");
            if (card.keyword == "NODE") read_nodes(card);
        }
    }

    void read_nodes(const DeckCard& card) {
        if (const std::string* system = card.parameter("SYSTEM"); system != nullptr && in_capitals(*system) != "R")
            reading_.fault(card, "*NODE, SYSTEM=" + *system + ": only rectangular coordinates are read");
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            split_fields(line->text, fields_);
            long long id = 0;
            Vec3 x = Vec3::Zero();
            bool good = fields_.size() >= 2 && to_integer(fields_[0], id) && id > 0 && id <= DeckNumbers::largest;
            for (std::size_t d = 0; d < 3 && d + 1 < fields_.size(); ++d)
                good = good && (fields_[d + 1].empty() || to_number(fields_[d + 1], x[static_cast<Index>(d)]));
            if (!good) {
                reading_.fault(*line, "a node is its number and its coordinates, found '" + shown(line->source) + "'");
                continue;
            }
            points_.add(id, static_cast<Index>(mesh_.raw.points.size()));
            mesh_.raw.points.push_back(x);
            mesh_.raw.point_ids.push_back(id);
        }
    }

    void read_elements(const DeckCard& card) {
        const std::string name = type_name(card);
        const CellInfo* type = deck_element_type(name);
        const std::optional<PlaneType> plane = deck_plane_type(name);
        const int shell = DeckShells::nodes_of(name);
        if (type == nullptr && !plane && shell == 0) {
            reading_.fault(card, "*ELEMENT of type '" + name + "'; only " + deck_element_names() + " are read");
            reading_.refused = true;
            return;
        }
        auto kind = std::find(mesh_.types.begin(), mesh_.types.end(), name);
        if (kind == mesh_.types.end()) kind = mesh_.types.insert(kind, name);
        const auto kind_number = static_cast<char>(kind - mesh_.types.begin());
        const auto count = static_cast<std::size_t>(nodes_of(name));
        double thickness = 0;
        if (plane) {
            if (!planes_) planes_.emplace(reading_, mesh_);
            thickness = plane->slice == DeckSlice::axisymmetric ? 0 : planes_->thickness(card);
            mesh_.slices.resize(mesh_.raw.cells.size(), DeckSlice::none);
        }
        std::vector<long long> numbers;
        for (auto line = deck_.begin(card); line != deck_.end(card);) {
            // An element goes on over as many lines as it takes.
            const DeckLine& first = *line;
            numbers.clear();
            bool good = true;
            while (good && numbers.size() <= count && line != deck_.end(card)) {
                split_fields(line->text, fields_);
                for (const std::string_view field : fields_) {
                    long long value = 0;
                    good = good && to_integer(field, value);
                    numbers.push_back(value);
                }
                ++line;
            }
            if (name == "C3D8I" && numbers.size() > count + 1) numbers.resize(count + 1); // nodes of its modes
            if (!good || numbers.size() != count + 1 || numbers[0] <= 0 || numbers[0] > DeckNumbers::largest)
                reading_.fault(first, "an element of type " + name + " is its number and " + std::to_string(count) +
                                          " nodes, found '" + shown(first.source) + "'");
            else if (plane       ? add_layer(first, *plane, thickness, numbers)
                     : shell > 0 ? add_shell(first, numbers)
                                 : add_cell(first, *type, numbers))
                mesh_.type.push_back(kind_number);
        }
    }

    /// @param numbers  the element's and its nodes'
    bool add_cell(const DeckLine& line, const CellInfo& type, const std::vector<long long>& numbers) {
        RawCell cell;
        cell.id = numbers[0];
        cell.type = type.type;
        for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
            const long long id = numbers[static_cast<std::size_t>(type.from_deck[i]) + 1];
            cell.nodes[i] = points_.look_up(id);
            if (cell.nodes[i] >= 0) continue;
            reading_.fault(line, "element " + deck_.instances.shown(cell.id) + " has node " + std::to_string(own(id)) +
                                     ", which does not exist");
            return false;
        }
        cells_.add(cell.id, static_cast<Index>(mesh_.raw.cells.size()));
        mesh_.raw.cells.push_back(cell);
        return true;
    }

    /// Points of the nodes of an element; empty, and a fault, where one does not exist.
    /// @param numbers  the element's and its nodes'
    std::vector<Index> points_of(const DeckLine& line, const std::vector<long long>& numbers) {
        std::vector<Index> points;
        for (std::size_t i = 1; i < numbers.size(); ++i) {
            points.push_back(points_.look_up(numbers[i]));
            if (points.back() >= 0) continue;
            reading_.fault(line, "element " + deck_.instances.shown(numbers[0]) + " has node " +
                                     std::to_string(own(numbers[i])) + ", which does not exist");
            return {};
        }
        return points;
    }

    bool add_shell(const DeckLine& line, const std::vector<long long>& numbers) {
        const std::vector<Index> points = points_of(line, numbers);
        if (points.empty()) return false;
        RawCell cell = shells_.begin(line, points);
        cell.id = numbers[0];
        cells_.add(cell.id, static_cast<Index>(mesh_.raw.cells.size()));
        mesh_.raw.cells.push_back(cell);
        return true;
    }

    /// The same for an element in a plane.
    bool add_layer(const DeckLine& line, const PlaneType& type, double thickness,
                   const std::vector<long long>& numbers) {
        const std::vector<Index> points = points_of(line, numbers);
        if (points.empty()) return false;
        if (!planes_->lie_in_plane(points)) {
            reading_.fault(line, "plane element " + deck_.instances.shown(numbers[0]) +
                                     " is turned out of the plane of x and y, where plane elements stay");
            return false;
        }
        RawCell cell = planes_->layer(type, points, thickness);
        cell.id = numbers[0];
        cells_.add(cell.id, static_cast<Index>(mesh_.raw.cells.size()));
        mesh_.raw.cells.push_back(cell);
        mesh_.slices.push_back(type.slice);
        return true;
    }

    /// Of an element of a type, 0 for one that is not read.
    static int nodes_of(const std::string& name) {
        if (const std::optional<PlaneType> plane = deck_plane_type(name)) return plane->nodes;
        const CellInfo* type = deck_element_type(name);
        return type == nullptr ? DeckShells::nodes_of(name) : type->nodes;
    }

    /// A number as its part has it.
    [[nodiscard]] long long own(long long id) const {
        const Instance* instance = deck_.instances.of(id);
        return instance == nullptr ? id : id - instance->before;
    }

    void read_sets_and_surfaces() {
        for (const DeckCard& card : deck_.cards) {
            if (card.keyword == "NODE") node_sets_.read_defined(card, 1);
            if (card.keyword == "ELEMENT") {
                const int nodes = nodes_of(type_name(card));
                element_sets_.read_defined(card, static_cast<std::size_t>(nodes) + 1);
            }
            if (card.keyword == "NSET" && card.parameter("ELSET") != nullptr)
                read_nodes_of(card, *card.parameter("ELSET"));
            else if (card.keyword == "NSET")
                node_sets_.read(card);
            if (card.keyword == "ELSET") element_sets_.read(card);
        }
        shells_.finish(element_sets_);
        DeckSurfaces surfaces(reading_, mesh_, node_sets_, element_sets_);
        for (const DeckCard& card : deck_.cards)
            if (card.keyword == "SURFACE") surfaces.read(card);
    }

    /// A set of the nodes of all elements of a set.
    void read_nodes_of(const DeckCard& card, const std::string& elements) {
        const std::string* name = card.parameter("NSET");
        const std::vector<Index>* cells = element_sets_.find(elements);
        if (name == nullptr || name->empty() || cells == nullptr)
            return reading_.fault(card, "*NSET without NSET=name, or no element set '" + shown(elements) +
                                            "' before this line");
        if (!reading_.generate(most_nodes_per_cell * cells->size()))
            return reading_.fault(card, "sets with too many members");
        std::vector<Index>& nodes = node_sets_.named(*name);
        for (const Index c : *cells) {
            const RawCell& cell = mesh_.raw.cells[static_cast<std::size_t>(c)];
            nodes.insert(nodes.end(), cell.begin(), cell.end());
        }
    }

    const Deck& deck_;
    DeckReading reading_;
    DeckMesh mesh_;
    DeckNumbers points_{"node"}, cells_{"element"};
    DeckSets node_sets_{reading_, points_, "NSET"}, element_sets_{reading_, cells_, "ELSET"};
    std::optional<DeckPlanes> planes_;
    DeckShells shells_{reading_, mesh_};
    std::vector<std::string_view> fields_; ///< of the line that is read
};

} // namespace

Index DeckMesh::cell(long long id) const {
    return find_id(cell_order, id);
}

Index DeckMesh::point(long long id) const {
    return find_id(point_order, id);
}

RawFace DeckMesh::face_of(Index cell, int face) const {
    const auto c = static_cast<std::size_t>(cell);
    const bool plane = c < slices.size() && slices[c] != DeckSlice::none;
    constexpr int sides = 2; // faces of the layer before those of its sides
    return (plane && face < 0) || is_shell(cell) ? RawFace{} : deck_face(raw.cells[c], plane ? face + sides : face);
}

RawFace DeckMesh::front_of(Index cell) const {
    constexpr int upper = 1; // S2
    return is_shell(cell) ? deck_face(raw.cells[static_cast<std::size_t>(cell)], upper) : RawFace{};
}

DeckMesh read_deck_mesh(const Deck& deck) {
    return Reader(deck).read();
}

DeckMesh read_deck_mesh(const std::filesystem::path& path) {
    return read_deck_mesh(read_deck(path));
}

} // namespace osculate::mesh
