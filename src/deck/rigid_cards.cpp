#include "deck/rigid_cards.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace osculate::deck {

RigidCards::RigidCards(const mesh::Deck& deck, DeckModel& model) : CardReader(deck, model) {
    for (auto card = deck.cards.begin(); card != deck.cards.end(); ++card) {
        const std::string word = without_blanks(card->keyword);
        if (word == "RIGIDBODY") read(*card);
        if (word == "KINEMATICCOUPLING") couple_kinematically(*card);
        if (word == "COUPLING") couple(*card, card + 1 != deck.cards.end() ? &*(card + 1) : nullptr);
    }
}

void RigidCards::read(const DeckCard& card) {
    const std::string *elements = given(card, "ELSET"), *nodes = given(card, "NSET"),
                      *reference = given(card, "REFNODE"), *turning = given(card, "ROTNODE");
    for (const char* other : {"PINNSET", "TIENSET", "ANALYTICALSURFACE", "ISOTHERMAL"})
        if (given(card, other) != nullptr)
            return lose(card, std::string(other) + " has no counterpart: elements or nodes with a REF NODE have");
    if (const std::string* at = given(card, "POSITION"); at != nullptr && in_capitals(*at) != "INPUT")
        return lose(card, "POSITION=" + *at + " has no counterpart: the reference node is where the deck has it");
    if ((elements == nullptr) == (nodes == nullptr) || reference == nullptr)
        return lose(card, "ELSET or NSET, and REF NODE are expected");
    DeckRigid rigid;
    if (elements != nullptr) {
        rigid.cells = cells_of(*elements);
        rigid.elements = *elements;
        if (rigid.cells.empty()) return lose(card, "no element set '" + *elements + "'");
    } else {
        rigid.points = points_of(*nodes);
        rigid.set = in_capitals(*nodes);
        if (rigid.points.empty()) return lose(card, "no node set '" + *nodes + "'");
    }
    add(card, std::move(rigid), reference);
    if (turning == nullptr) return;
    const std::vector<Index> points = points_of(*turning);
    if (points.size() != 1) return lose(card, "ROT NODE=" + *turning + " is not one node");
    const std::vector<Index> own = points_of(*reference);
    if (own.size() == 1 && model_.rigid_of.contains(own.front()))
        model_.turned_by.emplace(points.front(), model_.rigid_of.at(own.front()));
}

void RigidCards::couple(const DeckCard& card, const DeckCard* kind) {
    const std::string word = kind == nullptr ? "" : without_blanks(kind->keyword);
    const std::string* surface = given(card, "SURFACE");
    if (word != "KINEMATIC" && word != "DISTRIBUTING")
        return lose(card, "*KINEMATIC or *DISTRIBUTING is expected after it");
    if (surface == nullptr) return lose(card, "SURFACE is expected");
    for (const char* other : {"ORIENTATION", "INFLUENCERADIUS"})
        if (given(card, other) != nullptr) return lose(card, std::string(other) + " has no counterpart");
    DeckRigid rigid;
    rigid.distributing = word == "DISTRIBUTING";
    if (!has_components(*kind, 0, 3)) return lose(*kind, "only a coupling of all displacements has a counterpart");
    if (rigid.distributing && kind->first == kind->last)
        note(*kind, "moments go to the surface, as in Abaqus; CalculiX passes them on only if 4 to 6 are listed");
    if (rigid.distributing && kind->first != kind->last && !has_components(*kind, 0, 6))
        return lose(*kind, "one that passes on no moments has no counterpart: all of 1 to 6 are expected");
    if (const std::string* weights = given(*kind, "WEIGHTINGMETHOD");
        weights != nullptr && in_capitals(*weights) != "UNIFORM")
        return lose(*kind, "WEIGHTING METHOD=" + *weights + " has no counterpart: loads are shared by area");
    rigid.points = points_on(*surface);
    rigid.set = in_capitals(*surface);
    if (rigid.points.empty()) return lose(card, "no node set or surface '" + *surface + "'");
    add(card, std::move(rigid), given(card, "REFNODE"));
}

void RigidCards::couple_kinematically(const DeckCard& card) {
    if (given(card, "ORIENTATION") != nullptr) return lose(card, "ORIENTATION has no counterpart");
    if (!has_components(card, 1, 3)) return lose(card, "only a coupling of all displacements has a counterpart");
    DeckRigid rigid;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        const std::vector<Index> points = points_of(fields_[0]);
        if (points.empty()) return lose(card, "no node or node set '" + std::string(fields_[0]) + "'");
        rigid.points.insert(rigid.points.end(), points.begin(), points.end());
        rigid.set = in_capitals(std::string(fields_[0]));
    }
    if (rigid.points.empty()) return lose(card, "no node set");
    add(card, std::move(rigid), given(card, "REFNODE"));
}

bool RigidCards::has_components(const DeckCard& card, std::size_t first, long long count) {
    if (first == 0 && card.first == card.last) return true; // none given: all
    std::map<std::string, std::set<long long>> by_name;     // of a line's nodes
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        std::set<long long>& components = by_name[first == 0 ? std::string() : std::string(fields_[0])];
        long long begin = 1, end = 0;
        if (fields_.size() <= first || fields_[first].empty()) {
            components.insert({1, 2, 3});
            continue;
        }
        if (!to_integer(fields_[first], begin)) return false;
        end = begin;
        if (fields_.size() > first + 1 && !fields_[first + 1].empty() && !to_integer(fields_[first + 1], end))
            return false;
        for (long long c = begin; c <= std::min(end, 6ll); ++c) components.insert(c);
    }
    return std::ranges::all_of(by_name, [&](const auto& one) {
        for (long long c = 1; c <= count; ++c)
            if (!one.second.contains(c)) return false;
        return true;
    });
}

std::vector<Index> RigidCards::points_on(const std::string& name) {
    const auto at = model_.mesh.surface_names.find(in_capitals(name));
    if (at == model_.mesh.surface_names.end() || !model_.mesh.raw.surfaces.contains(at->second)) return points_of(name);
    std::vector<Index> points;
    for (const mesh::RawFace& face : model_.mesh.raw.surfaces.at(at->second))
        points.insert(points.end(), face.nodes.begin(), face.nodes.begin() + face.count);
    return points;
}

void RigidCards::add(const DeckCard& card, DeckRigid rigid, const std::string* reference) {
    if (reference == nullptr) return lose(card, "REF NODE is expected");
    rigid.place = deck_.place(card);
    const std::vector<Index> points = points_of(*reference);
    if (points.size() != 1) return lose(card, "REF NODE=" + *reference + " is not one node");
    rigid.reference = points.front();
    std::ranges::sort(rigid.points);
    rigid.points.erase(std::unique(rigid.points.begin(), rigid.points.end()), rigid.points.end());
    std::erase(rigid.points, rigid.reference);
    if (!model_.rigid_of.try_emplace(rigid.reference, model_.rigid.size()).second)
        return lose(card, "another *RIGID BODY or *COUPLING has the same reference node");
    model_.rigid.push_back(std::move(rigid));
}

template <class Add> void RigidCards::take_out(DeckValues& values, const Add& add) {
    std::erase_if(values.points, [&](Index p) {
        const auto turned = model_.turned_by.find(p),
                   at = turned != model_.turned_by.end() ? turned : model_.rigid_of.find(p);
        if (at == model_.rigid_of.end()) return false;
        if (model_.transform_of.contains(p))
            model_.lose(values.place, "a reference node with a *TRANSFORM",
                        "rigid bodies move along the axes of the scene");
        else
            add(at->second, turned != model_.turned_by.end());
        return true;
    });
}

void RigidCards::hold(DeckValues& values, const std::vector<int>& components, DeckStep* step) {
    auto& to = step != nullptr ? step->rigid_held : model_.rigid_held;
    take_out(values, [&](std::size_t rigid, bool turns) {
        for (const int c : components)
            if (!turns || c <= 3)
                to.push_back({rigid, c - 1 + (turns ? 3 : 0), values.value, values.amplitude, values.place});
    });
}

void RigidCards::load(DeckValues& values, int component, DeckStep* step) {
    take_out(values, [&](std::size_t rigid, bool turns) {
        if (!turns || component <= 3)
            step->rigid_forces.push_back(
                {rigid, component - 1 + (turns ? 3 : 0), values.value, values.amplitude, values.place});
    });
}

} // namespace osculate::deck
