#pragma once
/// Input decks of Abaqus and CalculiX: keyword lines with their data lines.

#include "osculate/mesh/instances.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osculate::mesh {

/// A line of data, without comments and empty lines.
struct DeckLine {
    std::string_view text;
    int line = 0;            ///< 1-based
    int file = 0;            ///< index into Deck::files
    std::string_view source; ///< as the file has it, for messages; the numbers of `text` may be others
};

/// `*KEYWORD, PARAMETER=value, ...` and the data below it.
struct DeckCard {
    std::string keyword; ///< in capitals, without the star, one blank between words
    std::vector<std::pair<std::string, std::string>> parameters; ///< names in capitals without blanks; values trimmed
    int line = 0, file = 0;
    std::size_t first = 0, last = 0; ///< range in Deck::lines: first, and one past the last

    /// Value of a parameter, empty for a parameter without value; nullptr if the parameter is not given.
    [[nodiscard]] const std::string* parameter(std::string_view name) const;
};

/// Never has parts: instances are written out when a deck is read, with numbers of their own and names INSTANCE.NAME.
struct Deck {
    std::vector<std::string> files; ///< the deck and the files that it includes
    std::vector<DeckCard> cards;
    std::vector<DeckLine> lines;
    std::vector<std::shared_ptr<const std::string>> texts; ///< the storage to which lines refer
    Instances instances;                                   ///< whose numbers the deck's are

    [[nodiscard]] std::string place(int file, int line) const { return files[file] + ":" + std::to_string(line); }
    [[nodiscard]] std::string place(const DeckCard& card) const { return place(card.file, card.line); }
    [[nodiscard]] std::string place(const DeckLine& line) const { return place(line.file, line.line); }
    [[nodiscard]] auto begin(const DeckCard& card) const {
        return lines.begin() + static_cast<std::ptrdiff_t>(card.first);
    }
    [[nodiscard]] auto end(const DeckCard& card) const {
        return lines.begin() + static_cast<std::ptrdiff_t>(card.last);
    }
};

/// Reads a deck and the files that it includes (*INCLUDE, INPUT=file; the path is relative to the folder of the
/// including file).
/// Throws MeshError: a file that cannot be read, inclusion deeper than 10, more than 4 GB, data before any keyword, parts
/// and assemblies that do not fit together.
[[nodiscard]] Deck read_deck(const std::filesystem::path& path);

/// The same for a text that includes no files. @param name  for messages
[[nodiscard]] Deck parse_deck(std::string text, const std::string& name);

/// Splits a data line at its commas, but not those in quotes, into trimmed fields; quotes around a field are left out. A
/// comma at the very end adds no field.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::string in_capitals(std::string_view text);

/// Reads a number as Fortran does: signs, 1.D5, 1.E+5; false if the text is no number or the number is not finite.
[[nodiscard]] bool to_number(std::string_view text, double& value);
[[nodiscard]] bool to_integer(std::string_view text, long long& value);

} // namespace osculate::mesh
