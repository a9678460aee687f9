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

/// `contact.<pair>.surface` stands for `contact.<pair>.master.surface`, see expand_short_forms.
void add_short_forms(Json& scene) {
    Json& pair = scene["properties"]["contact"]["additionalProperties"];
    Json surface = pair["properties"]["master"]["properties"]["surface"];
    surface["description"] = "Short for master.surface.\n\n" + surface["description"].get<std::string>();
    pair["properties"]["surface"] = std::move(surface);
    pair["not"] = {{"type", "object"},
                   {"required", {"surface", "master"}},
                   {"properties", {{"master", {{"type", "object"}, {"required", {"surface"}}}}}}};
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
