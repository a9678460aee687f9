#include "mesh/deck/assembly.hpp"

#include "mesh/deck/instance.hpp"
#include "mesh/deck/numbers.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

namespace osculate::mesh {
namespace {

/// What only the model as a whole has, and not a part of it.
const std::set<std::string> of_model{
    "STEP",        "BOUNDARY",          "CLOAD",   "DLOAD",    "DSLOAD",    "TEMPERATURE",       "CONTACTPAIR",
    "MODELCHANGE", "INITIALCONDITIONS", "CONTACT", "MATERIAL", "AMPLITUDE", "SURFACEINTERACTION"};
/// Whose lines name sets, surfaces, nodes or elements.
const std::set<std::string> with_names{"NSET",
                                       "ELSET",
                                       "SURFACE",
                                       "BOUNDARY",
                                       "CLOAD",
                                       "DLOAD",
                                       "DSLOAD",
                                       "TEMPERATURE",
                                       "TIE",
                                       "CONTACTPAIR",
                                       "MODELCHANGE",
                                       "INITIALCONDITIONS",
                                       "EQUATION",
                                       "CONTACTINCLUSIONS",
                                       "MPC",
                                       "CYCLICSYMMETRYMODEL",
                                       "CONTACTEXCLUSIONS",
                                       "CONTACTPROPERTYASSIGNMENT"};

class Assembly {
public:
    explicit Assembly(const Deck& deck) : deck_(deck), writer_(deck) {}

    Deck write() {
        const bool sorted = std::ranges::all_of(deck_.cards, [&](const DeckCard& card) { return sort(card); });
        if (sorted && level_ != Level::model)
            fault(*open_, "*" + open_->keyword + " that no *END " + open_->keyword + " ends");
        if (sorted && instances_.empty())
            fault(*first_, "parts, but no *ASSEMBLY with an *INSTANCE of one: the deck has no mesh");
        faults_.throw_if_any();
        number();
        check_size();
        faults_.throw_if_any();
        for (const Item& item : items_) write(item);
        for (const Item& item : items_)
            if (item.begins) write_whole(item);
        faults_.throw_if_any();
        return writer_.take();
    }

private:
    enum class Level : char { model, part, assembly, instance };
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// A card to be written.
    struct Item {
        const DeckCard* card;
        std::size_t instance = none; ///< that it belongs to; none: the assembly, or the model
        bool begins = false;         ///< the instance
    };
    struct Part {
        std::string name;
        std::vector<const DeckCard*> cards;
    };

    void fault(const DeckCard& card, const std::string& what) { faults_.add(deck_.place(card), what); }

    [[nodiscard]] std::string what_is_open() const {
        const std::string* name = open_->parameter("NAME");
        return "*" + open_->keyword + (name == nullptr ? "" : " '" + shown(*name) + "'") + " of " + deck_.place(*open_);
    }

    // ---- which card belongs where ----

    /// False: what follows would only repeat the fault.
    bool sort(const DeckCard& card) {
        const std::string word = keyword_of(card);
        if (word == "PART") return begin_part(card);
        if (word == "ASSEMBLY") return begin_assembly(card);
        if (word == "INSTANCE") return begin_instance(card);
        if (word == "ENDPART") return end(card, Level::part, Level::model);
        if (word == "ENDASSEMBLY") return end(card, Level::assembly, Level::model);
        if (word == "ENDINSTANCE") return end(card, Level::instance, Level::assembly);
        if (level_ != Level::model && of_model.contains(word)) {
            fault(card, "*" + card.keyword + " belongs to the model, but stands in the " + what_is_open() +
                            ", which nothing ends before it");
            return false;
        }
        if (level_ == Level::part)
            part_->cards.push_back(&card);
        else
            items_.push_back({&card, level_ == Level::instance ? instances_.size() - 1 : none});
        return true;
    }

    bool begin_part(const DeckCard& card) {
        if (level_ != Level::model) {
            fault(card, "a *PART inside the " + what_is_open() + ": parts stand side by side, each with its *END PART");
            return false;
        }
        const std::string* name = card.parameter("NAME");
        if (name == nullptr || name->empty()) fault(card, "*PART without NAME=name");
        const std::string own = name == nullptr ? "" : *name;
        const auto [at, fresh] = parts_.try_emplace(in_capitals(own), Part{own, {}});
        if (!fresh) fault(card, "a second *PART is called '" + shown(own) + "'");
        part_ = &at->second;
        level_ = Level::part;
        open_ = &card;
        if (first_ == nullptr) first_ = &card;
        return true;
    }

    bool begin_assembly(const DeckCard& card) {
        if (level_ != Level::model) {
            fault(card, "an *ASSEMBLY inside the " + what_is_open() + ", which nothing ends before it");
            return false;
        }
        if (assembly_ != nullptr) fault(card, "a second *ASSEMBLY; the first is that of " + deck_.place(*assembly_));
        level_ = Level::assembly;
        open_ = assembly_ = &card;
        if (first_ == nullptr) first_ = &card;
        if (const std::string* name = card.parameter("NAME")) assembly_name_ = in_capitals(*name);
        return true;
    }

    bool begin_instance(const DeckCard& card) {
        if (level_ != Level::assembly) {
            fault(card, level_ == Level::model
                            ? "an *INSTANCE outside *ASSEMBLY"
                            : "an *INSTANCE inside the " + what_is_open() + ", which nothing ends before it");
            return false;
        }
        level_ = Level::instance;
        open_ = &card;
        const std::string *name = card.parameter("NAME"), *part = card.parameter("PART");
        const std::string own = name == nullptr ? "" : *name;
        if (own.empty()) fault(card, "*INSTANCE without NAME=name");
        if (!own.empty() && !is_letter(own.front()))
            fault(card, "the name of an *INSTANCE begins with a letter, found '" + shown(own) + "'");
        if (!number_of_.try_emplace(in_capitals(own), instances_.size()).second)
            fault(card, "a second *INSTANCE is called '" + shown(own) + "'");
        instances_.emplace_back(own, placement_of(deck_, card, faults_));
        items_.push_back({&card, instances_.size() - 1, true});
        if (part == nullptr)
            fault(card, card.parameter("INSTANCE") != nullptr || card.parameter("LIBRARY") != nullptr
                            ? "*INSTANCE of another analysis: its mesh is not in this deck"
                            : "*INSTANCE without PART=part");
        else if (const auto at = parts_.find(in_capitals(*part)); at == parts_.end())
            fault(card, "*INSTANCE '" + shown(own) + "' of part '" + shown(*part) +
                            "', but no *PART before it is called so" +
                            listed(parts_, [](const auto& one) { return one.second.name; }));
        else
            for (const DeckCard* one : at->second.cards) items_.push_back({one, instances_.size() - 1});
        return true;
    }

    bool end(const DeckCard& card, Level ended, Level outer) {
        if (level_ != ended) {
            fault(card, "*" + card.keyword +
                            (level_ == Level::model ? " that ends nothing" : " inside the " + what_is_open()));
            return false;
        }
        level_ = outer;
        if (outer == Level::assembly) open_ = assembly_;
        return true;
    }

    template <class Map, class Name> static std::string listed(const Map& all, const Name& name) {
        std::string names;
        for (const auto& one : all) names += (names.empty() ? "; there are: " : ", ") + name(one);
        return shown_list(names);
    }
    static std::string shown_list(std::string names) {
        constexpr std::size_t longest = 200;
        if (names.size() > longest) names = names.substr(0, longest) + "...";
        return names;
    }
    [[nodiscard]] std::string list_of_instances() const {
        return listed(instances_, [](const DeckInstance& one) { return one.name(); });
    }

    // ---- numbers ----

    void number() {
        long long largest_of_assembly = 0;
        for (const Item& item : items_) {
            if (item.begins) continue;
            if (item.instance == none)
                largest_of_assembly = std::max(largest_of_assembly, largest_number(deck_, *item.card));
            else
                instances_[item.instance].survey(deck_, *item.card);
        }
        long long largest = largest_of_assembly, all = largest_of_assembly, stride = 10;
        for (const DeckInstance& one : instances_) {
            largest = std::max(largest, one.largest());
            all += one.largest();
        }
        while (stride <= largest) stride *= 10;
        // numbers that one can read, or as small as can be
        const auto count = static_cast<long long>(instances_.size());
        const bool close = stride > DeckNumbers::largest / (count + 1);
        if (close && all > DeckNumbers::largest)
            fault(deck_.cards.front(), "too many nodes and elements in all instances");
        long long before = largest_of_assembly;
        for (std::size_t k = 0; k < instances_.size(); ++k) {
            instances_[k].number_from(close ? before : stride * static_cast<long long>(k + 1));
            before += instances_[k].largest();
            writer_.deck().instances.add({instances_[k].name(), instances_[k].before()});
        }
    }

    /// A short deck must not fill the memory.
    void check_size() {
        constexpr std::size_t most = 50'000'000;
        std::size_t lines = 0;
        for (const Item& item : items_) lines += item.card->last - item.card->first;
        if (lines > std::max(most, 2 * deck_.lines.size()))
            fault(*assembly_, "its instances have more than 50 million lines together");
    }

    // ---- the deck without parts ----

    void write(const Item& item) {
        const DeckCard& card = *item.card;
        if (item.begins) return;
        if (item.instance != none) return instances_[item.instance].write(deck_, card, true, writer_, faults_);
        if (const std::string* name = card.parameter("INSTANCE");
            name != nullptr && (card.keyword == "NSET" || card.keyword == "ELSET")) {
            if (const DeckInstance* one = instance(*name)) return one->write(deck_, card, false, writer_, faults_);
            return fault(card, "no *INSTANCE is called '" + shown(*name) + "'" + list_of_instances());
        }
        write_of_assembly(card);
    }

    /// A set of all elements of an instance, where the assembly has no other one of its name.
    void write_whole(const Item& item) {
        const DeckInstance& one = instances_[item.instance];
        const std::string key = in_capitals(one.name());
        const bool taken = std::ranges::any_of(items_, [&](const Item& other) {
            const std::string* name = other.instance == none ? other.card->parameter("ELSET") : nullptr;
            return name != nullptr && in_capitals(*name) == key;
        });
        if (one.has_elements() && !taken) one.write_whole(*item.card, writer_);
    }

    void write_of_assembly(const DeckCard& card) {
        const std::string word = keyword_of(card);
        DeckCard made = card;
        if (word != "HEADING")
            for (auto& [key, value] : made.parameters)
                if (key != "NAME" && value.find('.') != std::string::npos)
                    value = known(value, {deck_, card.file, card.line, faults_}, false);
        if (!with_names.contains(word)) return writer_.copy(std::move(made));
        writer_.begin(std::move(made));
        std::vector<std::string_view> fields;
        for (auto line = deck_.begin(card); line != deck_.end(card); ++line) {
            if (line->text.find('.') == std::string_view::npos) {
                writer_.line(*line, line->text);
                continue;
            }
            split_fields(line->text, fields);
            std::string text;
            for (std::size_t f = 0; f < fields.size(); ++f)
                text +=
                    (f > 0 ? ", " : "") + as_field(known(fields[f], {deck_, line->file, line->line, faults_}, true));
            writer_.line(*line, text);
        }
        writer_.end();
    }

    /// A name or number of the assembly as it is in the whole deck. @param strict  an instance that there is none of is a fault
    [[nodiscard]] std::string known(std::string_view text, const DeckPlace& place, bool strict) const {
        std::string name(text);
        std::erase(name, '"');
        for (;;) {
            const std::size_t dot = name.find('.');
            if (dot == std::string::npos || dot == 0 || !is_letter(name.front())) return name;
            const std::string head = name.substr(0, dot), own = name.substr(dot + 1);
            if (const DeckInstance* one = instance(head)) return one->global(own, place);
            if (in_capitals(head) != assembly_name_ && strict)
                place.fault("'" + shown(text) + "': no *INSTANCE is called '" + shown(head) + "'" +
                            list_of_instances());
            if (in_capitals(head) != assembly_name_) return name;
            name = own;
        }
    }

    [[nodiscard]] const DeckInstance* instance(std::string_view name) const {
        const auto at = number_of_.find(in_capitals(name));
        return at == number_of_.end() ? nullptr : &instances_[at->second];
    }

    static bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }

    const Deck& deck_;
    DeckWriter writer_;
    DeckFaults faults_;
    Level level_ = Level::model;
    const DeckCard *open_ = nullptr, *assembly_ = nullptr; ///< what is read, and the assembly
    const DeckCard* first_ = nullptr;                      ///< part or assembly
    Part* part_ = nullptr;                                 ///< that is read
    std::map<std::string, Part> parts_;                    ///< by names in capitals
    std::string assembly_name_;                            ///< in capitals
    std::vector<DeckInstance> instances_;
    std::map<std::string, std::size_t> number_of_; ///< of instances by names in capitals
    std::vector<Item> items_;
};

} // namespace

Deck without_parts(Deck deck) {
    static const std::set<std::string> words{"PART", "INSTANCE", "ASSEMBLY", "ENDPART", "ENDINSTANCE", "ENDASSEMBLY"};
    const bool any =
        std::ranges::any_of(deck.cards, [](const DeckCard& card) { return words.contains(keyword_of(card)); });
    return any ? Assembly(deck).write() : deck;
}

} // namespace osculate::mesh
