/// Half of a pair with forces averaged over facets at a symmetry plane that misses the origin, against the whole pair.

#include "osculate/contact/mortar.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double plane = 5; ///< at x = 5

/// A shallow bowl of triangles below, a ball's underside of triangles above it, both symmetric about the plane; or the half
/// of both beyond it.
struct Bowl {
    std::vector<Vec3> x;
    std::unique_ptr<ContactPair> pair;
    std::unique_ptr<ContactEvaluation> evaluation;
    Timings timings;

    Bowl(bool half, Discretisation discretisation) {
        const auto bowl = [](double r, double y) { return Vec3(plane + r, y, 0.03 * (r * r + 0.5 * y * y)); };
        const auto ball = [](double r, double y) { return Vec3(plane + r, y, 0.2 + 0.08 * (r * r + y * y)); };
        // facets symmetric about the plane; those of the slave face down
        const auto sheet = [&](int cells, double size, const auto& at, bool up) {
            std::map<std::pair<int, int>, Index> number;
            const auto node = [&](int i, int j) {
                const auto [found, fresh] = number.try_emplace({i, j}, static_cast<Index>(x.size()));
                if (fresh) x.push_back(at(size * i, size * j));
                return found->second;
            };
            std::vector<mesh::Facet> facets;
            for (int i = half ? 0 : -cells; i < cells; ++i)
                for (int j = -cells; j < cells; ++j) {
                    const Index a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), d = node(i, j + 1);
                    std::array<std::array<Index, 3>, 2> two{{{a, b, c}, {a, c, d}}};
                    if (i < 0) two = {{{a, b, d}, {b, c, d}}};
                    for (auto [p, q, r] : two) facets.push_back({{p, up ? q : r, up ? r : q, -1}, 3});
                }
            return facets;
        };
        const std::vector<mesh::Facet> below = sheet(6, 1, bowl, true), above = sheet(2, 0.8, ball, false);
        std::vector<contact::SymmetryPlane> planes;
        if (half) planes.push_back({Vec3(plane, 0, 0), Vec3::UnitX()});
        const auto mirrored = contact::mirror(below, x, planes, 100),
                   mirrored_slave = contact::mirror(above, x, planes, 100);
        auto surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored.facets, mirrored.positions);
        MasterNodes nodes;
        std::vector<Vec3> vertices;
        for (const Index v : surface->vertex_nodes()) {
            nodes.node.push_back(mirrored.original[v]);
            nodes.image.push_back(mirrored.image[v]);
            vertices.push_back(mirrored.positions[v]);
        }
        nodes.images = mirrored.images;
        if (!half) nodes.image.clear();
        SlaveNodes slaves;
        slaves.facets = above;
        slaves.node = mesh::HalfEdgeSurface(above, x).vertex_nodes();
        for (const Index node : slaves.node) {
            const Vec3 n = (x[node].x() == plane ? 1.0 : 0.0) * Vec3::UnitX();
            if (half) slaves.in_plane.push_back(Mat3::Identity() - n * n.transpose());
        }
        slaves.area.assign(slaves.node.size(), 1);
        slaves.stiffness.assign(slaves.node.size(), 1);
        contact::SmoothSlave smooth;
        smooth.surface = std::make_unique<mesh::HalfEdgeSurface>(mirrored_slave.facets, mirrored_slave.positions);
        for (const Index v : smooth.surface->vertex_nodes()) {
            smooth.X.push_back(mirrored_slave.positions[v]);
            const auto at = std::ranges::lower_bound(slaves.node, mirrored_slave.original[v]);
            smooth.node.push_back(static_cast<Index>(at - slaves.node.begin()));
            smooth.image.push_back(mirrored_slave.images[mirrored_slave.image[v]]);
        }
        smooth.shape = contact::make_blend_surface(*smooth.surface, smooth.X, {});
        ContactOptions options;
        options.friction = 0.3;
        options.hysteresis = 0;
        options.discretisation = discretisation;
        auto master = contact::make_blend_surface(*surface, vertices, {});
        pair = std::make_unique<ContactPair>("pair", x, slaves, std::move(surface), std::move(nodes), std::move(master),
                                             options, &smooth);
        evaluation = std::make_unique<ContactEvaluation>(*pair);
        evaluation->begin_step(x, pair->initial_history(), timings, 1);
    }
    void evaluate() { evaluation->evaluate(x, timings, 1); }
    /// Moves every node alike on both sides of the plane; nodes on it stay on it.
    void deform() {
        for (Vec3& p : x) {
            const double r = p.x() - plane, out = std::abs(r);
            p += Vec3(r * 0.02 * std::sin(3 * p.y() + out), 0.02 * std::cos(2 * out), 0.03 * std::sin(2 * p.y() - out));
        }
    }
};

class AtAPlane : public ::testing::TestWithParam<Discretisation> {};

TEST_P(AtAPlane, HasTheGapsNormalsAndDriftsOfTheWhole) {
    Bowl half(true, GetParam()), whole(false, GetParam());
    half.deform();
    whole.deform();
    half.evaluate();
    whole.evaluate();
    constexpr double patch_round_off = 1e-10; // machine epsilon times the condition of patches
    const auto at = [](const Bowl& bowl, Index j) { return bowl.x[bowl.pair->slaves().node[j]]; };
    int on_plane = 0;
    for (Index j = 0; j < half.pair->size(); ++j) {
        Index same = 0;
        while ((at(whole, same) - at(half, j)).norm() > patch_round_off) ASSERT_LT(++same, whole.pair->size());
        const contact::ContactPoint &one = half.evaluation->point(j), &other = whole.evaluation->point(same);
        ASSERT_TRUE(one.found && other.found);
        EXPECT_NEAR(one.gap, other.gap, patch_round_off) << at(half, j).transpose();
        EXPECT_LT((one.normal - other.normal).norm(), patch_round_off) << at(half, j).transpose();
        EXPECT_LT((half.evaluation->drift(j) - whole.evaluation->drift(same)).norm(), patch_round_off)
            << at(half, j).transpose();
        on_plane += at(half, j).x() == plane;
    }
    EXPECT_EQ(on_plane, 5);
}

TEST_P(AtAPlane, VariesAsItsDifferencesSay) {
    Bowl half(true, GetParam());
    half.deform();
    Random random(92);
    const std::vector<Vec3> x = half.x;
    std::vector<Vec3> way;
    for (std::size_t i = 0; i < x.size(); ++i) way.push_back(random.vector(1));
    const double step = 1e-5, differences = 1e-5; // step^2 times third derivatives of the bumps
    std::vector<std::vector<Vec3>> normals, drifts;
    for (const double t : {step, -step}) {
        for (std::size_t i = 0; i < x.size(); ++i) half.x[i] = x[i] + t * way[i];
        half.evaluate();
        auto& n = normals.emplace_back();
        auto& d = drifts.emplace_back();
        for (Index j = 0; j < half.pair->size(); ++j) {
            n.push_back(half.evaluation->point(j).normal);
            d.push_back(half.evaluation->drift(j));
        }
    }
    half.x = x;
    half.evaluate();
    half.evaluation->prepare_variations(std::vector<char>(static_cast<std::size_t>(half.pair->size()), 1), 1);
    for (Index j = 0; j < half.pair->size(); ++j) {
        contact::ContactVariation variation;
        half.evaluation->vary(j, variation);
        Matrix dd, dn = variation.dn;
        half.evaluation->drift_variation(j, variation, dd);
        contact::MatrixX3 E = half.evaluation->master_force_by_lambda(j);
        half.evaluation->fold(j, dd, E);
        E = half.evaluation->master_force_by_lambda(j);
        half.evaluation->fold(j, dn, E);
        const auto& nodes = half.evaluation->point_nodes(j);
        Vector dy(3 + 3 * static_cast<Index>(nodes.size()));
        dy.head<3>() = way[half.pair->slaves().node[j]];
        for (std::size_t i = 0; i < nodes.size(); ++i) dy.segment<3>(3 + 3 * static_cast<Index>(i)) = way[nodes[i]];
        const auto k = static_cast<std::size_t>(j);
        EXPECT_LT((dn * dy - (normals[0][k] - normals[1][k]) / (2 * step)).norm(), differences) << j;
        EXPECT_LT((dd * dy - (drifts[0][k] - drifts[1][k]) / (2 * step)).norm(), differences) << j;
    }
}

INSTANTIATE_TEST_SUITE_P(By, AtAPlane, ::testing::Values(Discretisation::mortar, Discretisation::petrov_galerkin),
                         [](const auto& tested) {
                             return tested.param == Discretisation::mortar ? "Mortar" : "PetrovGalerkin";
                         });

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
