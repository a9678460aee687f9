#include "deck/general_contact.hpp"

#include "deck/words.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <optional>

namespace osculate::deck {

bool GeneralContactCards::take(const DeckCard& card, const std::string& word, const DeckStep* step) {
    DeckGeneralContact& general = model_.general;
    const bool whole_run = step == nullptr || (model_.steps.size() == 1 && step == model_.steps.data());
    if (word == "CONTACTFORMULATION" || word == "CONTACTCONTROLSASSIGNMENT" || word == "CONTACTSTABILIZATION") {
        note(card, "what contact is solved with is chosen by the scene");
    } else if (word != "CONTACT" && word != "CONTACTINCLUSIONS" && word != "CONTACTEXCLUSIONS" &&
               word != "CONTACTPROPERTYASSIGNMENT") {
        return false;
    } else if (!whole_run) {
        lose(card, "contact of all surfaces is for the whole run: a later step cannot change it");
    } else if (word == "CONTACT") {
        general.place = deck_.place(card);
        note(card, "initial overlaps stay as they are drawn; Abaqus moves nodes out of them");
    } else if (word == "CONTACTINCLUSIONS") {
        inclusions(card);
    } else if (word == "CONTACTEXCLUSIONS") {
        add_lines(card, general.excluded);
    } else {
        add_lines(card, general.laws);
    }
    return true;
}

void GeneralContactCards::inclusions(const DeckCard& card) {
    if (given(card, "ALLEXTERIOR") != nullptr || given(card, "ALLELEMENTBASED") != nullptr) {
        model_.general.all = true;
        return;
    }
    std::vector<DeckGeneralContact::Sides> sides;
    add_lines(card, sides);
    for (DeckGeneralContact::Sides& one : sides)
        if (one.first.empty() && one.second.empty())
            model_.general.all = true;
        else
            model_.general.included.push_back(std::move(one));
}

void GeneralContactCards::add_lines(const DeckCard& card, std::vector<DeckGeneralContact::Sides>& to) {
    for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
        split_fields(line->text, fields_);
        const auto field = [&](std::size_t f) { return f < fields_.size() ? in_capitals(fields_[f]) : ""; };
        DeckGeneralContact::Sides sides{field(0), field(1), field(2), deck_.place(*line)};
        bool known = true;
        for (const std::string& name : {sides.first, sides.second})
            if (!name.empty() && !model_.mesh.surface_names.contains(name)) {
                lose(sides.place, "*" + card.keyword, "no surface is called '" + name + "'");
                known = false;
            }
        if (known) to.push_back(std::move(sides));
    }
}

namespace {

using Sides = DeckGeneralContact::Sides;

std::string shown(const Sides& sides) {
    const auto name = [](const std::string& surface, const char* other) { return surface.empty() ? other : surface; };
    return name(sides.first, "all surfaces") + " and " + name(sides.second, sides.first.empty() ? "all" : "itself");
}

/// The law of all surfaces, nullptr where none is given: without friction.
const Sides* law_of_all(const DeckGeneralContact& general) {
    const Sides* found = nullptr; // the last one counts
    for (const Sides& law : general.laws)
        if (law.first.empty() && law.second.empty()) found = &law;
    return found;
}

/// Writes the rules of bodies.
class Writer {
public:
    Writer(DeckModel& model, const std::vector<DeckBody>& bodies) : model_(model), bodies_(bodies) {}

    std::string write() {
        DeckGeneralContact& general = model_.general;
        const Sides* all = law_of_all(general);
        if (all != nullptr) friction_ = friction_of(*all).value_or(0);
        for (const Sides& law : general.laws)
            if (&law != all && !(law.first.empty() && law.second.empty())) add_law(law);
        for (const Sides& sides : general.excluded) exclude(sides);
        for (std::size_t a = 0; a < bodies_.size(); ++a)
            for (std::size_t b = a + 1; b < bodies_.size(); ++b)
                if (bodies_[a].rigid != nullptr && bodies_[b].rigid != nullptr) {
                    model_.note(general.place, "contact of " + bodies_[a].name + " and " + bodies_[b].name,
                                "two rigid bodies do not meet");
                    rule(a, b, "contact: false");
                }
        std::string text = "  general:\n    friction: " + number(friction_) + "\n";
        if (!rules_.empty()) text += "    pairs:\n" + rules_;
        return text;
    }

private:
    /// Of a law; none where there is no such interaction.
    std::optional<double> friction_of(const Sides& law) {
        const auto at = model_.interactions.find(law.interaction);
        if (at == model_.interactions.end()) {
            model_.lose(law.place, "the law of " + shown(law),
                        "no *SURFACE INTERACTION is called '" + law.interaction + "'");
            return std::nullopt;
        }
        if (at->second.tied) model_.lose(law.place, law.interaction + ", which ties", "general contact ties nothing");
        if (at->second.overclosure.gives_way() || at->second.stick > 0)
            model_.note(law.place, "overclosure and stick slope of " + law.interaction,
                        "general contact and its stick are exact");
        if (at->second.static_friction > 0)
            model_.lose(law.place, "static friction of " + law.interaction, "general contact has the kinetic one");
        return at->second.friction;
    }

    /// Bodies whose whole outside a surface is, all for an empty name. @param part  set where it has a part of a body
    std::vector<std::size_t> bodies_of(const std::string& surface, bool& part) const {
        std::vector<std::size_t> whole;
        for (std::size_t b = 0; b < bodies_.size(); ++b) {
            if (surface.empty()) {
                whole.push_back(b);
                continue;
            }
            const auto& surfaces = bodies_[b].mesh.surfaces;
            const auto at = surfaces.find(model_.mesh.surface_names.at(surface));
            if (at == surfaces.end() || at->second.empty()) continue;
            if (at->second.size() == bodies_[b].exterior.size())
                whole.push_back(b);
            else
                part = true;
        }
        return whole;
    }

    /// Rules for all bodies of both sides; false where a side has but a part of a body.
    bool add_rules(const Sides& sides, const std::string& what) {
        bool part = false;
        const std::vector<std::size_t> first = bodies_of(sides.first, part);
        const std::vector<std::size_t> second = sides.second.empty() ? first : bodies_of(sides.second, part);
        if (part || first.empty() || second.empty()) return false;
        std::set<std::pair<std::size_t, std::size_t>> done;
        for (const std::size_t a : first)
            for (const std::size_t b : second) {
                if (!done.insert(std::minmax(a, b)).second) continue;
                rule(a, b, what);
            }
        return true;
    }

    void rule(std::size_t a, std::size_t b, const std::string& what) {
        rules_ += fmt::format("      {}: {{between: [{}, {}], {}}}\n",
                              fresh_name(bodies_[a].name + "_and_" + bodies_[b].name, taken_), bodies_[a].name,
                              bodies_[b].name, what);
    }

    void add_law(const Sides& law) {
        const std::optional<double> friction = friction_of(law);
        if (!friction) return;
        if (*friction != friction_ || any_rule_) {
            any_rule_ = true;
            if (!add_rules(law, "friction: " + number(*friction)))
                model_.lose(law.place, "the law of " + shown(law),
                            "general contact tells whole bodies apart, and not parts of their surfaces: name the pair "
                            "beside it");
        }
    }

    void exclude(const Sides& sides) {
        if ((sides.first.empty() && sides.second.empty()) || !add_rules(sides, "contact: false"))
            model_.lose(sides.place, "*CONTACT EXCLUSIONS of " + shown(sides),
                        "general contact leaves out whole bodies, and not parts of their surfaces");
    }

    DeckModel& model_;
    const std::vector<DeckBody>& bodies_;
    double friction_ = 0; ///< of all
    bool any_rule_ = false;
    std::string rules_;
    std::set<std::string> taken_;
};

} // namespace

void add_pairs_of_general_contact(DeckModel& model) {
    DeckGeneralContact& general = model.general;
    if (general.all) return; // they are among all
    for (const Sides& sides : general.included) {
        if (sides.first.empty() || sides.second.empty() || sides.first == sides.second) {
            model.lose(sides.place, "contact of " + shown(sides),
                       "only two named surfaces, or all, have a counterpart");
            continue;
        }
        DeckPair pair;
        pair.slave = sides.first;
        pair.master = sides.second;
        pair.mortar = pair.either = true;
        pair.place = sides.place;
        if (const Sides* all = law_of_all(general)) pair.interaction = all->interaction;
        for (const Sides& law : general.laws)
            if ((law.first == sides.first && law.second == sides.second) ||
                (law.first == sides.second && law.second == sides.first))
                pair.interaction = law.interaction;
        model.pairs.push_back(pair);
    }
    const auto is_of = [&](const Sides& law) {
        return (law.first.empty() && law.second.empty()) ||
               std::ranges::any_of(general.included, [&](const Sides& sides) {
                   return (law.first == sides.first && law.second == sides.second) ||
                          (law.first == sides.second && law.second == sides.first);
               });
    };
    for (const Sides& law : general.laws)
        if (!is_of(law))
            model.lose(law.place, "the law of " + shown(law), "no *CONTACT INCLUSIONS has just these surfaces");
    for (const Sides& sides : general.excluded)
        model.lose(sides.place, "*CONTACT EXCLUSIONS of " + shown(sides), "pairs of surfaces keep all of their facets");
    if (!general.place.empty() && general.included.empty())
        model.lose(general.place, "*CONTACT", "no *CONTACT INCLUSIONS says which surfaces meet");
}

std::string write_general_contact(DeckModel& model, const std::vector<DeckBody>& bodies) {
    return model.general.all ? Writer(model, bodies).write() : "";
}

} // namespace osculate::deck
