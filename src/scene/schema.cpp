#include "osculate/scene/schema.hpp"

#include "osculate/scene/surface_study.hpp"
#include "scene/describe.hpp"
#include "scene/schema_visitor.hpp"
#include "scene/study_schema.hpp"

namespace osculate::scene {

namespace {

std::string finished(const char* title, const Json& body) {
    Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
    schema.update(body);
    return schema.dump(1) + "\n";
}

/// The value, or what stands for it.
void allow(Json& value, const Json& short_form) {
    const Json described{{"description", value["description"]}};
    value.erase("description");
    Json either = described;
    either["anyOf"] = Json::array({short_form, value});
    value = std::move(either);
}

/// What expand_short_forms takes: a file's name for its map, true or false for its repairs, a set's name for a master, and
/// `contact.<pair>.surface` for `contact.<pair>.master.surface`; and that a pair has either roles or two sides.
void add_short_forms(Json& scene) {
    Json& mesh = scene["properties"]["bodies"]["additionalProperties"]["properties"]["mesh"]["properties"];
    allow(mesh["file"]["properties"]["repair"], {{"type", "boolean"}});
    for (const char* tag : {"file", "cad"}) allow(mesh[tag], {{"type", "string"}, {"minLength", 1}});
    Json& pair = scene["properties"]["contact"]["additionalProperties"];
    Json surface = pair["properties"]["master"]["properties"]["surface"];
    surface["description"] = "Short for master.surface.\n\n" + surface["description"].get<std::string>();
    pair["properties"]["surface"] = std::move(surface);
    const Json name{{"type", "string"}, {"minLength", 1}};
    allow(pair["properties"]["master"], name);
    pair["not"] = {{"type", "object"},
                   {"required", {"surface", "master"}},
                   {"properties", {{"master", {{"type", "object"}, {"required", {"surface"}}}}}}};
    const Json names{{{"required", {"set"}}}, {{"required", {"rigid_surface"}}}};
    const Json named_master{{"anyOf", {name, {{"type", "object"}, {"oneOf", names}}}}},
        unnamed_master{{"type", "object"}, {"not", {{"anyOf", names}}}};
    pair["if"] = {{"type", "object"}, {"required", {"between"}}};
    pair["then"]["properties"] = {{"slave", false}, {"master", unnamed_master}};
    pair["else"] = {{"type", "object"}, {"required", {"slave", "master"}}, {"properties", {{"master", named_master}}}};
}

} // namespace

std::string scene_schema() {
    SchemaVisitor visitor;
    Scene defaults;
    Json schema = visitor.document([&] { describe(visitor, defaults); });
    add_short_forms(schema);
    return finished("Scene of Osculate", schema);
}

std::string template_schema() {
    SchemaVisitor visitor;
    Output defaults;
    std::string extends;
    return finished("Output template of Osculate",
                    visitor.document([&] { describe_template(visitor, extends, defaults); }));
}

std::string study_schema(const std::vector<std::string>& methods) {
    SchemaVisitor visitor;
    SurfaceStudy defaults;
    const Json surfaces = visitor.document([&] { describe(visitor, defaults, methods); });
    // The branch is chosen as is_run_study() does, so that an editor speaks of the one study that is meant.
    return finished(
        "Study of Osculate",
        {{"type", "object"}, {"if", {{"required", {"surfaces"}}}}, {"then", surfaces}, {"else", run_study_schema()}});
}

} // namespace osculate::scene
