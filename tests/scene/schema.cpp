/// The schemas know every key that the readers know, and no other.

#include "osculate/scene/schema.hpp"

#include "osculate/scene/keys.hpp"
#include "osculate/scene/study.hpp"
#include "osculate/scene/surface_study.hpp"
#include "osculate/scene/units.hpp"
#include "scene_text.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

using Json = nlohmann::json;
using testing::ElementsAreArray;

/// Schema of the maps that a value may be.
const Json* map_of(const Json& schema) {
    if (schema.contains("properties") || schema.contains("additionalProperties")) return &schema;
    if (schema.contains("anyOf"))
        for (const Json& alternative : schema["anyOf"])
            if (const Json* map = map_of(alternative)) return map;
    return nullptr;
}

void list_keys(const Json& schema, const std::string& path, std::set<std::string>& keys) {
    const Json* map = map_of(schema);
    if (map == nullptr || map->contains("dependencies")) return; // forms of a value over time are no keys
    const auto go = [&](const std::string& key, const Json& value) {
        keys.insert(path + key);
        list_keys(value, path + key + ".", keys);
    };
    if (map->contains("properties"))
        for (const auto& [key, value] : (*map)["properties"].items()) go(key, value);
    if ((*map)["additionalProperties"].is_object()) go("<>", (*map)["additionalProperties"]);
}

TEST(Schema, HasTheKeysOfTheKeyListAndTheShortForm) {
    std::set<std::string> listed, in_schema;
    std::istringstream keys(describe_keys(""));
    for (std::string key, text; std::getline(keys, key) && std::getline(keys, text);)
        for (key = std::regex_replace(key, std::regex("<[a-z]+>"), "<>"); !key.empty();) {
            listed.insert(key);
            key.erase(key.rfind('.') == std::string::npos ? 0 : key.rfind('.')); // maps are not listed by themselves
        }
    list_keys(Json::parse(scene_schema()), "", in_schema);
    std::erase_if(in_schema, [](const std::string& key) { return key.starts_with("contact.<>.surface"); });
    EXPECT_THAT(in_schema, ElementsAreArray(listed));
    const Json pair = Json::parse(scene_schema())["properties"]["contact"]["additionalProperties"]["properties"];
    EXPECT_EQ(pair["master"]["anyOf"][0]["type"], "string");
    EXPECT_EQ(pair["surface"]["anyOf"], pair["master"]["anyOf"][1]["properties"]["surface"]["anyOf"]);
}

TEST(Schema, TakesTheNameOfAFileForItsMap) {
    const Json mesh =
        Json::parse(scene_schema())["properties"]["bodies"]["additionalProperties"]["properties"]["mesh"]["properties"];
    for (const char* tag : {"file", "cad"}) {
        EXPECT_EQ(mesh[tag]["anyOf"][0]["type"], "string") << tag;
        EXPECT_TRUE(mesh[tag]["anyOf"][1]["properties"].contains("path")) << tag;
        EXPECT_FALSE(mesh[tag]["description"].get<std::string>().empty()) << tag;
    }
    EXPECT_EQ(mesh["file"]["anyOf"][1]["properties"]["repair"]["anyOf"][0]["type"], "boolean");
}

/// The text patterns of numbers against the parser itself.
TEST(Schema, TakesQuantitiesAsTheReaderDoes) {
    const Json scene = Json::parse(scene_schema());
    const Json body = scene["properties"]["bodies"]["additionalProperties"]["properties"];
    const auto pattern = [](const Json& key) { return std::regex(key["pattern"].get<std::string>()); };
    const Json material = body["material"]["properties"]["linear_elastic"]["properties"];
    const Json spin = body["initial_spin"]["items"], gravity = scene["properties"]["gravity"]["items"];
    struct Case {
        const Json& key;
        Dimension dimension;
        const char* text;
        bool positive = false;
    };
    const Case cases[] = {{material["E"], dimension::pressure, "30 MPa", true},
                          {material["E"], dimension::pressure, "1e-3GPa", true},
                          {material["E"], dimension::pressure, "30 m", true},
                          {material["E"], dimension::pressure, "30 Mpa", true},
                          {material["E"], dimension::pressure, "-30 MPa", true},
                          {material["E"], dimension::pressure, "0.0 MPa", true},
                          {material["E"], dimension::pressure, "5 N/mm^2", true},
                          {material["E"], dimension::pressure, "5 N mm^-2", true},
                          {material["E"], dimension::pressure, "5 N/mm", true},
                          {material["E"], dimension::pressure, "5 kg/m s^-2", true},
                          {material["E"], dimension::pressure, "1 bar", true},
                          {material["E"], dimension::pressure, "1 kbar", true},
                          {material["E"], dimension::pressure, "0.1", true},
                          {material["E"], dimension::pressure, "ten", true},
                          {material["E"], dimension::pressure, "1e", true},
                          {material["E"], dimension::pressure, "", true},
                          {spin, dimension::spin, "2 rad/s"},
                          {spin, dimension::spin, "2 deg / min"},
                          {spin, dimension::spin, "2 Hz"},
                          {spin, dimension::spin, "-2 rad*Hz"},
                          {gravity, dimension::acceleration, "-9.81 m/s^2"},
                          {gravity, dimension::acceleration, "-9.81 m/s"},
                          {gravity, dimension::acceleration, "9.81 N/kg"},
                          {gravity, dimension::acceleration, "+1. km/h^2"}};
    for (const Case& c : cases) {
        const Quantity quantity = parse_quantity(c.text);
        const bool right = quantity.problem.empty() && (!quantity.has_unit || quantity.dimension == c.dimension) &&
                           !(c.positive && quantity.value <= 0);
        EXPECT_EQ(std::regex_match(c.text, pattern(c.key)), right) << "'" << c.text << "'";
    }
}

/// The keys that a reader offers where it meets one it does not know.
std::vector<std::string> known_keys(const std::string& study, const std::string& at) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / "osculate_schema_study.yaml";
    std::ofstream(path) << study;
    std::vector<std::string> keys;
    try {
        if (is_run_study(path.string()))
            static_cast<void>(read_study(path.string(), {}));
        else
            static_cast<void>(read_surface_study(path.string(), {"facets"}));
    } catch (const SceneError& error) {
        for (const Fault& fault : error.faults()) {
            if (fault.key != at) continue;
            std::istringstream list(fault.expected.substr(std::string("one of the keys ").size()));
            for (std::string key; list >> key;)
                keys.push_back(key.ends_with(',') ? key.substr(0, key.size() - 1) : key);
        }
    }
    std::filesystem::remove(path);
    return keys;
}

std::vector<std::string> names(const Json& properties) {
    std::vector<std::string> list;
    for (const auto& [name, value] : properties.items()) list.push_back(name);
    return list;
}

TEST(Schema, HasTheKeysOfStudies) {
    const Json schema = Json::parse(study_schema({"facets"}));
    const Json run = schema["else"]["properties"];
    const std::string study =
        "axes:\n  a: {one: {odd: 1}, two: {}}\n  s: {sample: sobol, odd: 1, variables: {v: {odd: 1}}}\n"
        "quantities: {q: {odd: 1}}\nplots: {odd: 1, curves: {c: {odd: 1}}, contours: {m: {odd: 1}}}\nodd: 1\n";
    const auto expect = [&](const std::string& at, const Json& properties) {
        EXPECT_THAT(known_keys(study, at), testing::UnorderedElementsAreArray(names(properties))) << at;
    };
    expect("odd", run);
    const Json axis = run["axes"]["additionalProperties"]["else"]["else"]; // not a key, not scenes
    expect("axes.a.one.odd", axis["else"]["additionalProperties"]["properties"]);
    expect("axes.s.odd", axis["then"]["properties"]);
    expect("axes.s.variables.v.odd", axis["then"]["properties"]["variables"]["additionalProperties"]["properties"]);
    expect("quantities.q.odd", run["quantities"]["additionalProperties"]["properties"]);
    expect("plots.odd", run["plots"]["properties"]);
    expect("plots.curves.c.odd", run["plots"]["properties"]["curves"]["additionalProperties"]["properties"]);
    expect("plots.contours.m.odd", run["plots"]["properties"]["contours"]["additionalProperties"]["properties"]);
    EXPECT_THAT(known_keys("surfaces: {}\nodd: 1\n", "odd"),
                testing::UnorderedElementsAreArray(names(schema["then"]["properties"])));
}

TEST(Schema, OfATemplateIsThatOfTheOutputWithoutItsTemplate) {
    Json output = Json::parse(scene_schema())["properties"]["output"]["properties"];
    Json properties = Json::parse(template_schema())["properties"];
    output.erase("template");
    EXPECT_EQ(properties.erase("extends"), 1u);
    EXPECT_EQ(properties, output);
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
