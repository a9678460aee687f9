#include "app/check/pair_warnings.hpp"

#include "app/check/surface_shape.hpp"
#include "app/plan/settle_pairs.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <variant>

namespace osculate::app {

namespace {

class Warner {
public:
    Warner(const model::Model& model, const ExaminedPair& examined)
        : model_(model), examined_(examined), key_("contact." + examined.evaluation.pair().name()) {}

    std::vector<Warning> all() {
        if (examined_.evaluation.pair().master()->exact()) return {}; // its facets stand for it, and have no say
        facing();
        stiffness();
        sharp_edges();
        if (std::holds_alternative<scene::FacetsSurface>(examined_.spec.master.surface) &&
            !examined_.pairing.matching && fits(examined_.evaluation))
            say(".master.surface", "facets, but the two curved surfaces fit one another and their nodes do not "
                                   "coincide: they touch at single nodes, with forces many times too large; use blend "
                                   "or rpim, which follow the curve between the nodes");
        return std::move(found_);
    }

private:
    void say(const std::string& key, std::string text) { found_.push_back({key_ + key, std::move(text)}); }

    /// As a user has it, m.
    [[nodiscard]] std::string place(const Vec3& X) const {
        const Vec3 at = X + model_.origin;
        return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", at.x(), at.y(), at.z());
    }
    [[nodiscard]] std::string place(std::size_t slave_facet) const {
        return place(mesh::facet_centroid(examined_.evaluation.pair().slaves().facets[slave_facet], model_.X));
    }

    void facing() {
        const Facing& f = examined_.facing;
        if (f.sides_wrong()) {
            say(".master.set", fmt::format("{} of {} slave facets do not face the master: the master or the slave is "
                                           "on the wrong side of its body",
                                           f.turned, f.facets));
            return;
        }
        if (examined_.may_tumble) return;
        if (!f.away.empty())
            say(".slave", fmt::format("{} of {} facets are near the master but face away from it, the first at {}: "
                                      "leave them out of the set",
                                      f.away.size(), f.facets, place(f.away.front())));
        else if (const auto sides = side_facets(examined_.evaluation.pair(), model_.X); !sides.empty())
            say(".slave",
                fmt::format(
                    "{} of {} facets are at right angles to the master or face away from it, the first at {}: they add "
                    "to the area and take the mass from nodes that touch nothing; leave them out of the set",
                    sides.size(), examined_.evaluation.pair().slaves().facets.size(), place(sides.front())));
    }

    void stiffness() {
        if (examined_.stiffness_ratio < much_stiffer) return;
        const double ratio = examined_.stiffness_ratio;
        say(".slave", fmt::format("its body is {}: make the softer side the slave, "
                                  "and mesh it as finely; otherwise the solver may take many times as long",
                                  std::isinf(ratio) ? std::string("rigid")
                                                    : fmt::format("{:.2g} times as stiff as the master's", ratio)));
    }

    void sharp_edges() {
        const SharpEdges edges = app::sharp_edges(examined_.evaluation.pair(), model_.X);
        const auto angle = fmt::format("{:.0f} degrees", mesh::default_feature_angle * 180 / std::numbers::pi);
        if (edges.concave > 0)
            say(".master.set",
                fmt::format(
                    "{} edges inside it are folded inwards by more than {}, the first at {}: a node there touches only "
                    "one of the two sides; to let it touch both, make a set and a pair for each side",
                    edges.concave, angle, place(edges.first_concave)));
        if (edges.convex > 0)
            say(".master.set", fmt::format("{} edges inside it are sharper than {}, the first at {}: normals and "
                                           "forces jump where nodes slide over them; leave out facets that nothing "
                                           "touches, round the edge, or make this surface the slave",
                                           edges.convex, angle, place(edges.first_convex)));
    }

    const model::Model& model_;
    const ExaminedPair& examined_;
    std::string key_;
    std::vector<Warning> found_;
};

} // namespace

std::vector<Warning> pair_warnings(const model::Model& model, const ExaminedPair& examined) {
    return Warner(model, examined).all();
}

} // namespace osculate::app
