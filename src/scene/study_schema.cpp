#include "scene/study_schema.hpp"

namespace osculate::scene {

namespace {

Json text(const char* meaning) {
    return {{"description", meaning}, {"type", {"string", "number", "boolean"}}};
}

Json formula(const char* meaning) {
    return {{"description", meaning}, {"type", {"string", "number"}}};
}

Json one_of_words(const char* meaning, const Words& words) {
    return {{"description", std::string(meaning) + " Default " + words.front() + "."},
            {"enum", words},
            {"default", words.front()}};
}

Json flag(const char* meaning, bool value) {
    return {{"description", meaning}, {"enum", {true, false, "yes", "no"}}, {"default", value}};
}

Json names(const char* meaning) {
    return {{"description", meaning}, {"type", "array"}, {"items", {{"type", "string"}}}};
}

Json settings(const char* meaning) {
    return {
        {"description", meaning}, {"type", {"object", "null"}}, {"propertyNames", {{"pattern", "^[^.]+(\\.[^.]+)*$"}}}};
}

Json map(const char* meaning, const Json& properties) {
    return {{"description", meaning},
            {"type", {"object", "null"}},
            {"properties", properties},
            {"additionalProperties", false}};
}

Json named(const char* meaning, const Json& item, bool required) {
    Json schema{{"description", meaning}, {"type", "object"}, {"additionalProperties", item}};
    if (required) schema["minProperties"] = 1;
    return schema;
}

Json sampled() {
    const Json number{{"description", "A number, with the unit that the key takes."}, {"type", {"number", "string"}}};
    Json variable =
        map("A number that is varied.", {{"key", {{"description", "Key path of the scene, or a list of them."}}},
                                         {"from", number},
                                         {"to", number},
                                         {"spacing", one_of_words("Of its values.", {"linear", "logarithmic"})}});
    variable["required"] = {"key", "from", "to"};
    Json schema =
        map("Runs whose variables are spread evenly over a box, all at once.",
            {{"sample", {{"description", "How."}, {"enum", {"latin_hypercube", "sobol"}}}},
             {"runs", {{"description", "How many."}, {"type", "integer"}, {"minimum", 2}, {"maximum", 10000}}},
             {"seed",
              {{"description", "Of the random numbers; the same runs for the same seed."},
               {"type", "integer"},
               {"minimum", 0},
               {"default", 1}}},
             {"variables", named("What is varied, by name.", variable, true)}});
    schema["required"] = {"sample", "runs", "variables"};
    return schema;
}

/// {key, values}, {scenes}, {sample, runs, variables}, or a map of values.
Json axis() {
    const Json value = map("A value of the axis.", {{"set", settings("Settings of its runs: key path to value.")},
                                                    {"scene", text("Scene file in place of the study's.")},
                                                    {"parameters",
                                                     {{"description", "Numbers that formulas may use."},
                                                      {"type", "object"},
                                                      {"additionalProperties", {{"type", {"number", "string"}}}}}}});
    Json schema{
        {"description", "An axis: {key, values}, {scenes}, {sample, runs, variables}, or a map of named values."},
        {"type", "object"}};
    schema["minProperties"] = 1;
    const Json plain{{"type", {"string", "number"}}};
    // `key` and `scenes` may also be names of values, whose maps they then have
    schema["if"] = {{"required", {"key"}}, {"properties", {{"key", plain}}}};
    schema["then"] = {{"properties",
                       {{"key", text("Key path of the scene.")},
                        {"values", {{"description", "What it is set to."}, {"type", "array"}, {"minItems", 1}}}}},
                      {"required", {"key", "values"}},
                      {"additionalProperties", false}};
    schema["else"] = {
        {"if", {{"required", {"scenes"}}, {"properties", {{"scenes", plain}}}}},
        {"then",
         {{"properties", {{"scenes", text("Scene files; * and ? in their names.")}}}, {"additionalProperties", false}}},
        {"else",
         {{"if", {{"required", {"sample"}}, {"properties", {{"sample", plain}}}}},
          {"then", sampled()},
          {"else",
           {{"additionalProperties", value}, {"propertyNames", {{"pattern", "^[A-Za-z0-9_-][A-Za-z0-9_.-]*$"}}}}}}}};
    return schema;
}

Json quantity() {
    Json schema =
        map("A quantity: rows of contact, body or history, and what is made of them.",
            {{"unit", text("Of the report and plots.")},
             {"label", text("Of the report and plots.")},
             {"contact", text("Rows: slave nodes of this pair in the last frame.")},
             {"body", text("Rows: nodes of this body in the last frame.")},
             {"history", formula("Rows: accepted steps; the formula of a row, or all where value says what to do.")},
             {"value", formula("Formula over all rows, such as max(normal_stress).")},
             {"of", formula("Formula of a row.")},
             {"exact", formula("What it should be in every row.")},
             {"where", formula("Rows where it is 0 are left out.")},
             {"order_by", formula("Order of the rows.")},
             {"scale", formula("Divides the norm.")},
             {"reference", formula("What the quantity should be: a formula of numbers, or finest.")},
             {"reduce", one_of_words("How rows become a number.", {"last", "first", "min", "max", "mean", "rms", "sum",
                                                                   "amplitude", "ripple", "roughness"})},
             {"norm", one_of_words("Of the difference to exact.", {"rms", "max", "mean"})},
             {"area", flag("Nodes weigh by their area.", false)},
             {"error", one_of_words("Over the reference, or as it is.", {"relative", "absolute"})},
             {"plot", flag("false: only in the tables.", true)}});
    schema["type"] = "object";
    for (const auto& [one, other] : {std::pair{"contact", "body"},
                                     {"contact", "history"},
                                     {"body", "history"},
                                     {"value", "of"},
                                     {"value", "exact"},
                                     {"exact", "reference"}})
        schema["not"]["anyOf"].push_back({{"required", {one, other}}});
    return schema;
}

Json logarithmic() {
    return {{"description", "Axes of the plot that are logarithmic."},
            {"type", "array"},
            {"items", {{"enum", {"x", "y"}}}}};
}

Json curves() {
    Json schema = map("A curve for every combination of the other axes.",
                      {{"quantity", text("What is plotted.")},
                       {"over", text("Axis, or parameter of its values, that it is plotted over.")},
                       {"logarithmic", logarithmic()}});
    schema["required"] = {"quantity", "over"};
    return schema;
}

Json contours() {
    Json schema = map("A map for every combination of the other axes.",
                      {{"quantity", text("What is plotted.")},
                       {"over",
                        {{"description", "Two axes, or parameters of their values, that it is plotted over."},
                         {"type", "array"},
                         {"items", {{"type", "string"}}},
                         {"minItems", 2},
                         {"maxItems", 2}}},
                       {"logarithmic", logarithmic()}});
    schema["required"] = {"quantity", "over"};
    return schema;
}

} // namespace

Json run_study_schema() {
    Json schema;
    schema["properties"] = {
        {"title", text("Heading of the report.")},
        {"problem", text("What is solved; Markdown.")},
        {"source", text("Of the reference.")},
        {"defects", text("What is known to be wrong; Markdown.")},
        {"scene", text("Scene file, relative to the study.")},
        {"set", settings("Settings of every run: key path to value.")},
        {"constants", named("Named numbers or formulas, in order.", formula("A number or a formula."), false)},
        {"axes", named("One run for every combination, the last axis fastest.", axis(), true)},
        {"leave_out",
         {{"description", "Combinations that are not run: maps from axes to a value or a list of values."},
          {"type", "array"},
          {"items", {{"type", "object"}}}}},
        {"quantities", named("What is measured.", quantity(), true)},
        {"refine", text("Axis along which errors should fall.")},
        {"abscissa", formula("What errors are plotted against; default h where that is a number, else dofs.")},
        {"abscissa_label", text("Its axis label.")},
        {"problems", names("Axes whose values are other problems, not other ways to solve one.")},
        {"plots", map("What is plotted, and how.",
                      {{"colour_by", names("Axes whose values get a colour of their own.")},
                       {"curves", named("Quantities over an axis, by name. Default: those without a reference over "
                                        "every axis of numbers.",
                                        curves(), false)},
                       {"contours", named("Quantities over two axes, by name.", contours(), false)}})},
        {"repeats",
         {{"description", "Number of times that every run is done."},
          {"type", "integer"},
          {"minimum", 1},
          {"maximum", 100},
          {"default", 1}}}};
    schema["additionalProperties"] = false;
    schema["required"] = {"axes", "quantities"};
    return schema;
}

} // namespace osculate::scene
