#pragma once
/// The visitor that fills a scene from a tree and collects every fault on its way.

#include "scene/tree.hpp"
#include "scene/visitor.hpp"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace osculate::scene {

/// Names that other keys may refer to.
struct KnownNames {
    Words bodies, sets, pairs, couplings;
};

/// "a pressure (Pa) > 0".
[[nodiscard]] std::string expected_number(const Key& key);

class TreeReader final : public Visitor {
public:
    TreeReader(const KnownNames& names, std::vector<Fault>& faults) : names_(names), faults_(faults) {}

    /// Reads a whole document: `body` describes its keys; every other key is a fault.
    void read(const Tree& document, const std::function<void()>& body);

    /// The value under a key of the current map as it stands, or nullptr; a required one that is missing is a fault.
    const Tree* take(const Key& key, const std::string& expected);
    void fault(const Tree& at, const Key& key, std::string expected, std::string found = {}, std::string near = {});

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
    struct Level {
        const Tree* map;
        std::unordered_map<std::string_view, const Tree*>
            of_many{}; ///< by key, where a search through all would take long
        std::string path;
        Words known{};          ///< keys described so far
        Words missing_choice{}; ///< tags of which one is required and none is there

        [[nodiscard]] const Tree* find(const std::string& name) const;
    };

    [[nodiscard]] std::string path_of(const std::string& name) const;
    void enter(const Tree& map, std::string path, const std::function<void()>& body);
    void leave(const Level& level);
    [[nodiscard]] Words referred(Names names) const;

    std::optional<double> read_number(const Tree& tree, const Key& key, const std::string& expected);
    std::optional<int> read_integer(const Tree& tree, const Key& key, const std::string& expected);
    std::optional<Vec3> read_vector(const Tree& tree, const Key& key);
    std::optional<Course> read_course(const Tree& tree, const Key& key, const std::string& expected);
    /// Of the current map, over time.
    std::optional<Table> read_table(const Key& key);
    /// @param key    of the second column  @param first  of the first
    std::optional<Table> read_rows(const Tree& tree, const Key& key, const Key& first);
    std::optional<Expression> read_expression(const Key& key);
    bool check_name(const Tree& at, const Place& place, const Key& key, const std::string& name, Names names);

    const KnownNames& names_;
    std::vector<Fault>& faults_;
    std::vector<Level> levels_;
};

} // namespace osculate::scene
