/// How TreeReader reads values that may change over a stage.

#include "scene/tree_reader.hpp"

namespace osculate::scene {

namespace {

std::string with_courses(const std::string& expected) {
    return expected + ", or a map with table or expression";
}

std::string rows_of(const Key& key, const Key& first) {
    return "two or more rows [" + first.name + " (" + unit_of(first.unit) + "), " + expected_number(key) + "]";
}

} // namespace

std::optional<Table> TreeReader::read_table(const Key& key) {
    const Key time{.name = "time", .unit = dimension::time, .range = range::not_negative};
    const Key value{.name = "table", .unit = key.unit, .range = key.range};
    const Tree* tree = take(value, rows_of(value, time));
    if (!tree) return {};
    return read_rows(*tree, value, time);
}

std::optional<Table> TreeReader::read_rows(const Tree& tree, const Key& key, const Key& first) {
    const std::string expected = rows_of(key, first);
    Table table;
    const auto reject = [&](const Tree& at, const std::string& what, const std::string& found = {}) {
        fault(at, key, what, found);
        return std::nullopt;
    };
    if (tree.kind != Tree::Kind::list || tree.children.size() < 2) return reject(tree, expected);
    Key column = first;
    column.name = key.name;
    bool complete = true;
    for (const Tree& row : tree.children) {
        if (row.kind != Tree::Kind::list || row.children.size() != 2) return reject(row, expected);
        const auto t = read_number(row.children[0], column, expected_number(first));
        const auto y = read_number(row.children[1], key, expected_number(key));
        complete = complete && t && y;
        if (!complete) continue;
        if (!table.rows.empty() && *t <= table.rows.back()[0])
            return reject(row.children[0], first.name + "s that ascend, here more than " +
                                               number_text(table.rows.back()[0]) + " " + unit_of(first.unit));
        table.rows.push_back({*t, *y});
    }
    if (!complete) return {};
    return table;
}

void TreeReader::table(const Key& key, const Key& first, Table& value) {
    if (const Tree* tree = take(key, rows_of(key, first)))
        if (auto read = read_rows(*tree, key, first)) value = std::move(*read);
}

std::optional<Expression> TreeReader::read_expression(const Key& key) {
    const Key text{.name = "expression"}, unit{.name = "unit"};
    const std::string expected = "an expression in t, the seconds since the stage's start";
    Expression result{.unit = unit_of(key.unit)};
    const Tree* unit_tree = take(unit, "");
    bool complete = true;
    if (unit_tree != nullptr) {
        const Quantity one = parse_quantity("1 " + unit_tree->scalar);
        complete = unit_tree->kind == Tree::Kind::scalar && one.problem.empty() && one.dimension == key.unit;
        if (complete) {
            result.unit = unit_tree->scalar;
            result.size = one.value;
        } else {
            const std::string why = one.problem.empty() ? name_of(one.dimension) : one.problem;
            fault(*unit_tree, unit, "a unit of " + name_of(key.unit) + " such as " + unit_of(key.unit),
                  unit_tree->found() + (unit_tree->kind == Tree::Kind::scalar ? " (" + why + ")" : ""), one.nearest);
        }
    }
    const Tree* tree = take(text, expected);
    if (!tree) return {};
    if (tree->kind != Tree::Kind::scalar) {
        fault(*tree, text, expected);
        return {};
    }
    const ParsedExpression parsed = parse_expression(tree->scalar);
    if (!parsed.problem.empty()) {
        fault(*tree, text, expected, tree->found() + " (" + parsed.problem + ")", parsed.nearest);
        return {};
    }
    result.text = tree->scalar;
    if (!complete) return {};
    return result;
}

std::optional<Course> TreeReader::read_course(const Tree& tree, const Key& key, const std::string& expected) {
    if (tree.kind != Tree::Kind::map) {
        const bool scalar = tree.kind == Tree::Kind::scalar;
        if (const auto value = read_number(tree, key, scalar ? expected : with_courses(expected))) return *value;
        return {};
    }
    std::optional<Course> course;
    enter(tree, path_of(key.name), [&] {
        one_of({.tags = course_tags,
                .active = 0,
                .required = true,
                .choose = [](std::size_t) {},
                .describe =
                    [&](std::size_t i) {
                        if (i == 0) {
                            if (auto table = read_table(key)) course = std::move(*table);
                        } else if (auto expression = read_expression(key)) {
                            course = std::move(*expression);
                        }
                    }});
    });
    return course;
}

void TreeReader::course(const Key& key, Course& value) {
    const std::string expected = expected_number(key);
    if (const Tree* tree = take(key, expected))
        if (auto read = read_course(*tree, key, expected)) value = std::move(*read);
}

void TreeReader::optional_course(const Key& key, std::optional<Course>& value) {
    const std::string expected = expected_number(key);
    if (const Tree* tree = take(key, expected)) value = read_course(*tree, key, expected);
}

void TreeReader::courses(const Key& key, std::array<Course, 3>& value) {
    const std::string expected = "a list of three, each " + expected_number(key);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.size() != 3) return fault(*tree, key, with_courses(expected));
    for (std::size_t i = 0; i < 3; ++i)
        if (auto read = read_course(tree->children[i], key, expected)) value[i] = std::move(*read);
}

} // namespace osculate::scene
