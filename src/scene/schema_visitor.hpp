#pragma once
/// The visitor that writes a JSON Schema.

#include "scene/visitor.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace osculate::scene {

using Json = nlohmann::ordered_json;

/// Describes every key it is shown, all alternatives included; one made-up entry stands for those of a named map.
class SchemaVisitor final : public Visitor {
public:
    /// Schema of a whole document whose keys `body` describes.
    [[nodiscard]] Json document(const std::function<void()>& body);

    void number(const Key& key, double& value) override;
    void optional_number(const Key& key, std::optional<double>& value) override;
    void optional_relative_length(const Key& key, std::optional<RelativeLength>& value) override;
    void vector(const Key& key, Vec3& value) override;
    void optional_vector(const Key& key, std::optional<Vec3>& value) override;
    void course(const Key& key, Course& value) override;
    void optional_course(const Key& key, std::optional<Course>& value) override;
    void courses(const Key& key, std::array<Course, 3>& value) override;
    void table(const Key& key, const Key& first, Table& value) override;
    void integer(const Key& key, int& value) override;
    void divisions(const Key& key, std::array<int, 3>& value) override;
    void integers(const Key& key, std::vector<int>& value) override;
    void flag(const Key& key, bool& value) override;
    void text(const Key& key, std::string& value) override;
    void two_names(const Key& key, std::array<std::string, 2>& value) override;
    void word(const Key& key, const Words& vocabulary, std::size_t& index) override;
    void words(const Key& key, const Words& vocabulary, std::vector<std::string>& value) override;
    void axes(const Key& key, Mat3& value) override;
    void points(const Key& key, std::vector<Vec3>& value) override;
    void group(const Key& key, const std::function<void()>& body) override;
    void optional_group(const Key& key, bool& present, const std::function<void()>& body) override;
    void one_of(const Choice& choice) override;
    void named(const Key& key, const Entries& entries) override;

private:
    /// Keys of one map.
    struct Level {
        Json properties = Json::object();
        Words required{};
        Words tags{};         ///< of a choice
        std::string chosen{}; ///< its default
        bool choice_required = false, in_choice = false;
    };

    /// @param what  type and unit in words
    void add(const Key& key, Json schema, const std::string& what, const Json& value);
    [[nodiscard]] Level level_of(const std::function<void()>& body);
    [[nodiscard]] static Json map_of(const Level& level);

    std::vector<Level> levels_;
};

} // namespace osculate::scene
