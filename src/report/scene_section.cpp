#include "report/scene_section.hpp"

#include "osculate/core/escaped.hpp"
#include "osculate/scene/outline.hpp"
#include "report/html.hpp"

#include <algorithm>

namespace osculate::report {

using scene::OutlineItem;

namespace {

/// Keys in words; names of a scene keep their underscores.
std::string words(std::string key) {
    std::ranges::replace(key, '_', ' ');
    return key;
}

std::string joined(const std::vector<std::string>& parts, const std::string& between) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : between) + part;
    return text;
}

/// What has no effect need not be read: no motion, no turn, no scaling, no density, nothing chosen.
bool idle(const OutlineItem& item) {
    const OutlineItem* angle = item.find("angle");
    return item.text.starts_with("(0, 0, 0)") || item.text == "none" || (item.key == "scale" && item.text == "1") ||
           ((item.key == "density" || item.key.ends_with("damping")) && item.text.starts_with("0 ")) ||
           (item.key == "axes" && item.text == "(1, 0, 0), (0, 1, 0)") ||
           (item.key == "rotate" && angle != nullptr && angle->text == "0 deg");
}

/// "half tube (inner radius 3 m, thickness 1 m)"
std::string phrase(const OutlineItem& item) {
    if (item.items.empty()) return item.text.empty() ? words(item.key) : words(item.key) + " " + item.text;
    std::vector<std::string> parts;
    for (const OutlineItem& one : item.items)
        if (!idle(one)) parts.push_back(phrase(one));
    return parts.empty() ? words(item.key) : words(item.key) + " (" + joined(parts, ", ") + ")";
}

std::string phrases(const OutlineItem* group, const std::string& between = ", ") {
    if (group == nullptr) return "";
    if (group->items.empty()) return group->text;
    std::vector<std::string> parts;
    for (const OutlineItem& one : group->items)
        if (!idle(one)) parts.push_back(phrase(one));
    return joined(parts, between);
}

/// All items but those named.
std::string others(const OutlineItem& group, const std::vector<std::string>& told) {
    std::vector<std::string> parts;
    for (const OutlineItem& one : group.items)
        if (std::ranges::count(told, one.key) == 0 && !idle(one)) parts.push_back(phrase(one));
    return joined(parts, "; ");
}

std::string text_of(const OutlineItem& group, const std::string& key) {
    const OutlineItem* item = group.find(key);
    return item == nullptr ? "" : item->text;
}

/// Who a load or motion acts on keeps its name: "pressure: top 1 MPa".
std::string loads(const OutlineItem& stage) {
    std::string list;
    for (const char* kind : {"displacement", "pressure", "follower_pressure", "body_force", "centrifugal",
                             "nodal_force", "temperature", "motion", "force", "moment"}) {
        const OutlineItem* group = stage.find(kind);
        if (group == nullptr) continue;
        for (const OutlineItem& target : group->items) {
            std::string what = target.text;
            for (const OutlineItem& one : target.items)
                what += (what.empty() ? "" : ", ") + one.key + " to " + one.text;
            list +=
                element("li", escaped(words(kind)) + " of " + element("b", escaped(target.key)) + ": " + escaped(what));
        }
    }
    return list.empty() ? "" : element("ul class=\"plain\"", list);
}

std::string subsection(const std::string& title, const std::string& inner) {
    return inner.empty() ? "" : element("h3", escaped(title)) + inner;
}

std::string bodies(const OutlineItem& all) {
    std::vector<std::vector<std::string>> rows;
    for (const OutlineItem& body : all.items)
        rows.push_back({body.key, phrases(body.find("mesh"), "; "), phrases(body.find("material"), "; "),
                        others(body, {"mesh", "material"})});
    return table({"Body", "Shape and mesh", "Material", "More"}, rows);
}

std::string sets(const OutlineItem& all, const OutlineItem* supports) {
    std::vector<std::vector<std::string>> rows;
    for (const OutlineItem& set : all.items) {
        const OutlineItem* held = supports == nullptr ? nullptr : supports->find(set.key);
        rows.push_back(
            {set.key, text_of(set, "body"), others(set, {"body"}), held == nullptr ? "" : phrases(held, "; ")});
    }
    return table({"Set", "Of body", "Selected by", "Supported"}, rows);
}

std::string pairs(const OutlineItem& all) {
    std::vector<std::vector<std::string>> rows;
    for (const OutlineItem& pair : all.items) {
        const OutlineItem* master = pair.find("master");
        rows.push_back({pair.key, text_of(pair, "slave"), master == nullptr ? "" : text_of(*master, "set"),
                        master == nullptr ? "" : phrases(master->find("surface")), text_of(pair, "friction"),
                        text_of(pair, "discretisation"),
                        others(pair, {"slave", "master", "friction", "discretisation"})});
    }
    return table({"Pair", "Slave", "Master", "Surface of the master", "Friction coefficient", "Enforced at", "More"},
                 rows, {4});
}

/// What has no columns of its own.
std::string named(const OutlineItem& all) {
    std::string list;
    for (const OutlineItem& one : all.items)
        list += element("li", element("b", escaped(one.key)) + ": " + escaped(phrases(&one)));
    return list.empty() ? "" : element("ul", list);
}

std::string stages(const OutlineItem& all) {
    std::string list;
    for (const OutlineItem& stage : all.items) {
        std::string more =
            others(stage, {"analysis", "duration", "steps", "displacement", "pressure", "follower_pressure",
                           "body_force", "centrifugal", "nodal_force", "temperature", "motion", "force", "moment"});
        list +=
            element("li", element("b", escaped(stage.key)) + ": " + escaped(phrases(stage.find("analysis"))) + ", " +
                              escaped(text_of(stage, "duration")) + " in " + escaped(text_of(stage, "steps")) +
                              (text_of(stage, "steps") == "1" ? " step" : " steps") + loads(stage) +
                              element("div class=\"fine\"", escaped(more)));
    }
    return list.empty() ? "" : element("ol class=\"stages\"", list);
}

} // namespace

std::string scene_section(const RunFiles& files) {
    if (!files.scene) return "";
    const OutlineItem root = scene::outline(*files.scene);
    const auto with = [&](const char* key, const auto& make) {
        const OutlineItem* group = root.find(key);
        return group == nullptr || group->items.empty() ? std::string() : make(*group);
    };
    std::string text;
    if (const OutlineItem* gravity = root.find("gravity"); gravity != nullptr && !idle(*gravity))
        text += element("p", "Gravity " + escaped(gravity->text) + " acts on every body with a density.");
    text += subsection("Bodies", with("bodies", bodies));
    text += subsection("Contact pairs", with("contact", pairs));
    for (const auto& [key, title] : {std::pair{"couplings", "Couplings"}, std::pair{"ties", "Ties"},
                                     std::pair{"cyclic", "Sectors of rings"}, std::pair{"equations", "Equations"}})
        text += subsection(title, with(key, named));
    text += subsection("Stages", with("stages", stages));
    text += subsection("Sets and supports",
                       with("sets", [&](const OutlineItem& group) { return sets(group, root.find("supports")); }));
    std::string rest;
    for (const char* key : {"solver", "output", "expect"})
        rest += with(key, [&](const OutlineItem& group) {
            return element("p", element("b", escaped(words(group.key))) + ": " + escaped(phrases(&group)));
        });
    if (!rest.empty()) text += element("details", element("summary", "Solver, output, expectation") + rest);
    return section("scene", "The scene", text);
}

} // namespace osculate::report
