#include "osculate/fe/face_skin.hpp"

#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/mesh/generators.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::fe::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-12; // sums of some ten products of order one

/// A sheared block whose upper side is curved or plane.
mesh::Mesh block(mesh::CellType type, double curvature) {
    mesh::Mesh mesh = mesh::make_block({0, 0, 0}, {2, 1, 1}, {3, 2, 2}, type);
    for (Vec3& X : mesh.nodes) {
        X.x() += 0.3 * X.y();
        X.z() *= 1 - curvature * X.x() * X.x();
    }
    return mesh;
}

const mesh::CellType quadratic[] = {mesh::CellType::tet10, mesh::CellType::wedge15, mesh::CellType::hex20};

TEST(FaceSkin, StartsAtTheNodesAndFollowsLinearMotions) {
    const Mat3 F = Eigen::AngleAxisd(2, Vec3(1, 2, -1).normalized()) * (Mat3::Identity() + 0.1 * Mat3::Random());
    for (const mesh::CellType type : quadratic) {
        const mesh::Mesh mesh = block(type, 0.2);
        const auto skin = skin_weights(mesh, mesh.surfaces.at("z_max"), 0, mesh.nodes);
        ASSERT_EQ(skin.size(), mesh::nodes_of(mesh.surfaces.at("z_max")).size());
        for (const SkinWeights& one : skin) {
            double sum = 0;
            Vec3 y = Vec3::Zero();
            for (const auto& [node, weight] : one.carriers) {
                sum += weight;
                y += weight * (F * mesh.nodes[static_cast<std::size_t>(node)]);
            }
            EXPECT_NEAR(sum, 1, round_off);
            EXPECT_LT((y - F * mesh.nodes[static_cast<std::size_t>(one.node)]).norm(), round_off);
        }
    }
}

TEST(FaceSkin, GivesThePressureOnPiecesTheForcesOfThatOnFaces) {
    for (const mesh::CellType type : quadratic) {
        const mesh::Mesh mesh = block(type, 0);
        const auto& facets = mesh.surfaces.at("z_max");
        std::vector<double> area(mesh.nodes.size(), 0), force(mesh.nodes.size(), 0), expected(mesh.nodes.size(), 0);
        for (const mesh::Facet& facet : facets) {
            const auto shares = tributary_areas(facet, mesh.nodes);
            for (std::size_t c = 0; c < static_cast<std::size_t>(facet.count); ++c)
                area[static_cast<std::size_t>(facet.nodes[c])] += shares[c];
        }
        for (const SkinWeights& one : skin_weights(mesh, facets, 0, mesh.nodes))
            for (const auto& [node, weight] : one.carriers)
                force[static_cast<std::size_t>(node)] += weight * area[static_cast<std::size_t>(one.node)];
        for (const mesh::SurfaceFace& face : mesh::surface_faces(mesh, facets)) {
            const auto shares = tributary_areas(face, mesh.nodes);
            for (std::size_t i = 0; i < static_cast<std::size_t>(face.count); ++i)
                expected[static_cast<std::size_t>(face.nodes[i])] += shares[i];
        }
        for (std::size_t i = 0; i < force.size(); ++i) EXPECT_NEAR(force[i], expected[i], round_off) << i;
    }
}

TEST(FaceSkin, IsNotNeededWithoutMidsideNodes) {
    const mesh::Mesh mesh = block(mesh::CellType::hex8, 0.2);
    EXPECT_TRUE(skin_weights(mesh, mesh.surfaces.at("z_max"), 0, mesh.nodes).empty());
}

} // namespace
} // namespace osculate::fe::OSCULATE_THIS_FILE
