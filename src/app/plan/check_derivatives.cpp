#include "app/plan/check_derivatives.hpp"

#include "app/fault.hpp"
#include "osculate/scene/number_at.hpp"
#include "osculate/scene/writer.hpp"

#include <regex>
#include <string>

namespace osculate::app {

namespace {
/// Whether a number is one of the steps, the solver or the output, not of what is simulated: runs beside a run take its steps.
bool is_of_steps(const std::string& key) {
    static const std::regex pattern(R"((solver|output|expect)\..*|stages\.[^.]+\.(duration|steps|control(\..*)?))");
    return std::regex_match(key, pattern);
}
} // namespace

void check_derivatives(const scene::Scene& scene, bool shared, std::vector<Fault>& faults) {
    if (scene.output.derivatives.empty()) return;
    if (shared) faults.push_back(fault("output.derivatives", "a run by one process", "--distributed"));
    if (scene.general)
        faults.push_back(fault("output.derivatives", "contact by named pairs", "contact.general, whose pairs change"));
    const std::string resolved = scene::write_scene(scene);
    for (const auto& [name, derivative] : scene.output.derivatives) {
        std::string found;
        const auto number = scene::number_at(resolved, derivative.key, found);
        const std::string where = "output.derivatives." + name + ".key";
        if (is_of_steps(derivative.key))
            faults.push_back(fault(where, "a number of what is simulated, as the steps stay as they are",
                                   "'" + derivative.key + "'"));
        else if (!number)
            faults.push_back(fault(where, "the path of a number, such as bodies.NAME.material.linear_elastic.E",
                                   "'" + derivative.key + "': " + found));
        else if (number->value == 0)
            faults.push_back(
                fault(where, "a number other than 0: it is changed by a part of it", "'" + derivative.key + "', 0"));
    }
}

} // namespace osculate::app
