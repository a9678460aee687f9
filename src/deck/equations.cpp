#include "deck/equations.hpp"

#include "deck/words.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace osculate::deck {

bool EquationCards::take(const DeckCard& card, const std::string& word, bool in_step) {
    if (word != "EQUATION") return false;
    if (in_step || given(card, "REMOVE") != nullptr || given(card, "REMOVEALL") != nullptr) {
        lose(card, "equations hold for the whole run");
        return true;
    }
    const std::size_t lines = card.last - card.first;
    for (std::size_t line = 0; line < lines;) {
        const DeckLine& head = *(deck_.begin(card) + static_cast<std::ptrdiff_t>(line));
        split_fields(head.text, fields_);
        long long count = 0;
        if (fields_.size() != 1 || !to_integer(fields_[0], count) || count < 1) {
            lose(deck_.place(head), std::string(head.source.substr(0, 60)), "a number of terms was expected");
            return true;
        }
        std::vector<Term> terms;
        ++line;
        if (!terms_of(card, line, static_cast<std::size_t>(count), terms)) return true;
        add(deck_.place(head), terms);
    }
    return true;
}

bool EquationCards::terms_of(const DeckCard& card, std::size_t& line, std::size_t wanted, std::vector<Term>& terms) {
    const std::size_t lines = card.last - card.first;
    for (; line < lines && terms.size() < wanted; ++line) {
        const DeckLine& text = *(deck_.begin(card) + static_cast<std::ptrdiff_t>(line));
        split_fields(text.text, fields_);
        for (std::size_t f = 0; f + 2 < fields_.size() && terms.size() < wanted; f += 3) {
            Term& term = terms.emplace_back();
            long long component = 0;
            term.points = points_of(fields_[f]);
            if (term.points.empty() || !to_integer(fields_[f + 1], component) || component < 1 || component > 3 ||
                !to_number(fields_[f + 2], term.factor)) {
                lose(deck_.place(text), std::string(text.source.substr(0, 60)),
                     "a node or node set, a component from 1 to 3 and a factor were expected");
                return false;
            }
            term.component = static_cast<int>(component) - 1;
        }
    }
    if (terms.size() == wanted) return true;
    lose(card, "fewer terms than announced");
    return false;
}

void EquationCards::add(const std::string& place, const std::vector<Term>& terms) {
    const std::size_t count = terms.front().points.size();
    // which node of one set belongs to which of another depends on the order in which a program keeps them
    for (std::size_t k = 1; k < terms.size(); ++k)
        if (terms[k].points.size() != 1)
            return lose(place, "*EQUATION", "only its first term may be a set of several nodes");
    for (std::size_t k = 0; k < count; ++k) {
        DeckEquation equation;
        equation.place = place;
        for (const Term& term : terms)
            equation.terms.push_back({term.points[&term == &terms.front() ? k : 0], term.component, term.factor});
        model_.equations.push_back(std::move(equation));
    }
}

namespace {

/// Factors of a node, in the axes of the deck.
struct NodeTerm {
    Index point = -1;
    Vec3 factors = Vec3::Zero();
};

std::string vector(const Vec3& v) {
    return "[" + number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]) + "]";
}

} // namespace

std::string write_equations(DeckModel& model, DeckSets& sets) {
    /// What all of a group have, and the nodes of their first terms.
    struct Group {
        std::size_t body = 0;
        Vec3 factors = Vec3::Zero();
        std::vector<NodeTerm> others;
        std::vector<Index> points;
    };
    std::vector<Group> groups;
    std::map<std::string, std::size_t> known;
    for (const DeckEquation& equation : model.equations) {
        std::vector<NodeTerm> terms;
        bool all = true;
        for (const auto& [point, component, factor] : equation.terms) {
            all = all && sets.body_of(point) >= 0;
            const auto at = std::ranges::find(terms, point, &NodeTerm::point);
            NodeTerm& term = at != terms.end() ? *at : terms.emplace_back(NodeTerm{point});
            term.factors += factor * model.axes_of(point).col(component);
        }
        if (!all) {
            model.lose(equation.place, "*EQUATION", "it has a node that no element has");
            continue;
        }
        std::string key = fmt::format("{} {}", sets.body_of(terms.front().point), vector(terms.front().factors));
        for (std::size_t k = 1; k < terms.size(); ++k)
            key += fmt::format(" {} {}", terms[k].point, vector(terms[k].factors));
        const auto [at, fresh] = known.try_emplace(key, groups.size());
        if (fresh)
            groups.push_back({static_cast<std::size_t>(sets.body_of(terms.front().point)),
                              terms.front().factors,
                              std::vector<NodeTerm>(terms.begin() + 1, terms.end()),
                              {}});
        groups[at->second].points.push_back(terms.front().point);
    }
    std::string text;
    std::size_t count = 0;
    for (Group& group : groups) {
        std::ranges::sort(group.points);
        group.points.erase(std::unique(group.points.begin(), group.points.end()), group.points.end());
        std::string others;
        for (const NodeTerm& other : group.others)
            others +=
                ", " +
                sets.of_points(static_cast<std::size_t>(sets.body_of(other.point)), {other.point}, "led_by").front() +
                ": " + vector(other.factors);
        for (const std::string& set : sets.of_points(group.body, group.points, "led"))
            text += fmt::format("  equation_{}: {{each: {}, terms: {{{}: {}{}}}}}\n", ++count, set, set,
                                vector(group.factors), others);
    }
    return text;
}

} // namespace osculate::deck
