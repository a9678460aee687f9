#include "mesh/deck/planes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace osculate::mesh {

std::optional<PlaneType> deck_plane_type(std::string_view name) {
    if (name.ends_with('R')) name.remove_suffix(1);
    if (name.size() != 4) return std::nullopt;
    PlaneType type;
    const std::string_view kind = name.substr(0, 3);
    type.slice = kind == "CPE"   ? DeckSlice::plane_strain
                 : kind == "CPS" ? DeckSlice::plane_stress
                 : kind == "CAX" ? DeckSlice::axisymmetric
                                 : DeckSlice::none;
    type.nodes = name[3] - '0';
    switch (type.nodes) {
    case 3: type.solid = CellType::wedge6; break;
    case 4: type.solid = CellType::hex8; break;
    case 6: type.solid = CellType::wedge15; break;
    case 8: type.solid = CellType::hex20; break;
    default: return std::nullopt;
    }
    if (type.slice == DeckSlice::none) return std::nullopt;
    return type;
}

DeckPlanes::DeckPlanes(DeckReading& reading, DeckMesh& mesh) : reading_(reading), mesh_(mesh) {
    std::vector<std::string_view> fields;
    for (const DeckCard& card : reading.deck.cards) {
        const std::string* set = card.parameter("ELSET");
        if (card.keyword != "SOLID SECTION" || set == nullptr) continue;
        double value = 1;
        if (card.first != card.last) {
            split_fields(reading.deck.begin(card)->text, fields);
            if (!fields.empty() && !fields[0].empty() && (!to_number(fields[0], value) || !(value > 0))) value = 1;
        }
        of_set_[in_capitals(*set)] = value;
    }
}

double DeckPlanes::thickness(const DeckCard& card) {
    if (of_set_.empty()) return 1;
    const std::string* set = card.parameter("ELSET");
    if (set != nullptr)
        if (const auto at = of_set_.find(in_capitals(*set)); at != of_set_.end()) return at->second;
    const double first = of_set_.begin()->second;
    if (std::ranges::all_of(of_set_, [&](const auto& one) { return one.second == first; })) return first;
    reading_.fault(card,
                   "*ELEMENT: sections of other sets have several thicknesses; its own ELSET must have a section");
    return 0;
}

Index DeckPlanes::above(Index point, const PlaneType& type, double thickness, double share) {
    const auto [at, fresh] = made_.try_emplace({point, type.slice, thickness, share}, -1);
    if (!fresh) return at->second;
    Vec3 x = mesh_.raw.points[static_cast<std::size_t>(point)];
    if (type.slice == DeckSlice::axisymmetric) {
        const double angle = share * DeckMesh::sector_angle * std::numbers::pi / 180;
        x = Vec3(x[0] * std::cos(angle), x[1], x[2] + x[0] * std::sin(angle));
    } else {
        x[2] += share * thickness;
    }
    at->second = static_cast<Index>(mesh_.raw.points.size());
    mesh_.raw.points.push_back(x);
    mesh_.raw.point_ids.push_back(mesh_.raw.point_ids[static_cast<std::size_t>(point)]);
    mesh_.above[point].push_back(at->second);
    return at->second;
}

void DeckPlanes::leave_axis(const std::vector<Index>& points) {
    if (bore_ == 0) {
        Eigen::AlignedBox3d box;
        for (const Vec3& x : mesh_.raw.points) box.extend(x);
        bore_ = DeckMesh::bore * box.diagonal().norm();
    }
    const auto radius = [&](Index point) -> double& { return mesh_.raw.points[static_cast<std::size_t>(point)][0]; };
    double largest = 0;
    for (const Index point : points) largest = std::max(largest, radius(point));
    constexpr double round_off = 1e-9, small = 0.2;
    if (bore_ > small * largest) return; // elements too fine for it are refused, as they have no volume there
    for (const Index point : points)
        if (std::abs(radius(point)) <= round_off * largest) {
            radius(point) = bore_;
            ++mesh_.bored;
        }
}

bool DeckPlanes::lie_in_plane(const std::vector<Index>& points) const {
    Eigen::AlignedBox3d box;
    for (const Index point : points) box.extend(mesh_.raw.points[static_cast<std::size_t>(point)]);
    constexpr double small = 1e-6; // of the element: rounded coordinates
    return box.sizes()[2] <= small * box.diagonal().norm();
}

RawCell DeckPlanes::layer(const PlaneType& type, const std::vector<Index>& points, double thickness) {
    if (type.slice == DeckSlice::axisymmetric) leave_axis(points);
    const std::size_t corners = points.size() > 4 ? points.size() / 2 : points.size();
    std::vector<Index> all;
    const auto add = [&](std::size_t first, std::size_t last, double share) {
        for (std::size_t i = first; i < last; ++i)
            all.push_back(share == 0 ? points[i] : above(points[i], type, thickness, share));
    };
    add(0, corners, 0);
    add(0, corners, 1);
    if (points.size() > corners) {
        add(corners, points.size(), 0);
        add(corners, points.size(), 1);
        add(0, corners, 0.5);
    }
    RawCell cell;
    cell.type = type.solid;
    const CellInfo& info = cell_info(type.solid);
    for (std::size_t i = 0; i < all.size(); ++i) cell.nodes[i] = all[static_cast<std::size_t>(info.from_deck[i])];
    return cell;
}

} // namespace osculate::mesh
