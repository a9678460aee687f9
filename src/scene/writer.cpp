#include "osculate/scene/writer.hpp"

#include "scene/describe.hpp"
#include "scene/tree.hpp"

#include <algorithm>
#include <cctype>

namespace osculate::scene {

namespace {

/// A scalar as YAML: plain where that cannot be misread, double-quoted otherwise.
std::string in_quotes(const std::string& text) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '/'; };
    std::string lower = text;
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (!text.empty() && text.front() != '-' && text.front() != '.' && std::ranges::all_of(text, plain) &&
        lower != "null")
        return text;
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (c == '\n')
            result += "\\n";
        else if (c == '\t')
            result += "\\t";
        else if (c == '\r')
            result += "\\r";
        else
            result += c;
    }
    return result + '"';
}

/// A number that every YAML reader takes for one: some need the point in 1.0e+06.
std::string decimal(double value) {
    std::string text = number_text(value);
    const std::size_t exponent = text.find('e');
    if (exponent != std::string::npos && text.find('.') == std::string::npos) text.insert(exponent, ".0");
    return text;
}

/// Writes every key it is shown, two spaces deeper for every level.
class Writer final : public PresentVisitor {
public:
    [[nodiscard]] std::string take_text() { return std::move(text_); }

    void number(const Key& key, double& value) override { line(key, decimal(value)); }
    void optional_number(const Key& key, std::optional<double>& value) override {
        if (value) line(key, decimal(*value));
    }
    void optional_relative_length(const Key& key, std::optional<RelativeLength>& value) override {
        if (value) line(key, decimal(value->value) + (value->metres ? " m" : ""));
    }
    void vector(const Key& key, Vec3& value) override { line(key, list(value)); }
    void optional_vector(const Key& key, std::optional<Vec3>& value) override {
        if (value) line(key, list(*value));
    }
    void course(const Key& key, Course& value) override { line(key, inline_course(value)); }
    void optional_course(const Key& key, std::optional<Course>& value) override {
        if (value) line(key, inline_course(*value));
    }
    void courses(const Key& key, std::array<Course, 3>& value) override {
        line(key,
             "[" + inline_course(value[0]) + ", " + inline_course(value[1]) + ", " + inline_course(value[2]) + "]");
    }
    void table(const Key& key, const Key& /*first*/, Table& value) override { line(key, inline_table(value)); }
    void integer(const Key& key, int& value) override { line(key, std::to_string(value)); }
    void divisions(const Key& key, std::array<int, 3>& value) override {
        line(key,
             "[" + std::to_string(value[0]) + ", " + std::to_string(value[1]) + ", " + std::to_string(value[2]) + "]");
    }
    void integers(const Key& key, std::vector<int>& value) override { line(key, "[" + listed(value) + "]"); }
    void flag(const Key& key, bool& value) override { line(key, value ? "true" : "false"); }
    void text(const Key& key, std::string& value) override {
        if (!value.empty()) line(key, in_quotes(value));
    }
    void two_names(const Key& key, std::array<std::string, 2>& value) override {
        if (!value[0].empty()) line(key, "[" + in_quotes(value[0]) + ", " + in_quotes(value[1]) + "]");
    }
    void word(const Key& key, const Words& vocabulary, std::size_t& index) override { line(key, vocabulary[index]); }
    void words(const Key& key, const Words& /*vocabulary*/, std::vector<std::string>& value) override {
        line(key, "[" + join(value) + "]");
    }
    void points(const Key& key, std::vector<Vec3>& value) override {
        std::string all;
        for (const Vec3& p : value) all += (all.empty() ? "" : ", ") + list(p);
        line(key, "[" + all + "]");
    }
    void axes(const Key& key, Mat3& value) override {
        line(key, "[" + list(value.col(0)) + ", " + list(value.col(1)) + "]");
    }
    void group(const Key& key, const std::function<void()>& body) override {
        text_ += std::string(2 * depth_, ' ') + in_quotes(key.name) + ":";
        const std::size_t before = text_.size();
        text_ += '\n';
        ++depth_;
        body();
        --depth_;
        if (text_.size() == before + 1) text_.insert(before, " {}");
    }

private:
    static std::string inline_course(const Course& course) {
        if (course.is_value()) return decimal(course.value());
        if (const auto* expression = std::get_if<Expression>(&course.form))
            return "{expression: " + in_quotes(expression->text) + ", unit: " + in_quotes(expression->unit) + "}";
        return "{table: " + inline_table(std::get<Table>(course.form)) + "}";
    }
    static std::string inline_table(const Table& table) {
        std::string rows;
        for (const auto& [t, y] : table.rows)
            rows += (rows.empty() ? "[" : ", [") + decimal(t) + ", " + decimal(y) + "]";
        return "[" + rows + "]";
    }
    static std::string list(const Vec3& v) {
        return "[" + decimal(v.x()) + ", " + decimal(v.y()) + ", " + decimal(v.z()) + "]";
    }
    void line(const Key& key, const std::string& value) {
        text_ += std::string(2 * depth_, ' ') + in_quotes(key.name) + ": " + value + "\n";
    }

    std::string text_;
    std::size_t depth_ = 0;
};

} // namespace

std::string write_scene(const Scene& scene) {
    Writer writer;
    Scene shown = scene; // describe takes what a reader could fill; a writer changes nothing
    describe(writer, shown);
    return writer.take_text();
}

} // namespace osculate::scene
