#include "osculate/study/approximation.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/rpim_patch.hpp"
#include "osculate/core/error.hpp"
#include "study/parametric.hpp"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace osculate::study {

namespace {

class Facets final : public Approximation {
public:
    explicit Facets(const SurfaceMesh& surface) : surface_(surface) {}

    std::optional<SurfacePoint> at(Index facet, const Vec2& u) const override {
        const contact::MatrixX3 corners = corners_of(surface_, facet);
        return surface_point(contact::FacetPatch(static_cast<int>(corners.rows())).point(u, corners));
    }

private:
    const SurfaceMesh& surface_;
};

class HeightPatches final : public Approximation {
public:
    HeightPatches(const SurfaceMesh& surface, int ring) : surface_(surface) {
        for (Index f = 0; f < surface.topology.facet_count(); ++f) {
            const std::vector<Index> vertices = surface.topology.facet_ring(f, ring);
            contact::MatrixX3 x(static_cast<Index>(vertices.size()), 3);
            for (Index i = 0; i < x.rows(); ++i) x.row(i) = surface.x[vertices[i]].transpose();
            auto shape = contact::RpimPatch::fit(x.leftCols<2>(), {}, 3);
            if (!shape) throw std::runtime_error("the nodes around a facet do not determine a height");
            contact::MatrixX3 coefficients = shape->coefficients(x);
            patches_.emplace_back(std::move(*shape), std::move(coefficients));
        }
    }

    std::optional<SurfacePoint> at(Index facet, const Vec2& u) const override {
        const contact::MatrixX3 corners = corners_of(surface_, facet);
        const Vec3 below = contact::FacetPatch(static_cast<int>(corners.rows())).point(u, corners).X;
        const auto& [shape, coefficients] = patches_[static_cast<std::size_t>(facet)];
        return surface_point(shape.point(below.head<2>(), coefficients)); // x1 and x2 are reproduced: X = (x1, x2, x3)
    }

private:
    const SurfaceMesh& surface_;
    std::vector<std::pair<contact::RpimPatch, contact::MatrixX3>> patches_;
};

class Master final : public Approximation {
public:
    Master(const SurfaceMesh& surface, std::unique_ptr<contact::MasterSurface> master)
        : surface_(surface), master_(std::move(master)) {}

    std::optional<SurfacePoint> at(Index facet, const Vec2& u) const override {
        constexpr int most_iterations = 50;
        constexpr double on_surface = 1e-12; // of the facet size: what round-off leaves of the gap
        const contact::MatrixX3 corners = corners_of(surface_, facet);
        contact::FacetHit hit;
        hit.facet = facet;
        hit.u = u;
        Vec3 s = contact::FacetPatch(static_cast<int>(corners.rows())).point(u, corners).X;
        contact::ContactPoint point;
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            master_->evaluate(s, hit, surface_.x, point);
            if (!point.found) return std::nullopt;
            if (std::abs(point.gap) <= on_surface * surface_.topology.facet_size(facet)) break;
            s -= point.gap * point.normal;
        }
        contact::ContactVariation variation;
        master_->evaluate(s, hit, surface_.x, point, &variation);
        if (!point.found) return std::nullopt;
        return SurfacePoint{s, point.normal, 0.5 * variation.dn.leftCols<3>().trace()};
    }

    Index fallbacks() const override { return master_->fallbacks(); }

private:
    const SurfaceMesh& surface_;
    std::unique_ptr<contact::MasterSurface> master_;
};

using Maker = std::function<std::unique_ptr<Approximation>(const SurfaceMesh&)>;

const std::vector<std::pair<std::string, Maker>>& makers() {
    static const std::vector<std::pair<std::string, Maker>> list{
        {"facets", make_facets},
        {"nagata", make_nagata},
        {"height_1", [](const SurfaceMesh& s) { return make_height_patches(s, 1); }},
        {"rpim_1", [](const SurfaceMesh& s) { return make_rpim(s, 1); }},
        {"rpim_2", [](const SurfaceMesh& s) { return make_rpim(s, 2); }},
        {"blend_1", [](const SurfaceMesh& s) { return make_blend(s, 1); }},
        {"blend_2", [](const SurfaceMesh& s) { return make_blend(s, 2); }},
        {"blend_3", [](const SurfaceMesh& s) { return make_blend(s, 3); }},
        {"blend", [](const SurfaceMesh& s) { return make_blend(s, 2, std::nullopt); }},
        {"blend_2_r3",
         [](const SurfaceMesh& s) {
             return make_blend(s, 2, contact::Multiquadric{0, 1.5});
         }},
        {"blend_1_r5",
         [](const SurfaceMesh& s) {
             return make_blend(s, 1, contact::Multiquadric{0, 2.5});
         }},
        {"blend_2_r5",
         [](const SurfaceMesh& s) {
             return make_blend(s, 2, contact::Multiquadric{0, 2.5});
         }},
        {"blend_3_r5",
         [](const SurfaceMesh& s) {
             return make_blend(s, 3, contact::Multiquadric{0, 2.5});
         }},
    };
    return list;
}

} // namespace

std::unique_ptr<Approximation> make_facets(const SurfaceMesh& surface) {
    return std::make_unique<Facets>(surface);
}

std::unique_ptr<Approximation> make_height_patches(const SurfaceMesh& surface, int ring) {
    return std::make_unique<HeightPatches>(surface, ring);
}

std::unique_ptr<Approximation> make_rpim(const SurfaceMesh& surface, int ring) {
    contact::RpimOptions options;
    options.ring = ring;
    return std::make_unique<Master>(surface, contact::make_rpim_surface(surface.topology, surface.x, options));
}

std::unique_ptr<Approximation> make_blend(const SurfaceMesh& surface, int level,
                                          const std::optional<contact::Multiquadric>& basis) {
    contact::BlendOptions options;
    options.basis = basis;
    options.level = level;
    return std::make_unique<Master>(surface, contact::make_blend_surface(surface.topology, surface.x, options));
}

const std::vector<std::string>& method_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const auto& [name, make] : makers()) list.push_back(name);
        return list;
    }();
    return names;
}

std::unique_ptr<Approximation> make_approximation(const std::string& method, const SurfaceMesh& surface) {
    for (const auto& [name, make] : makers())
        if (name == method) return make(surface);
    throw InternalError("no method is called '" + method + "'");
}

} // namespace osculate::study
