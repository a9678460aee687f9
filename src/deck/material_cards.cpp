#include "deck/material_cards.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>

namespace osculate::deck {

bool MaterialCards::take(const DeckCard& card, const std::string& word, bool in_step) {
    if (word == "MATERIAL")
        begin_material(card);
    else if (word == "ELASTIC" || word == "DENSITY" || word == "HYPERELASTIC")
        material_data(card);
    else if (word == "PLASTIC")
        hardening(card);
    else if (word == "EXPANSION")
        expansion(card);
    else if (word == "DAMPING" && !in_step)
        damping(card);
    else if (word == "ORIENTATION")
        orientation(card);
    else
        return false;
    return true;
}

void MaterialCards::begin_material(const DeckCard& card) {
    const std::string* name = card.parameter("NAME");
    material_ = name == nullptr ? "" : in_capitals(*name);
    DeckMaterial& m = model_.materials[material_];
    m.name = name == nullptr ? "" : *name;
    m.place = deck_.place(card);
}

void MaterialCards::damping(const DeckCard& card) {
    const auto found = model_.materials.find(material_);
    if (found == model_.materials.end()) return lose(card, "no *MATERIAL stands before it");
    for (const char* name : {"STRUCTURAL", "COMPOSITE"})
        if (given(card, name) != nullptr) return lose(card, std::string(name) + " has no counterpart");
    const char* const names[] = {"ALPHA", "BETA"};
    for (std::size_t k = 0; k < 2; ++k)
        if (const std::string* value = given(card, names[k]);
            value != nullptr && (!to_number(*value, found->second.damping[k]) || found->second.damping[k] < 0)) {
            found->second.damping[k] = 0;
            lose(card, std::string(names[k]) + " is no number, or negative");
        }
}

void MaterialCards::expansion(const DeckCard& card) {
    const auto found = model_.materials.find(material_);
    if (found == model_.materials.end() || card.first == card.last) return lose(card, "no material, or no data");
    const std::string type = capitals_of(card, "TYPE");
    if (!type.empty() && type != "ISO") return lose(card, "only isotropic expansion has a counterpart");
    DeckMaterial& m = found->second;
    if (const std::string* zero = card.parameter("ZERO"); zero != nullptr && !to_number(*zero, m.zero))
        return lose(card, "ZERO is no number");
    m.expansion = numbers(*deck_.begin(card), 1)[0];
    if (card.last - card.first == 1) return;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        const std::vector<double> v = numbers(*line, 2);
        if (!m.expansions.empty() && v[1] <= m.expansions.back()[0]) return lose(card, "temperatures must ascend");
        m.expansions.push_back({v[1], v[0]});
    }
    for (const auto& [t, a] : m.expansions) // what the scene has, other expansions are scaled to it
        if (m.expansion == 0) m.expansion = a;
    note(card, "temperatures are scaled so that thermal strains at the ends of steps are those of the table");
}

void MaterialCards::hardening(const DeckCard& card) {
    const auto found = model_.materials.find(material_);
    if (found == model_.materials.end()) return lose(card, "no *MATERIAL stands before it");
    const std::string kind = capitals_of(card, "HARDENING");
    if (!kind.empty() && kind != "ISOTROPIC") return lose(card, "only isotropic hardening has a counterpart");
    std::vector<std::array<double, 2>> rows;
    std::optional<double> temperature;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        const std::vector<double> v = numbers(*line, 2);
        if (v.size() > 2 && v[2] != temperature.value_or(v[2])) {
            return lose(card, "yield stresses that depend on temperature have no counterpart");
        }
        if (v.size() > 2) temperature = v[2];
        if (!(v[0] > 0) || v[1] < 0 || (rows.empty() ? v[1] != 0 : v[1] <= rows.back()[0]))
            return lose(card, "yield stresses over plastic strains that ascend from 0 have a counterpart");
        rows.push_back({v[1], v[0]});
    }
    if (rows.empty()) return lose(card, "it has no data");
    found->second.hardening = std::move(rows);
}

void MaterialCards::orthotropic(const DeckCard& card, bool constants, DeckMaterial& m) {
    std::vector<double> v;
    for (auto line = deck_.begin(card); line != deck_.end(card) && v.size() < 9; ++line)
        for (const double value : numbers(*line, 1))
            if (v.size() < 9) v.push_back(value);
    if (v.size() < 9 || card.last - card.first > 2) return lose(card, "nine constants have a counterpart");
    if (constants) {
        m.orthotropic = {v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]};
        return;
    }
    Mat3 D; // normal stresses over strains
    D << v[0], v[1], v[3], v[1], v[2], v[4], v[3], v[4], v[5];
    const Mat3 C = D.inverse();
    if (!C.allFinite() || !(C.diagonal().minCoeff() > 0) || !(std::min({v[6], v[7], v[8]}) > 0))
        return lose(card, "some strains store no energy");
    m.orthotropic = {1 / C(0, 0), 1 / C(1, 1), 1 / C(2, 2), -C(1, 0) / C(0, 0), -C(2, 0) / C(0, 0), -C(2, 1) / C(1, 1),
                     v[6],        v[7],        v[8]};
}

void MaterialCards::orientation(const DeckCard& card) {
    const std::string system = capitals_of(card, "SYSTEM");
    if (!system.empty() && system != "RECTANGULAR") return lose(card, "only rectangular axes have a counterpart");
    const std::string definition = capitals_of(card, "DEFINITION");
    if (!definition.empty() && definition != "COORDINATES")
        return lose(card, "only axes through points have a counterpart");
    const std::size_t lines = card.last - card.first;
    if (lines < 1 || lines > 2) return lose(card, "two or three points, and an angle, have a counterpart");
    const std::vector<double> v = numbers(*deck_.begin(card), 9);
    const Vec3 origin(v[6], v[7], v[8]);
    std::array<Vec3, 2> axes{Vec3(v[0], v[1], v[2]) - origin, Vec3(v[3], v[4], v[5]) - origin};
    if (!(axes[0].cross(axes[1]).norm() > 0)) return lose(card, "its points are on one line");
    if (lines == 2) { // about one of these axes
        const std::vector<double> turn = numbers(*(deck_.begin(card) + 1), 2);
        const Vec3 x = axes[0].normalized(), z = axes[0].cross(axes[1]).normalized(), y = z.cross(x);
        const double about = turn[0] == 0 ? 1 : turn[0]; // an empty field is the first axis
        if ((about != 1 && about != 2 && about != 3) || turn.size() > 2)
            return lose(card, "an axis from 1 to 3 and an angle are expected in its second line");
        if (turn[1] != 0) {
            const Eigen::AngleAxisd rotation(turn[1] * std::numbers::pi / 180, about == 1 ? x : about == 2 ? y : z);
            axes = {rotation * x, rotation * y};
        }
    }
    model_.orientations[capitals_of(card, "NAME")] = axes;
}

void MaterialCards::material_data(const DeckCard& card) {
    const auto found = model_.materials.find(material_);
    if (found == model_.materials.end()) return lose(card, "no *MATERIAL stands before it");
    if (card.first == card.last) return lose(card, "it has no data");
    if (card.last - card.first > 1 && card.keyword != "ELASTIC")
        note(card, "only its first line counts: nothing depends on temperature");
    const std::vector<double> v = numbers(*deck_.begin(card), 2);
    if (card.keyword == "DENSITY") {
        found->second.density = v[0];
    } else if (card.keyword == "ELASTIC") {
        const std::string type = capitals_of(card, "TYPE");
        if (type == "ORTHO" || type == "ORTHOTROPIC" || type == "ENGINEERINGCONSTANTS" ||
            type == "ENGINEERING CONSTANTS")
            return orthotropic(card, type.starts_with("ENG"), found->second);
        if (!type.empty() && type != "ISO" && type != "ISOTROPIC")
            return lose(card, "materials are isotropic or orthotropic");
        found->second.elastic = {v[0], v[1]};
        for (auto line = deck_.begin(card); card.last - card.first > 1 && line != deck_.end(card); ++line) {
            const std::vector<double> row = numbers(*line, 3);
            auto& table = found->second.by_temperature;
            if (!table.empty() && row[2] <= table.back()[0]) return lose(card, "temperatures must ascend");
            table.push_back({row[2], row[0], row[1]});
        }
    } else {
        if (card.parameter("NEOHOOKE") == nullptr) return lose(card, "only NEO HOOKE has a counterpart");
        found->second.neo_hookean = {v[0], v[1]};
        note(card, "neo_hookean has the same moduli at small strain; at large strain its volumetric part differs");
    }
}

} // namespace osculate::deck
