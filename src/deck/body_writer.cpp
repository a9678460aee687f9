#include "deck/body_writer.hpp"

#include "deck/words.hpp"

#include <fmt/format.h>
#include <map>
#include <set>

namespace osculate::deck {
namespace {

bool is_small_strain(const std::string& material) {
    return material.starts_with("{linear_elastic") || material.starts_with("{orthotropic");
}

} // namespace

std::string BodyWriter::write() {
    std::string text;
    bool dangling = false;
    std::vector<char> used(model_.mesh.raw.points.size(), 0);
    for (const mesh::RawCell& cell : model_.mesh.raw.cells)
        for (const Index p : cell) used[static_cast<std::size_t>(p)] = 1;
    for (const char u : used) dangling = dangling || !u;
    for (const DeckBody& body : bodies_) {
        text += "  " + body.name + ":\n    mesh: {file: {path: " + in_quotes(path_);
        if (body.piece > 0) text += fmt::format(", piece: {}", body.piece);
        if (dangling || body.joined_at_nodes)
            text += fmt::format(", repair: [{}{}{}]", dangling ? "dangling_nodes" : "",
                                dangling && body.joined_at_nodes ? ", " : "",
                                body.joined_at_nodes ? "keep_non_manifold" : "");
        text += "}";
        if (units_.length != 1) text += ", scale: " + number(units_.length);
        if (body.rigid != nullptr) {
            text += "}\n    rigid: " + rigid_.of(body) + "\n";
            continue;
        }
        const std::string material = material_of(body, body.section);
        text += "}\n    material: " + material + "\n";
        bool small_strain = is_small_strain(material);
        if (!body.other_sections.empty()) text += "    sections:\n";
        std::set<std::string> taken;
        for (const DeckSection* section : body.other_sections) {
            const std::string own = material_of(body, section);
            small_strain = small_strain && is_small_strain(own);
            text += "      " + fresh_name(section->elements, taken) + ": {elements: " + in_quotes(section->elements) +
                    ", material: " + own + "}\n";
        }
        std::string formulation = body.formulation;
        if (formulation == "incompatible_modes" && !small_strain) {
            formulation = "b_bar";
            model_.lose(body.section == nullptr ? model_.mesh.raw.file : body.section->place,
                        "C3D8I or C3D8R of body " + body.name,
                        "incompatible modes are for small strain: b_bar is used instead, which locks where few "
                        "elements bend");
        }
        if (formulation != "full") text += "    hex_formulation: " + formulation + "\n";
        if (body.slice == mesh::DeckSlice::plane_strain) text += "    slice: {kind: plane_strain}\n";
        if (body.slice == mesh::DeckSlice::plane_stress) text += "    slice: {kind: plane_stress}\n";
        if (body.slice == mesh::DeckSlice::axisymmetric) text += "    slice: {kind: axisymmetric, axis: [0, 1, 0]}\n";
    }
    return text;
}

std::array<double, 2> BodyWriter::at_temperature(const DeckMaterial& m, const DeckBody& body) {
    std::map<Index, double> now;
    for (const Index p : body.points) now[p] = 0;
    const auto take = [&](const std::vector<DeckTemperature>& list) {
        for (const DeckTemperature& t : list)
            for (const Index p : t.points)
                if (const auto at = now.find(p); at != now.end()) at->second = t.value;
    };
    take(model_.initial_temperatures);
    std::set<double> all;
    for (const DeckStep& step : model_.steps) {
        take(step.temperatures);
        for (const auto& [p, T] : now) all.insert(T);
    }
    if (all.size() > 1) {
        model_.lose(m.place, "*ELASTIC of material " + m.name,
                    "moduli that depend on temperature, in a body of more than one: those of its first line are used "
                    "instead");
        return *m.elastic;
    }
    const double T = all.empty() ? 0 : *all.begin();
    model_.note(m.place, "*ELASTIC of material " + m.name,
                fmt::format("moduli of the temperature {} are used", number(T)));
    return {interpolated(m.by_temperature, T, 1), interpolated(m.by_temperature, T, 2)};
}

std::string BodyWriter::orthotropic_of(const DeckSection& section, const DeckMaterial& m) {
    if (nlgeom_)
        model_.lose(m.place, "NLGEOM with the orthotropic material " + m.name, "such bodies are at small strain");
    const std::array<double, 9>& c = *m.orthotropic;
    const auto three = [&](std::size_t first, double unit) {
        return "[" + number(unit * c[first]) + ", " + number(unit * c[first + 1]) + ", " + number(unit * c[first + 2]) +
               "]";
    };
    std::string text =
        "{orthotropic: {E: " + three(0, units_.stress) + ", nu: " + three(3, 1) + ", G: " + three(6, units_.stress);
    if (!section.orientation.empty()) {
        const auto at = model_.orientations.find(section.orientation);
        if (at == model_.orientations.end()) {
            model_.lose(section.place, "ORIENTATION=" + section.orientation, "there is none of that name");
        } else {
            const auto& [a, b] = at->second;
            text += fmt::format(", axes: [[{}, {}, {}], [{}, {}, {}]]", number(a[0]), number(a[1]), number(a[2]),
                                number(b[0]), number(b[1]), number(b[2]));
        }
    }
    if (m.density > 0) text += ", density: " + number(units_.density * m.density);
    if (m.expansion != 0) text += ", expansion: " + number(m.expansion);
    return text + "}}";
}

std::string BodyWriter::material_of(const DeckBody& body, const DeckSection* section) {
    std::array<double, 2> elastic{1, 0};
    std::string law = nlgeom_ ? "saint_venant_kirchhoff" : "linear_elastic";
    double density = 0, expansion = 0;
    const std::vector<std::array<double, 2>>* hardening = nullptr;
    const auto found = section == nullptr ? model_.materials.end() : model_.materials.find(section->material);
    if (found == model_.materials.end()) {
        model_.lose(section == nullptr ? model_.mesh.raw.file : section->place, "body " + body.name,
                    "it has no material: E = 1 is used instead");
    } else {
        const DeckMaterial& m = found->second;
        density = m.density;
        if (!m.hardening.empty() && !m.elastic)
            model_.lose(m.place, "*PLASTIC of material " + m.name, "only isotropic Hookean materials yield");
        expansion = m.expansion;
        if (m.elastic) {
            elastic = *m.elastic;
            if (!m.by_temperature.empty()) elastic = at_temperature(m, body);
            if (!m.hardening.empty()) {
                law = "elastic_plastic";
                hardening = &m.hardening;
                if (!nlgeom_) model_.note(m.place, "*PLASTIC without NLGEOM", "plastic bodies are at finite strain");
            }
        } else if (m.orthotropic) {
            return orthotropic_of(*section, m);
        } else if (m.neo_hookean && (*m.neo_hookean)[0] > 0 && (*m.neo_hookean)[1] > 0) {
            const double mu = 2 * (*m.neo_hookean)[0], K = 2 / (*m.neo_hookean)[1];
            elastic = {9 * K * mu / (3 * K + mu), (3 * K - 2 * mu) / (2 * (3 * K + mu))};
            law = "neo_hookean";
        } else {
            model_.lose(m.place, "material " + m.name,
                        m.neo_hookean ? "C10 and D1 must be positive: E = 1 is used instead"
                                      : "no elastic constants that have a counterpart: E = 1 is used instead");
        }
        if (!(elastic[0] > 0) || !(elastic[1] > -1 && elastic[1] < 0.5))
            model_.lose(m.place, "material " + m.name, "E must be positive, nu between -1 and 0.5");
    }
    std::string text = "{" + law + ": {E: " + number(units_.stress * elastic[0]) + ", nu: " + number(elastic[1]);
    if (density > 0) text += ", density: " + number(units_.density * density);
    if (expansion != 0) text += ", expansion: " + number(expansion);
    if (hardening != nullptr) {
        text += ", yield_stress: {table: [";
        for (const auto& [strain, stress] : *hardening)
            text += (text.ends_with('[') ? "[" : ", [") + number(strain) + ", " + number(units_.stress * stress) + "]";
        text += "]}";
    }
    return text + "}}";
}

} // namespace osculate::deck
