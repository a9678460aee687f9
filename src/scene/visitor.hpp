#pragma once
/// One description of every key; reader, writer and key list are visitors of it.

#include "osculate/core/types.hpp"
#include "osculate/scene/course.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/scene/units.hpp"

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace osculate::scene {

/// Interval of admissible numbers.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool open_low = false, open_high = false;

    [[nodiscard]] bool contains(double x) const {
        return (open_low ? x > low : x >= low) && (open_high ? x < high : x <= high);
    }
    [[nodiscard]] std::string text() const; ///< "> 0", "in (-1, 0.5)"; empty when there is no bound
};

namespace range {
inline constexpr Range positive{.low = 0, .open_low = true};
inline constexpr Range not_negative{.low = 0};
inline constexpr Range fraction{.low = 0, .high = 1};
inline constexpr Range size{.low = 1e-12, .high = 1e9};     ///< of anything that must have an extent
inline constexpr Range position{.low = -1e9, .high = 1e9};  ///< a coordinate or a displacement
inline constexpr Range direction{.low = -1e9, .high = 1e9}; ///< a component of a vector without unit
} // namespace range

/// Whose name a text or a map's key must be.
enum class Names { any, identifier, body, set, pair, rigid /* a body, which must be rigid, or a coupling */ };

using Words = std::vector<std::string>;

inline const Words course_tags{"table", "expression"}; ///< of a value that changes over a stage

/// What is known of a key; members that a kind of value has no use for stay at their defaults.
struct Key {
    std::string name;
    const char* meaning = "";
    Dimension unit{};
    Range range{};
    bool required = false;
    bool not_whole = false;     ///< a whole number is outside the range
    bool direction = false;     ///< the vector must not be zero
    bool bare_word = false;     ///< `key: tag` stands for `key: {tag: {}}`
    bool bare_flag = false;     ///< `key: true` stands for `key: {}`, false for an optional group that is absent
    Names names = Names::any;   ///< of a text, or of the keys of a named map
    const char* item = "";      ///< what a named map holds: "body"
    double largest_product = 0; ///< of divisions
    const char* default_text = nullptr; ///< where the default is not the member's own value
    const char* instead = nullptr;      ///< of a required key: the key that may stand in its place, which a rule judges
};

/// Exactly one of several tags, as keys of the current map.
struct Choice {
    const Words& tags;
    std::size_t active;
    bool required;
    std::function<void(std::size_t)> choose;   ///< makes an alternative the active one
    std::function<void(std::size_t)> describe; ///< the key `tags[i]` with what it holds; i is active
};

/// A map from names to values.
struct Entries {
    std::function<std::size_t()> size;
    std::function<std::string(std::size_t)> name;
    std::function<void(const std::string&)> add;
    std::function<void(std::size_t)> describe; ///< the key name(i) with what it holds
    Words reserved{};                          ///< keys of the map that are no such names, ...
    std::function<void()> beside{};            ///< ... and their description; empty: none
    std::function<bool()> beside_present{};    ///< whether there are any of them
};

class Visitor {
public:
    virtual ~Visitor() = default;
    virtual void number(const Key& key, double& value) = 0;
    virtual void optional_number(const Key& key, std::optional<double>& value) = 0;
    /// A plain number within the key's range, or a length with its unit.
    virtual void optional_relative_length(const Key& key, std::optional<RelativeLength>& value) = 0;
    virtual void vector(const Key& key, Vec3& value) = 0;
    virtual void optional_vector(const Key& key, std::optional<Vec3>& value) = 0;
    virtual void course(const Key& key, Course& value) = 0;
    virtual void optional_course(const Key& key, std::optional<Course>& value) = 0;
    virtual void courses(const Key& key, std::array<Course, 3>& value) = 0; ///< components of a vector
    /// Rows [first, value], with an ascending first.
    virtual void table(const Key& key, const Key& first, Table& value) = 0;
    virtual void integer(const Key& key, int& value) = 0;
    virtual void divisions(const Key& key, std::array<int, 3>& value) = 0;
    virtual void integers(const Key& key, std::vector<int>& value) = 0; ///< one or more
    virtual void flag(const Key& key, bool& value) = 0;
    virtual void text(const Key& key, std::string& value) = 0;
    virtual void two_names(const Key& key, std::array<std::string, 2>& value) = 0; ///< empty: not given
    virtual void word(const Key& key, const Words& vocabulary, std::size_t& index) = 0;
    virtual void words(const Key& key, const Words& vocabulary, std::vector<std::string>& value) = 0;
    virtual void axes(const Key& key, Mat3& value) = 0; ///< columns; the first two are written
    virtual void points(const Key& key, std::vector<Vec3>& value) = 0;
    virtual void group(const Key& key, const std::function<void()>& body) = 0;
    virtual void optional_group(const Key& key, bool& present, const std::function<void()>& body) = 0;
    virtual void one_of(const Choice& choice) = 0;
    virtual void named(const Key& key, const Entries& entries) = 0;
};

/// "1, 5, 7"
[[nodiscard]] inline std::string listed(const std::vector<int>& numbers) {
    std::string text;
    for (const int number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
    return text;
}

/// Walks over the values that are there: what is absent or empty is passed over.
class PresentVisitor : public Visitor {
public:
    void optional_group(const Key& key, bool& present, const std::function<void()>& body) override {
        if (present) group(key, body);
    }
    void one_of(const Choice& choice) override { choice.describe(choice.active); }
    void named(const Key& key, const Entries& entries) override {
        if (entries.size() == 0 && !(entries.beside && entries.beside_present())) return;
        group(key, [&] {
            if (entries.beside) entries.beside();
            for (std::size_t i = 0; i < entries.size(); ++i) entries.describe(i);
        });
    }
};

} // namespace osculate::scene
