#include "osculate/contact/sided_surface.hpp"

#include "contact/creases.hpp"

#include <algorithm>

namespace osculate::contact {

namespace {

/// See with_sides().
class SidedSurface final : public MasterSurface {
public:
    SidedSurface(const mesh::HalfEdgeSurface& surface, std::unique_ptr<MasterSurface> each, Creases creases)
        : surface_(surface), each_(std::move(each)), creases_(std::move(creases)) {
        for (Index f = 0; f < surface.facet_count(); ++f) {
            std::vector<Index> vertices;
            const auto add = [&](Index facet) {
                const auto own = each_->patch_vertices(facet);
                vertices.insert(vertices.end(), own.begin(), own.end());
            };
            add(f);
            for (const Creases::Neighbour& other : creases_.of(f)) add(other.facet);
            std::ranges::sort(vertices);
            vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
            reach_.push_back(std::move(vertices));
        }
    }

    std::span<const Index> patch_vertices(Index facet) const override {
        return reach_[static_cast<std::size_t>(facet)];
    }
    Index fallbacks() const override { return each_->fallbacks(); }

    void evaluate(const Vec3& s, const FacetHit& hit, const std::vector<Vec3>& x, ContactPoint& point,
                  ContactVariation* variation, const Placement*) const override {
        each_->evaluate(s, hit, x, point, variation);
        point.side = -1;
        if (hit.facet < 0) return;
        const std::vector<Index> across = creases_.across(hit);
        if (across.empty()) return;
        point.side = hit.facet;
        for (const Index facet : across) {
            FacetHit there;
            there.facet = facet;
            there.distance = hit.distance;
            ContactPoint other;
            each_->evaluate(s, there, x, other);
            if (!other.found ||
                (point.found && !Creases::is_on_other(point.gap, other.gap, surface_.facet_size(hit.facet))))
                continue;
            if (variation != nullptr) each_->evaluate(s, there, x, other, variation);
            point = std::move(other);
            point.side = facet;
        }
        point.facet = hit.facet;
    }

private:
    const mesh::HalfEdgeSurface& surface_;
    std::unique_ptr<MasterSurface> each_;
    Creases creases_;
    std::vector<std::vector<Index>> reach_;
};

} // namespace

std::unique_ptr<MasterSurface> with_sides(const mesh::HalfEdgeSurface& surface, std::unique_ptr<MasterSurface> each) {
    Creases creases(surface);
    if (creases.none()) return each;
    return std::make_unique<SidedSurface>(surface, std::move(each), std::move(creases));
}

} // namespace osculate::contact
