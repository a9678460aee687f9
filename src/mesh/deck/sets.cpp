#include "mesh/deck/sets.hpp"

#include "mesh/sort_unique.hpp"

#include <utility>

namespace osculate::mesh {

std::vector<Index>& DeckSets::named(const std::string& name) {
    const std::string key = in_capitals(name);
    names_.try_emplace(key, name);
    return sets_[key];
}

const std::vector<Index>* DeckSets::find(std::string_view name) const {
    const auto found = sets_.find(in_capitals(name));
    return found == sets_.end() ? nullptr : &found->second;
}

std::map<std::string, std::vector<Index>> DeckSets::take_sets() {
    std::map<std::string, std::vector<Index>> sets;
    for (auto& [key, members] : sets_) {
        sort_unique(members);
        sets[names_[key]] = std::move(members);
    }
    return sets;
}

void DeckSets::read_defined(const DeckCard& card, std::size_t fields) {
    const std::string* name = card.parameter(parameter_);
    if (name == nullptr || name->empty()) return;
    std::vector<Index>& members = named(*name);
    std::size_t seen = 0;
    for (auto line = reading_.deck.begin(card); line != reading_.deck.end(card); ++line) {
        if (seen == 0) {
            long long id = 0;
            const std::string_view text = line->text;
            if (!to_integer(trimmed(text.substr(0, text.find(','))), id)) continue;
            if (const Index number = numbers_.look_up(id); number >= 0) members.push_back(number);
        }
        if (fields == 1) continue; // a line each
        split_fields(line->text, fields_);
        seen += fields_.size();
        if (seen >= fields) seen = 0;
    }
}

void DeckSets::read(const DeckCard& card) {
    const std::string* name = card.parameter(parameter_);
    if (name == nullptr || name->empty())
        return reading_.fault(card, "*" + card.keyword + " without " + parameter_ + "=name");
    std::vector<Index> members;
    const bool generate = card.parameter("GENERATE") != nullptr;
    for (auto line = reading_.deck.begin(card); line != reading_.deck.end(card); ++line) {
        split_fields(line->text, fields_);
        if (generate)
            add_range(*line, members);
        else if (!add_members(*line, members))
            return;
    }
    std::vector<Index>& to = named(*name);
    to.insert(to.end(), members.begin(), members.end());
    if (to.size() > 1000 && to.size() > 4 * numbers_.order().size()) sort_unique(to);
}

bool DeckSets::add_members(const DeckLine& line, std::vector<Index>& members) {
    for (const std::string_view field : fields_) {
        if (field.empty()) continue;
        long long id = 0;
        if (to_integer(field, id)) {
            const Index number = numbers_.look_up(id);
            if (number >= 0)
                members.push_back(number);
            else if (!reading_.refused)
                reading_.fault(line, numbers_.word() + " " + reading_.deck.instances.shown(id) + " does not exist");
            continue;
        }
        const std::vector<Index>* found = find(field);
        if (found == nullptr) {
            reading_.fault(line, "no set is called '" + shown(field) + "' before this line");
            continue;
        }
        if (!reading_.generate(found->size())) {
            reading_.fault(line, "sets of sets with too many members");
            return false;
        }
        members.insert(members.end(), found->begin(), found->end());
    }
    return true;
}

void DeckSets::add_range(const DeckLine& line, std::vector<Index>& members) {
    long long first = 0, last = 0, by = 1;
    if (fields_.size() < 2 || fields_.size() > 3 || !to_integer(fields_[0], first) || !to_integer(fields_[1], last) ||
        (fields_.size() == 3 && !fields_[2].empty() && !to_integer(fields_[2], by)) || by <= 0 || first <= 0 ||
        last < first || last > DeckNumbers::largest)
        return reading_.fault(line, "GENERATE takes first, last, step, found '" + shown(line.source) + "'");
    const DeckOrder& order = numbers_.order();
    if ((last - first) / by > static_cast<long long>(order.size())) { // mostly gaps: over those that exist
        if (!reading_.generate(order.size())) return reading_.fault(line, "sets with too many members");
        for (auto at = first_from(order, first); at != order.end() && at->first <= last; ++at)
            if ((at->first - first) % by == 0) members.push_back(at->second);
        return;
    }
    if (!reading_.generate(static_cast<std::size_t>((last - first) / by + 1)))
        return reading_.fault(line, "sets with too many members");
    for (long long id = first; id <= last; id += by)
        if (const Index number = numbers_.look_up(id); number >= 0) members.push_back(number);
}

} // namespace osculate::mesh
