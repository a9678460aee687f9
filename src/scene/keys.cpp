#include "osculate/scene/keys.hpp"

#include "scene/article.hpp"
#include "scene/describe.hpp"
#include "scene/overrides.hpp"
#include "scene/tree.hpp"

#include <algorithm>

namespace osculate::scene {

namespace {

/// Lists every key it is shown, all alternatives included, with one made-up entry in every named map.
class KeyLister final : public Visitor {
public:
    explicit KeyLister(const std::string& prefix) : prefix_(prefix.empty() ? Words{} : split_path(prefix)) {}

    [[nodiscard]] std::string take_text() { return std::move(text_); }

    void number(const Key& key, double& value) override { list(key, unit(key), number_text(value)); }
    void optional_number(const Key& key, std::optional<double>& /*value*/) override { list(key, unit(key), "not set"); }
    void optional_relative_length(const Key& key, std::optional<RelativeLength>& /*value*/) override {
        list(key, unit(key), "not set", "or a length with its unit");
    }
    void vector(const Key& key, Vec3& value) override {
        list(key, "[x, y, z] " + unit(key),
             "[" + number_text(value.x()) + ", " + number_text(value.y()) + ", " + number_text(value.z()) + "]");
    }
    void optional_vector(const Key& key, std::optional<Vec3>& /*value*/) override {
        list(key, "[x, y, z] " + unit(key), "not set");
    }
    void course(const Key& key, Course& value) override { list(key, unit(key), number_text(value.value()), over_time); }
    void optional_course(const Key& key, std::optional<Course>& /*value*/) override {
        list(key, unit(key), "not set", over_time);
    }
    void courses(const Key& key, std::array<Course, 3>& /*value*/) override {
        list(key, "[x, y, z] " + unit(key), "[0, 0, 0]", std::string("each ") + over_time);
    }
    void table(const Key& key, const Key& first, Table& /*value*/) override {
        list(key, "rows [" + first.name + " (" + unit_of(first.unit) + "), " + unit(key) + "]", "none");
    }
    void integer(const Key& key, int& value) override { list(key, "whole number", std::to_string(value)); }
    void divisions(const Key& key, std::array<int, 3>& value) override {
        list(key, "three whole numbers",
             "[" + std::to_string(value[0]) + ", " + std::to_string(value[1]) + ", " + std::to_string(value[2]) + "]",
             "product <= " + number_text(key.largest_product));
    }
    void integers(const Key& key, std::vector<int>& /*value*/) override { list(key, "whole numbers", "none"); }
    void flag(const Key& key, bool& value) override { list(key, "true or false", value ? "true" : "false"); }
    void text(const Key& key, std::string& value) override {
        list(key,
             key.names == Names::body   ? "name of a body"
             : key.names == Names::set  ? "name of a set"
             : key.names == Names::pair ? "name of a pair"
                                        : "text",
             value.empty() ? "none" : value);
    }
    void two_names(const Key& key, std::array<std::string, 2>& /*value*/) override {
        list(key, "names of two sets", "none");
    }
    void word(const Key& key, const Words& vocabulary, std::size_t& index) override {
        list(key, "one of " + join(vocabulary), vocabulary[index]);
    }
    void words(const Key& key, const Words& vocabulary, std::vector<std::string>& /*value*/) override {
        list(key, "list of " + join(vocabulary), "[]");
    }
    void points(const Key& key, std::vector<Vec3>& /*value*/) override {
        list(key, "points [x, y, z], each " + with_article(unit(key)), "none");
    }
    void axes(const Key& key, Mat3& /*value*/) override { list(key, "two directions", "[[1, 0, 0], [0, 1, 0]]"); }
    void group(const Key& key, const std::function<void()>& body) override {
        if (*key.meaning) list(key, "map", "");
        path_.push_back(key.name);
        body();
        path_.pop_back();
    }
    void optional_group(const Key& key, bool& /*present*/, const std::function<void()>& body) override {
        group(key, body);
    }
    void one_of(const Choice& choice) override {
        for (std::size_t i = 0; i < choice.tags.size(); ++i) {
            choice.choose(i);
            alternatives_ = join(choice.tags, " | ");
            choice.describe(i);
        }
        choice.choose(choice.active);
    }
    void named(const Key& key, const Entries& entries) override {
        list(key, std::string("map of <") + key.item + ">", "none");
        path_.push_back(key.name);
        if (entries.beside) entries.beside();
        entries.add(std::string("<") + key.item + ">");
        entries.describe(0);
        path_.pop_back();
    }

private:
    static constexpr const char* over_time =
        "or {table: [[time, value], ...]} or {expression: formula in t, unit: its unit}";
    static std::string unit(const Key& key) {
        return key.unit == dimension::none ? "number" : name_of(key.unit) + " in " + unit_of(key.unit);
    }

    /// A made-up name stands for any name; the listed key must lie at or below the prefix.
    [[nodiscard]] bool below_prefix(const std::vector<std::string>& path) const {
        if (path.size() < prefix_.size()) return false;
        for (std::size_t i = 0; i < prefix_.size(); ++i)
            if (!path[i].starts_with('<') && path[i] != prefix_[i]) return false;
        return true;
    }

    void list(const Key& key, const std::string& type, const std::string& value, const std::string& limit = {}) {
        // The first key described after a choice began is that alternative's own tag.
        const std::string choice = std::exchange(alternatives_, {});
        std::vector<std::string> path = path_;
        path.push_back(key.name);
        if (!below_prefix(path)) return;
        text_ += join(path, ".") + "\n    " + type;
        const std::string bounds = key.range.text();
        if (!bounds.empty()) text_ += ", " + bounds;
        if (key.not_whole) text_ += ", not whole";
        if (!limit.empty()) text_ += ", " + limit;
        if (!choice.empty())
            text_ += "; one of " + choice;
        else if (key.required)
            text_ +=
                key.instead == nullptr ? "; required" : std::string("; required unless ") + key.instead + " is given";
        else if (key.default_text || !value.empty())
            text_ += "; default " + std::string(key.default_text ? key.default_text : value);
        text_ += ". ";
        text_ += key.meaning;
        text_ += "\n";
    }

    std::vector<std::string> prefix_;
    std::vector<std::string> path_;
    std::string alternatives_;
    std::string text_;
};

} // namespace

std::string describe_keys(const std::string& path_prefix) {
    KeyLister lister(path_prefix);
    Scene defaults;
    describe(lister, defaults);
    return lister.take_text();
}

} // namespace osculate::scene
