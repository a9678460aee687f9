#include "app/check/unit_warnings.hpp"

#include "app/plan/body_materials.hpp"
#include "app/plan/courses.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace osculate::app {

namespace {

/// Largest magnitude of a course in its stage.
double largest(const scene::Course& course, double duration) {
    if (course.is_value()) return std::abs(course.value());
    constexpr int samples = 64;
    const auto at = course.function();
    double most = 0;
    const auto take = [&](double t) {
        if (const double value = std::abs(at(t)); t <= duration && std::isfinite(value)) most = std::max(most, value);
    };
    for (const double t : course.corners()) take(t);
    for (int k = 0; k <= samples; ++k) take(duration * k / samples);
    return most;
}

class UnitWarner {
public:
    UnitWarner(const scene::Scene& scene, const Plan& plan) : scene_(scene), plan_(plan) {}

    std::vector<Warning> all() {
        materials();
        sizes();
        for (const auto& [name, pair] : scene_.contact)
            if (pair.friction > most_friction)
                say("contact." + name + ".friction", "{:.4g}: coefficients of friction are rarely above {:.4g}",
                    pair.friction, most_friction);
        gravity();
        for (const auto& [name, stage] : scene_.stages) pressures(name, stage);
        strains();
        return std::move(found_);
    }

private:
    static constexpr double softest = 1e3, stiffest = 1e12; ///< E, Pa: gel; above diamond's 1.2 TPa nothing
    static constexpr double lightest = 1, heaviest = 30000; ///< kg/m^3: aerogels; osmium has 22 600
    static constexpr double most_friction = 2, most_ratio = 1e4, most_strain = 1;
    static constexpr double standard_gravity = 9.80665;

    template <class... Values> void say(std::string key, fmt::format_string<Values...> text, Values&&... values) {
        found_.push_back({std::move(key), fmt::format(text, std::forward<Values>(values)...)});
    }

    [[nodiscard]] double size(std::size_t b) const {
        Eigen::AlignedBox3d box;
        for (const Vec3& X : plan_.model.bodies[b].mesh.nodes) box.extend(X);
        return box.diagonal().norm();
    }

    [[nodiscard]] const model::Set* set(const std::string& name) const {
        const auto at = std::ranges::find(plan_.model.sets, name, &model::Set::name);
        return at == plan_.model.sets.end() ? nullptr : &*at;
    }

    void materials() {
        static constexpr const char* laws[] = {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean",
                                               "elastic_plastic", "orthotropic"};
        static_assert(std::size(laws) == std::variant_size_v<scene::Material>, "a law without its word");
        for (const auto& [name, body] : scene_.bodies) {
            if (body.rigid) continue;
            const std::string key = "bodies." + name;
            material(key + ".material." + laws[body.material.index()], scene::elastic(body.material));
            for (const auto& [part, section] : body.sections)
                material(key + ".sections." + part + ".material." + laws[section.material.index()],
                         scene::elastic(section.material));
        }
    }

    void material(const std::string& law, const scene::ElasticConstants& m) {
        if (m.E < softest)
            say(law + ".E", "{:.4g} Pa: softer than any gel; rubber has some MPa, metals 50 to 400 GPa", m.E);
        if (m.E > stiffest) say(law + ".E", "{:.4g} GPa: stiffer than diamond; metals have 50 to 400 GPa", 1e-9 * m.E);
        if (m.density > 0 && m.density < lightest)
            say(law + ".density", "{:.4g} kg/m^3: lighter than aerogel; water has 1000, steel 7850", m.density);
        if (m.density > heaviest)
            say(law + ".density", "{:.4g} kg/m^3: heavier than any metal; water has 1000, steel 7850", m.density);
    }

    void sizes() {
        std::size_t least = 0, most = 0;
        for (std::size_t b = 0; b < plan_.model.bodies.size(); ++b) {
            if (size(b) < size(least)) least = b;
            if (size(b) > size(most)) most = b;
        }
        if (const double ratio = size(most) / size(least); ratio > most_ratio)
            say("bodies." + plan_.model.bodies[least].name + ".mesh",
                "{:.4g} m across, {} {:.4g} m: bodies that differ in size by a factor of {:.2g}", size(least),
                plan_.model.bodies[most].name, size(most), ratio);
    }

    void gravity() {
        const double g = scene_.gravity.norm();
        for (std::size_t b = 0; g > 0 && b < scene_.bodies.size(); ++b) {
            const auto& [name, body] = scene_.bodies[b];
            if (!plan_.model.bodies[b].has_mass() && !(body.rigid && (body.rigid->mass || body.rigid->density > 0)) &&
                !body.rigid_surface)
                say("bodies." + name, "gravity does not act on it, as it has no density");
        }
        if (g == 0) return;
        constexpr double digits = 0.01; // 2 % of the value
        const double power = std::log10(g / standard_gravity), whole = std::round(power);
        if (whole != 0 && std::abs(power - whole) < digits)
            say("gravity", "{:.4g} m/s^2: on the Earth it is 9.81 m/s^2, and this is about 10^{:.0f} times that", g,
                whole);
    }

    void pressures(const std::string& stage_name, const scene::Stage& stage) {
        for (const auto& [key, loads] :
             {std::pair{"pressure", &stage.pressure}, std::pair{"follower_pressure", &stage.follower_pressure}})
            for (const auto& [name, course] : *loads) {
                const model::Set* loaded = set(name);
                if (loaded == nullptr || scene_.bodies[static_cast<std::size_t>(loaded->body)].second.rigid) continue;
                const auto b = static_cast<std::size_t>(loaded->body);
                const double E = modulus_under(scene_.bodies[b].second, plan_.model.bodies[b], loaded->facets);
                const double p = largest(course, stage.duration);
                if (p > E)
                    say("stages." + stage_name + "." + key + "." + name,
                        "{:.4g} Pa on a body of E = {:.4g} Pa: it would be squeezed to nothing", p, E);
            }
    }

    /// What sets of one body are moved against one another, over their distance.
    void strains() {
        Driving now;
        for (const auto& [stage_name, stage] : scene_.stages) {
            now.update(stage);
            for (const auto& [name, motion] : stage.displacement)
                for (std::size_t k = 0; k < 3; ++k)
                    if (motion[k])
                        strain("stages." + stage_name + ".displacement." + name, name, k, *motion[k], stage, now);
            now.settle(stage.duration);
        }
    }

    void strain(const std::string& key, const std::string& name, std::size_t k, const scene::Course& course,
                const scene::Stage& stage, const Driving& now) {
        const model::Set* moved = set(name);
        if (moved == nullptr || moved->nodes.empty()) return;
        const scene::Support* own = scene::find(scene_.supports, name);
        if (own != nullptr && (own->cylinder || !own->axes.isIdentity(0))) return; // its x is not the other's
        const double d = course.is_value() ? course.value() : largest(course, stage.duration);
        for (const model::Set& other : plan_.model.sets) {
            if (&other == moved || other.body != moved->body || other.nodes.empty()) continue;
            double held = 0;
            const scene::Support* support = scene::find(scene_.supports, other.name);
            const auto motion = now.displacement.find(other.name);
            if (motion != now.displacement.end() && motion->second[k]) {
                if (!motion->second[k]->is_value() || !course.is_value()) continue; // two courses may go together
                held = motion->second[k]->value();
            } else if (support == nullptr || !support->fixed[k] || support->cylinder || !support->axes.isIdentity(0)) {
                continue;
            }
            const double distance = (centre(*moved) - centre(other)).norm();
            if (distance > 0 && std::abs(d - held) > most_strain * distance) {
                say(key + "." + "xyz"[k],
                    "{:.4g} m against {}, which is {:.4g} m away on the same body: a strain of {:.3g}", d, other.name,
                    distance, std::abs(d - held) / distance);
                return;
            }
        }
    }

    [[nodiscard]] Vec3 centre(const model::Set& set) const {
        Vec3 sum = Vec3::Zero();
        for (const Index node : set.nodes) sum += plan_.model.X[static_cast<std::size_t>(node)];
        return sum / static_cast<double>(set.nodes.size());
    }

    const scene::Scene& scene_;
    const Plan& plan_;
    std::vector<Warning> found_;
};

} // namespace

std::vector<Warning> unit_warnings(const scene::Scene& scene, const Plan& plan) {
    return UnitWarner(scene, plan).all();
}

} // namespace osculate::app
