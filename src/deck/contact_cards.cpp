#include "deck/contact_cards.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace osculate::deck {

bool ContactCards::take(const DeckCard& card, const std::string& word, DeckStep* step) {
    step_ = step;
    const auto says = [&](const char* name) { return given(card, name) != nullptr; };
    if (word == "SURFACEINTERACTION") {
        interaction_ = capitals_of(card, "NAME");
        model_.interactions.try_emplace(interaction_);
    } else if (word == "FRICTION") {
        friction(card);
    } else if (word == "SURFACEBEHAVIOR") {
        surface_behavior(card);
    } else if (word == "CONTACTDAMPING") {
        damping(card);
    } else if (word == "CONTACTPAIR") {
        pair(card);
    } else if (word == "TIE" && says("CYCLICSYMMETRY")) {
        ring(card);
    } else if (word == "TIE" && !says("MULTISTAGE") && !says("FLUIDPERIODIC") && !says("FLUIDCYCLIC")) {
        tie(card);
    } else if (word == "CYCLICSYMMETRYMODEL") {
        ring_model(card);
    } else if (word == "CHANGEFRICTION" && step_ != nullptr) {
        changed_ = capitals_of(card, "INTERACTION");
    } else if (word == "CHANGESURFACEBEHAVIOR" && step_ != nullptr) {
        changed_law_ = capitals_of(card, "INTERACTION");
    } else if (word == "MODELCHANGE" && step_ != nullptr &&
               without_blanks(capitals_of(card, "TYPE")) == "CONTACTPAIR") {
        model_change(card);
    } else {
        return false;
    }
    return true;
}

void ContactCards::friction(const DeckCard& card) {
    if (step_ != nullptr) {
        if (changed_.empty()) return lose(card, "no *CHANGE FRICTION stands before it");
        if (card.first == card.last) return lose(card, "no coefficient");
        const std::vector<double> v = numbers(*deck_.begin(card), 1);
        const auto law = model_.interactions.find(changed_);
        if (law == model_.interactions.end()) return lose(card, "no *SURFACE INTERACTION is called " + changed_);
        if (v[0] < 0) return lose(card, "a negative coefficient");
        if (law->second.static_friction > 0) return lose(card, "static friction stays for the whole run");
        if (v.size() > 1 && v[1] > 0 && law->second.stick == 0) law->second.stick = v[1];
        if (v.size() > 1 && v[1] > 0 && v[1] != law->second.stick)
            lose(card, "the stick slope stays what it is before the steps");
        step_->friction[changed_] = v[0];
        return;
    }
    if (card.first == card.last || !model_.interactions.contains(interaction_))
        return lose(card, "no coefficient, or no *SURFACE INTERACTION before it");
    const std::vector<double> v = numbers(*deck_.begin(card), 1);
    if (v[0] < 0) return lose(card, "a negative coefficient");
    if (card.parameter("EXPONENTIALDECAY") != nullptr) return decaying_friction(card, v);
    for (const char* name : {"ROUGH", "TAUMAX"})
        if (card.parameter(name) != nullptr) lose(card, std::string(name) + " has no counterpart");
    if (card.last - card.first > 1)
        lose(card, "friction that depends on anything has no counterpart: that of its first line is used");
    model_.interactions[interaction_].friction = v[0];
    if (v.size() > 1 && v[1] > 0) model_.interactions[interaction_].stick = v[1];
}

void ContactCards::decaying_friction(const DeckCard& card, const std::vector<double>& v) {
    if (v.size() < 2 || v[1] < 0 || v[1] > v[0])
        return lose(card, "a static and a kinetic coefficient are expected, which is no larger");
    DeckInteraction& law = model_.interactions[interaction_];
    law.friction = v[1];
    law.static_friction = v[1] > 0 && v[0] > v[1] ? v[0] : 0;
    if (v[1] == 0 && v[0] > 0) return lose(card, "no kinetic friction beside static friction has no counterpart");
    if (law.static_friction > 0)
        note(card, "a node that has slid in an increment has the kinetic coefficient in the next, at any speed");
}

void ContactCards::pair(const DeckCard& card) {
    if (step_ != nullptr) return lose(card, "pairs belong to all stages");
    DeckPair p;
    p.interaction = capitals_of(card, "INTERACTION");
    const std::string type = without_blanks(capitals_of(card, "TYPE"));
    p.mortar = type == "SURFACETOSURFACE" || type == "MORTAR" || type == "LINMORTAR" || type == "PGLINMORTAR";
    if (!p.mortar && !type.empty() && type != "NODETOSURFACE" && type != "MASSLESS")
        lose(card, "TYPE=" + type + " is not known: node to surface is used instead");
    p.place = deck_.place(card);
    const std::string* adjust = given(card, "ADJUST");
    const bool by_nodes = adjust != nullptr && !to_number(*adjust, p.adjust);
    if (by_nodes || p.adjust < 0) p.adjust = 0;
    if (adjust != nullptr && !by_nodes && p.adjust == 0 && *adjust != "0")
        note(card, "ADJUST=" + *adjust + ": nothing is moved");
    if (given(card, "SMALLSLIDING") != nullptr) note(card, "SMALLSLIDING: nodes slide as far as they do");
    p.tied = card.parameter("TIED") != nullptr;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        if (fields_.size() < 2) {
            lose(deck_.place(*line), "a pair of one surface", "a body in contact with itself has no counterpart");
            continue;
        }
        p.slave = in_capitals(fields_[0]);
        p.master = in_capitals(fields_[1]);
        if (by_nodes) p.adjust = adjust_all(card, p.slave, *adjust);
        model_.pairs.push_back(p);
    }
}

double ContactCards::adjust_all(const DeckCard& card, const std::string& slave, const std::string& set) {
    std::vector<Index> moved = points_of(set), own;
    std::ranges::sort(moved);
    const auto at = model_.mesh.surface_names.find(slave);
    if (at != model_.mesh.surface_names.end() && model_.mesh.raw.surfaces.contains(at->second))
        for (const mesh::RawFace& face : model_.mesh.raw.surfaces.at(at->second))
            own.insert(own.end(), face.nodes.begin(), face.nodes.begin() + face.count);
    else
        own = points_of(slave);
    if (own.empty() || !std::ranges::all_of(own, [&](Index p) { return std::ranges::binary_search(moved, p); })) {
        lose(card, "ADJUST=" + set + ": only a distance, or a set with all slave nodes, has a counterpart");
        return 0;
    }
    Eigen::AlignedBox3d box;
    for (const Vec3& x : model_.mesh.raw.points) box.extend(x);
    return box.diagonal().norm();
}

void ContactCards::model_change(const DeckCard& card) {
    const bool adds = card.parameter("ADD") != nullptr;
    if (adds == (card.parameter("REMOVE") != nullptr)) return lose(card, "ADD or REMOVE is expected");
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        if (fields_.size() < 2) {
            lose(deck_.place(*line), "*MODEL CHANGE", "a slave and a master are expected");
            continue;
        }
        step_->pairs.emplace_back(in_capitals(fields_[0]), in_capitals(fields_[1]), adds);
    }
}

void ContactCards::ring(const DeckCard& card) {
    DeckRing one;
    one.name = capitals_of(card, "NAME");
    one.place = deck_.place(card);
    if (const std::string* by = given(card, "POSITIONTOLERANCE"); by != nullptr && !to_number(*by, one.tolerance))
        lose(card, "POSITION TOLERANCE is no number");
    if (card.first == card.last) return lose(card, "no sets");
    split_fields(deck_.begin(card)->text, fields_);
    if (fields_.size() < 2) return lose(card, "two sets are expected");
    one.slave = in_capitals(fields_[0]);
    one.master = in_capitals(fields_[1]);
    model_.rings.push_back(one);
}

void ContactCards::ring_model(const DeckCard& card) {
    const std::string name = capitals_of(card, "TIE");
    const auto at = std::ranges::find(model_.rings, name, &DeckRing::name);
    if (at == model_.rings.end() || card.first == card.last) return lose(card, "no tie of that name, or no axis");
    double sectors = 0;
    if (const std::string* n = given(card, "N"); n == nullptr || !to_number(*n, sectors) || !(sectors >= 2))
        return lose(card, "N, the number of sectors, is expected");
    const std::vector<double> v = numbers(*deck_.begin(card), 6);
    at->sectors = static_cast<int>(sectors);
    at->axis = {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
    if (!((at->axis[1] - at->axis[0]).norm() > 0)) lose(card, "two points on the axis are expected");
}

void ContactCards::tie(const DeckCard& card) {
    DeckPair p;
    p.tied = true;
    p.place = deck_.place(card);
    double tolerance = 0;
    if (capitals_of(card, "ADJUST") == "NO") note(card, "ADJUST=NO: tied nodes are moved onto the other surface");
    if (const std::string* by = given(card, "POSITIONTOLERANCE"); by != nullptr && to_number(*by, tolerance))
        p.tolerance = tolerance;
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        if (fields_.size() < 2) {
            lose(deck_.place(*line), "a tie of one surface", "two surfaces are tied");
            continue;
        }
        p.slave = in_capitals(fields_[0]);
        p.master = in_capitals(fields_[1]);
        model_.ties.push_back(p);
    }
}

void ContactCards::surface_behavior(const DeckCard& card) {
    const std::string law = without_blanks(capitals_of(card, "PRESSURE-OVERCLOSURE"));
    if (step_ != nullptr) {
        const auto changed = model_.interactions.find(changed_law_);
        if (changed == model_.interactions.end())
            return lose(card, changed_law_.empty() ? "no *CHANGE SURFACE BEHAVIOR stands before it"
                                                   : "no *SURFACE INTERACTION is called " + changed_law_);
        if (law == "TIED" || changed->second.tied) return lose(card, "ties last for the whole run");
        if (auto of = overclosure_of(card, law)) {
            if (of->gives_way() != changed->second.overclosure.gives_way())
                return lose(card, "a pair is exact for the whole run, or it gives way");
            step_->overclosure[changed_law_] = std::move(*of);
        }
        return;
    }
    if (law == "TIED" && model_.interactions.contains(interaction_)) {
        model_.interactions[interaction_].tied = true;
        return note(card, "the surfaces are tied exactly");
    }
    if (law == "TIED" || card.parameter("NOSEPARATION") != nullptr) return lose(card, "surfaces part and slide");
    if (!model_.interactions.contains(interaction_)) return lose(card, "no *SURFACE INTERACTION stands before it");
    if (auto of = overclosure_of(card, law)) model_.interactions[interaction_].overclosure = std::move(*of);
}

void ContactCards::damping(const DeckCard& card) {
    if (step_ != nullptr || card.first == card.last || !model_.interactions.contains(interaction_))
        return lose(card, "a coefficient is expected, after *SURFACE INTERACTION and before the steps");
    const std::vector<double> v = numbers(*deck_.begin(card), 1);
    double fraction = 0;
    if (const std::string* given = this->given(card, "TANGENTFRACTION");
        given != nullptr && (!to_number(*given, fraction) || fraction < 0))
        return lose(card, "TANGENT FRACTION is no number that is not negative");
    if (card.parameter("DEFINITION") != nullptr &&
        without_blanks(capitals_of(card, "DEFINITION")) != "DAMPINGCOEFFICIENT")
        return lose(card, "only a damping coefficient has a counterpart");
    if (v[0] < 0) return lose(card, "a negative coefficient");
    model_.interactions[interaction_].damping = v[0];
    model_.interactions[interaction_].tangential_damping = fraction * v[0];
}

std::optional<DeckOverclosure> ContactCards::overclosure_of(const DeckCard& card, const std::string& law) {
    const auto refuse = [&](const char* why) {
        lose(card, why);
        return std::nullopt;
    };
    if (law == "HARD") return DeckOverclosure{};
    if (law != "LINEAR" && law != "EXPONENTIAL" && law != "TABULAR") {
        note(card, "contact is exact: no penetration, no law of overclosure");
        return DeckOverclosure{};
    }
    if (card.first == card.last) return refuse("no numbers");
    DeckOverclosure of;
    if (law == "TABULAR") {
        of.form = DeckOverclosure::Form::tabular;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            const std::vector<double> v = numbers(*line, 2); // pressure, overclosure
            if (!of.rows.empty() && !(v[1] > of.rows.back()[0] && v[0] > of.rows.back()[1]))
                return refuse("overclosures and pressures that grow from row to row are expected");
            of.rows.push_back({v[1], v[0]});
        }
        if (of.rows.size() < 2 || of.rows.front()[1] != 0)
            return refuse("two rows or more, the first without pressure, are expected");
        return of;
    }
    const std::vector<double> v = numbers(*deck_.begin(card), 2);
    if (!(v[0] > 0)) return refuse("a number that is not positive");
    of.form = law == "LINEAR" ? DeckOverclosure::Form::linear : DeckOverclosure::Form::exponential;
    of.rows = {{v[0], v[1]}};
    if (law == "EXPONENTIAL" && !(v[1] > 0)) return refuse("a pressure at no gap that is not positive");
    if (law == "EXPONENTIAL")
        note(card, "the exponential is CalculiX's; Abaqus's has the same pressure at no gap and grows more slowly");
    return of;
}

} // namespace osculate::deck
