#include "deck/load_cards.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace osculate::deck {

namespace {

constexpr int components = 3;

/// Abaqus' SMOOTH STEP: between rows A_i + (A_i+1 - A_i) s^3 (10 - 15 s + 6 s^2), without slope and curvature at the rows.
Amplitude smooth_steps(const Amplitude& rows) {
    constexpr int pieces = 64; // 5.8 / 8 / 64^2 of the step between a chord and its arc
    Amplitude all{rows.front()};
    for (std::size_t k = 1; k < rows.size(); ++k)
        for (int i = 1; i <= pieces; ++i) {
            const double s = static_cast<double>(i) / pieces, rise = s * s * s * (10 + s * (6 * s - 15));
            const auto between = [&](std::size_t column, double part) {
                return rows[k - 1][column] + part * (rows[k][column] - rows[k - 1][column]);
            };
            all.push_back({between(0, s), between(1, rise)});
        }
    return all;
}

} // namespace

bool LoadCards::take(const DeckCard& card, const std::string& word, DeckStep* step) {
    step_ = step;
    if (word == "AMPLITUDE")
        amplitude(card);
    else if (word == "BOUNDARY")
        boundary(card);
    else if (word == "INITIALCONDITIONS" && capitals_of(card, "TYPE") == "TEMPERATURE")
        temperatures(card, model_.initial_temperatures);
    else if (step == nullptr)
        return false;
    else if (word == "TEMPERATURE")
        temperatures(card, step->temperatures);
    else if (word == "CLOAD")
        forces(card);
    else if (word == "DLOAD" || word == "DSLOAD")
        pressures(card);
    else
        return false;
    return true;
}

void LoadCards::temperatures(const DeckCard& card, std::vector<DeckTemperature>& list) {
    for (const char* unknown : {"AMPLITUDE", "USER", "FILE", "BSTEP"})
        if (given(card, unknown) != nullptr) return lose(card, std::string(unknown) + " has no counterpart");
    if (capitals_of(card, "OP") == "NEW")
        return lose(card, "OP=NEW has no counterpart: temperatures stay until they change");
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        DeckTemperature t;
        t.place = deck_.place(*line);
        const std::string shown(line->source.substr(0, 60));
        t.points = points_of(fields_[0]);
        for (std::size_t i = 0, n = t.points.size(); i < n; ++i) // through the layer of plane elements
            if (const auto above = model_.mesh.above.find(t.points[i]); above != model_.mesh.above.end())
                t.points.insert(t.points.end(), above->second.begin(), above->second.end());
        if (t.points.empty() || fields_.size() < 2 || !to_number(fields_[1], t.value))
            lose(t.place, shown, "not understood");
        else
            list.push_back(std::move(t));
    }
}

void LoadCards::amplitude(const DeckCard& card) {
    const std::string name = capitals_of(card, "NAME");
    const std::string type = capitals_of(card, "DEFINITION");
    const bool smooth = type == "SMOOTH STEP" || type == "SMOOTHSTEP";
    if (!type.empty() && type != "TABULAR" && !smooth)
        return note(card, "only TABULAR amplitudes and SMOOTH STEP have a counterpart");
    if (capitals_of(card, "TIME") == "TOTAL TIME" || card.parameter("USER") != nullptr ||
        card.parameter("SHIFTX") != nullptr || card.parameter("SHIFTY") != nullptr)
        return note(card, "only amplitudes over the time of a step have a counterpart");
    std::vector<double> all;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line)
        for (const double v : numbers(*line, 0)) all.push_back(v);
    Amplitude rows;
    for (std::size_t k = 0; k + 1 < all.size(); k += 2) rows.push_back({all[k], all[k + 1]});
    for (std::size_t k = 1; k < rows.size(); ++k)
        if (!(rows[k][0] > rows[k - 1][0])) return note(card, "its times do not ascend");
    if (rows.empty()) return note(card, "it has no rows");
    if (smooth) note(card, "64 straight pieces between two rows are off by up to 2e-4 of the step");
    model_.amplitudes[name] = smooth ? smooth_steps(rows) : std::move(rows);
}

bool LoadCards::amplitude_of(const DeckCard& card, std::string& name) {
    name = capitals_of(card, "AMPLITUDE");
    const std::string* delay = given(card, "TIMEDELAY");
    if (name.empty() || (model_.amplitudes.contains(name) && delay == nullptr)) return true;
    double later = 0;
    if (!model_.amplitudes.contains(name) || !to_number(*delay, later)) {
        lose(card, "its amplitude '" + name + "' has no counterpart");
        return false;
    }
    Amplitude rows = model_.amplitudes[name];
    for (auto& row : rows) row[0] += later;
    name += " later by " + *delay;
    model_.amplitudes[name] = std::move(rows);
    return true;
}

void LoadCards::boundary(const DeckCard& card) {
    std::vector<DeckValues>& held = step_ != nullptr ? step_->held : model_.held;
    if (capitals_of(card, "OP") == "NEW" && step_ != nullptr) step_->forget_held = true;
    DeckValues values;
    if (!amplitude_of(card, values.amplitude)) return;
    if (const std::string type = capitals_of(card, "TYPE"); !type.empty() && type != "DISPLACEMENT")
        return lose(card, "TYPE=" + type + " has no counterpart");
    for (const char* name : {"FIXED", "SUBMODEL", "USER", "LOADCASE"})
        if (card.parameter(name) != nullptr) return lose(card, std::string(name) + " has no counterpart");
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        values.place = deck_.place(*line);
        const std::string shown(line->source.substr(0, 60));
        values.points = fields_.empty() ? std::vector<Index>{} : points_of(fields_[0]);
        if (values.points.empty()) {
            lose(values.place, shown, "no node or node set of that name");
            continue;
        }
        values.value = 0;
        long long first = 0, last = 0;
        static const std::map<std::string, std::vector<int>> words{{"ENCASTRE", {1, 2, 3, 4, 5, 6}},
                                                                   {"PINNED", {1, 2, 3}},
                                                                   {"XSYMM", {1, 5, 6}},
                                                                   {"YSYMM", {2, 4, 6}},
                                                                   {"ZSYMM", {3, 4, 5}},
                                                                   {"XASYMM", {2, 3, 4}},
                                                                   {"YASYMM", {1, 3, 5}},
                                                                   {"ZASYMM", {1, 2, 6}}};
        std::vector<int> all;
        const auto word = fields_.size() > 1 ? words.find(in_capitals(fields_[1])) : words.end();
        if (word != words.end()) {
            all = word->second;
        } else {
            const bool good = fields_.size() > 1 && to_integer(fields_[1], first) &&
                              (fields_.size() < 3 || fields_[2].empty() || to_integer(fields_[2], last)) &&
                              (fields_.size() < 4 || fields_[3].empty() || to_number(fields_[3], values.value));
            if (fields_.size() < 3 || fields_[2].empty()) last = first;
            if (!good || first < 1 || last < first) {
                lose(values.place, shown, "not understood");
                continue;
            }
            for (long long c = first; c <= std::min<long long>(last, 2 * components); ++c)
                all.push_back(static_cast<int>(c));
        }
        rigid_.hold(values, all, step_);
        if (values.points.empty()) continue;
        if (all.empty() || all.front() > components) {
            model_.note(values.place, shown, "nodes have three displacements");
            continue;
        }
        for (const int c : all) {
            values.first = values.last = c - 1;
            if (c <= components) held.push_back(values);
        }
    }
}

void LoadCards::forces(const DeckCard& card) {
    if (capitals_of(card, "OP") == "NEW") step_->forget_forces = true;
    DeckValues values;
    if (!amplitude_of(card, values.amplitude)) return;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        values.place = deck_.place(*line);
        const std::string shown(line->source.substr(0, 60));
        long long component = 0;
        if (fields_.size() < 3 || !to_integer(fields_[1], component) || !to_number(fields_[2], values.value)) {
            lose(values.place, shown, "not understood");
            continue;
        }
        values.points = points_of(fields_[0]);
        if (!values.points.empty() && component >= 1 && component <= 2 * components) {
            rigid_.load(values, static_cast<int>(component), step_);
            if (values.points.empty()) continue;
        }
        if (values.points.empty() || component < 1 || component > components) {
            lose(values.place, shown,
                 values.points.empty() ? "no node or node set of that name" : "nodes have forces alone");
            continue;
        }
        values.first = values.last = static_cast<int>(component) - 1;
        step_->forces.push_back(values);
    }
}

void LoadCards::pressures(const DeckCard& card) {
    const bool on_surface = card.keyword == "DSLOAD";
    if (capitals_of(card, "OP") == "NEW") (on_surface ? step_->forget_on_surfaces : step_->forget_on_elements) = true;
    std::string amplitude;
    if (!amplitude_of(card, amplitude)) return;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        const std::string place = deck_.place(*line), shown(line->source.substr(0, 60));
        const std::string label = fields_.size() > 1 ? in_capitals(fields_[1]) : "";
        if (label == "GRAV" && fields_.size() >= 6) {
            gravity(place, shown, amplitude);
            continue;
        }
        if (label == "CENTRIF" && fields_.size() >= 9 && amplitude.empty()) {
            centrifugal(place, shown);
            continue;
        }
        DeckPressure p;
        p.amplitude = amplitude;
        p.place = place;
        if (fields_.size() < 3 || !to_number(fields_[2], p.value)) {
            lose(place, shown, "not understood");
            continue;
        }
        p.name = std::string(fields_[0]);
        p.keyword = card.keyword;
        std::string why = "only pressures on faces, gravity and centrifugal forces have a counterpart";
        if (on_surface) {
            const auto at = model_.mesh.surface_names.find(in_capitals(fields_[0]));
            if (at == model_.mesh.surface_names.end())
                why = "no surface of that name";
            else if (label == "P")
                p.faces = model_.mesh.raw.surfaces.at(at->second);
        } else if (label.size() == 2 && label[0] == 'P' && label[1] >= '1' && label[1] <= '6') {
            const std::vector<Index> cells = cells_of(fields_[0]);
            why = cells.empty() ? "no element or element set of that name" : "its elements have no such face";
            for (const Index c : cells)
                if (const mesh::RawFace face = model_.mesh.face_of(c, label[1] - '1'); face.count > 0)
                    p.faces.push_back(face);
            if (long long id = 0; to_integer(fields_[0], id)) p.name = "elements"; // one by one
        }
        if (p.faces.empty())
            lose(place, shown, why);
        else
            step_->pressures.push_back(std::move(p));
    }
}

std::vector<Index> LoadCards::loaded_cells() const {
    if (!fields_[0].empty()) return cells_of(fields_[0]);
    std::vector<Index> all(model_.mesh.raw.cells.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

void LoadCards::gravity(const std::string& place, const std::string& shown, const std::string& amplitude) {
    DeckGravity g;
    double size = 0;
    Vec3 direction;
    bool good = to_number(fields_[2], size);
    for (int d = 0; d < 3; ++d) good = good && to_number(fields_[3 + static_cast<std::size_t>(d)], direction[d]);
    g.cells = loaded_cells();
    g.elements = in_capitals(fields_[0]);
    if (!good || g.cells.empty() || !(direction.norm() > 0)) return lose(place, shown, "not understood");
    g.acceleration = size * direction.normalized();
    g.amplitude = amplitude;
    g.place = place;
    step_->gravity.push_back(std::move(g));
}

void LoadCards::centrifugal(const std::string& place, const std::string& shown) {
    DeckCentrifugal c;
    bool good = to_number(fields_[2], c.square) && c.square >= 0;
    for (std::size_t d = 0; d < 3; ++d)
        good = good && to_number(fields_[3 + d], c.point[static_cast<Index>(d)]) &&
               to_number(fields_[6 + d], c.axis[static_cast<Index>(d)]);
    c.cells = loaded_cells();
    if (!good || c.cells.empty() || !(c.axis.norm() > 0)) return lose(place, shown, "not understood");
    c.place = place;
    step_->centrifugal.push_back(std::move(c));
}

} // namespace osculate::deck
