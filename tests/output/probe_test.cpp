#include "osculate/fe/reference_element.hpp"
#include "osculate/output/csv_reader.hpp"
#include "osculate/output/probe.hpp"
#include "osculate/output/probe_file.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double round_off = 1e-12;
const model::ContactEvaluations no_contact;

/// An affine displacement, small enough to do no harm.
Vec3 affine(const Vec3& X) {
    Mat3 A;
    A << 1e-3, 2e-3, -3e-3, 4e-4, -5e-3, 6e-3, 7e-3, 8e-4, -9e-3;
    return A * X + Vec3(0.1, -0.2, 0.3);
}

void move(TwoBlocks& blocks, Vec3 (*u)(const Vec3&)) {
    for (std::size_t i = 0; i < blocks.model.X.size(); ++i) blocks.state.u[i] = u(blocks.model.X[i]);
}

std::vector<std::string> names(const Probe& probe) {
    std::vector<std::string> names;
    for (const ProbeColumn& column : probe.columns()) names.push_back(column.header());
    return names;
}

TEST(PointProbe, IsExactForALinearDisplacement) {
    TwoBlocks blocks;
    move(blocks, affine);
    const Vec3 X(1.337, 0.271, 0.618);
    const auto probe = make_point_probe(blocks.model, 0, X, {"displacement"});
    EXPECT_THAT(names(*probe), ElementsAre("displacement_x [m]", "displacement_y [m]", "displacement_z [m]"));
    const auto rows = probe->rows(blocks.snapshot());
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR((Eigen::Map<const Vec3>(rows[0].data()) - affine(X)).norm(), 0, round_off);
}

TEST(PointProbe, IsExactInDistortedElementsOfEveryType) {
    for (const mesh::CellType type : {mesh::CellType::hex8, mesh::CellType::wedge6, mesh::CellType::tet4,
                                      mesh::CellType::tet10, mesh::CellType::wedge15, mesh::CellType::hex20}) {
        model::Model model;
        const auto pattern = type == mesh::CellType::wedge6 ? mesh::BlockPattern::triangle : mesh::BlockPattern::quad;
        const auto element = type == mesh::CellType::wedge6 ? mesh::CellType::hex8 : type;
        model::Body body{"block", mesh::make_block({0, 0, 0}, {2, 1, 1}, {3, 2, 2}, element, pattern), 0, {}, {}, {}};
        ASSERT_EQ(body.mesh.blocks.front().type, type);
        if (type != mesh::CellType::tet10) // whose edges stay straight
            for (Vec3& X : body.mesh.nodes)
                X += 0.05 * Vec3(std::sin(5 * X.y()), std::sin(4 * X.z()), std::sin(3 * X.x()));
        const Vec3 X(1.01, 0.52, 0.53);
        model.X = body.mesh.nodes;
        model.bodies.push_back(std::move(body));
        model::State state;
        for (const Vec3& node : model.X) state.u.values().push_back(affine(node));
        const auto rows = make_point_probe(model, 0, X, {"displacement"})->rows(Snapshot(model, state, no_contact, {}));
        EXPECT_NEAR((Eigen::Map<const Vec3>(rows[0].data()) - affine(X)).norm(), 0, round_off)
            << static_cast<int>(type);
    }
}

TEST(PointProbe, RefusesAPointOutsideAndSaysHowFar) {
    const TwoBlocks blocks;
    try {
        (void)make_point_probe(blocks.model, 0, {1, 0.5, 1.25}, {"displacement"});
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("0.25 m"));
    }
}

TEST(LineProbe, HasNoValuesOutsideOfItsBody) {
    TwoBlocks blocks;
    move(blocks, affine);
    const auto probe = make_line_probe(blocks.model, 0, {-1, 0.5, 0.5}, {1, 0.5, 0.5}, 5, {"displacement", "strain"});
    const auto rows = probe->rows(blocks.snapshot());
    ASSERT_EQ(rows.size(), 5U);
    EXPECT_EQ(probe->columns().size(), 4U + 3 + 6);
    EXPECT_TRUE(std::isnan(rows[1][4]));
    EXPECT_EQ(rows[4][0], 2) << "distance from its start";
    EXPECT_NEAR(rows[4][4], affine({1, 0.5, 0.5}).x(), round_off);
    EXPECT_NEAR(rows[4][7], 1e-3, round_off) << "strain_xx";
    EXPECT_NEAR(rows[4][10], 1.2e-3, round_off) << "strain_xy: half the angle";
    EXPECT_THROW((void)make_line_probe(blocks.model, 0, {-1, 0, 2}, {1, 0, 2}, 5, {"strain"}), std::invalid_argument);
}

TEST(ContactLineProbe, LooksAtTheSlaveSurfaceBelowIt) {
    const TwoBlocks blocks;
    const auto probe = make_contact_line_probe(blocks.model, 0, {0.5, 0.5, 1.1}, {2.5, 0.5, 1.1}, 9,
                                               {"normal_stress", "status", "gap"});
    const auto rows = probe->rows(blocks.snapshot());
    EXPECT_EQ(rows[2][1], 1.0);
    EXPECT_NEAR(rows[2][3], 1, round_off) << "Z on the surface, not on the line";
    EXPECT_NEAR(rows[2][4], 100 / 0.25, 1e-9);
    EXPECT_NEAR(rows[6][4], 50 / 0.25, 1e-9) << "half way to where nothing touches";
    EXPECT_EQ(rows[0][5], 1) << "sticks";
    EXPECT_EQ(rows[3][5], 2) << "slips: the nearest node, no mean of statuses";
    EXPECT_NEAR(rows[2][6], -0.01, round_off);
    EXPECT_TRUE(std::isnan(rows[8][6])) << "no partner, no gap";
}

TEST(ContactArcProbe, TurnsAboutItsAxisAlongTheSlaveSurface) {
    const TwoBlocks blocks;
    const double right_angle = std::numbers::pi / 2;
    const auto probe = make_contact_arc_probe(blocks.model, 0, {1, 0.5, 7}, {0, 0, -2}, {0.8, 0.5, 1.1}, right_angle, 3,
                                              {"normal_stress"});
    EXPECT_EQ(names(*probe)[1], "angle [rad]");
    const auto rows = probe->rows(blocks.snapshot());
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_NEAR(rows[1][0], 0.2 * right_angle / 2, round_off) << "along the arc";
    EXPECT_EQ(rows[2][1], right_angle);
    EXPECT_NEAR(rows[2][2], 1, round_off);
    EXPECT_NEAR(rows[2][3], 0.7, round_off) << "clockwise seen from above, as the axis points down";
    EXPECT_NEAR(rows[2][4], 1, round_off) << "on the surface, not on the arc";
    EXPECT_NEAR(rows[2][5], 400, 1e-9);
    EXPECT_THROW((void)make_contact_arc_probe(blocks.model, 0, {1, 0.5, 1}, {0, 0, 1}, {1, 0.5, 1.2}, 1, 3, {"gap"}),
                 std::invalid_argument)
        << "it begins on its axis";
    EXPECT_THROW((void)make_contact_arc_probe(blocks.model, 0, {1, 0.5, 3}, {0, 0, 1}, {0.8, 0.5, 3}, 1, 3, {"gap"}),
                 std::invalid_argument)
        << "it is farther from the surface than from its axis";
}

TEST(ContactForceProbe, IsWhatContactDoesToTheNodesOfASet) {
    const TwoBlocks blocks;
    const model::Body& cap = blocks.model.bodies[1];
    const auto global = [&](std::vector<mesh::Facet> facets) {
        for (mesh::Facet& facet : facets)
            for (int c = 0; c < facet.count; ++c) facet.nodes[c] += cap.first_node;
        return facets;
    };
    model::Set under{"under", 1, {}, global(cap.mesh.surfaces.at("z_min"))};
    for (Index n = 0; n < cap.nodes(); ++n)
        if (cap.mesh.nodes[n].z() == 1) under.nodes.push_back(cap.first_node + n);
    const Vec3 about(1, 0.5, 0);
    const auto row = make_contact_force_probe(blocks.model, under, about)->rows(blocks.snapshot())[0];
    const Vec3 sum = 4 * TwoBlocks::force, centre = Vec3(1, 0.5, 1) + TwoBlocks::shift,
               moment = (centre - about).cross(sum); // forces are the same on all
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(row[k], sum(k), 1e-9);
        EXPECT_NEAR(row[3 + k], moment(k), 1e-9);
        EXPECT_NEAR(row[6 + k], centre(k), round_off);
    }
    EXPECT_NEAR(row[9], 400, 1e-9) << "pressing";
    EXPECT_NEAR(row[10], 0.75, round_off) << "of the nodes at the end, 0.125 each, and in the middle";
    EXPECT_NEAR(row[11], 400 / 0.75, 1e-9);
    EXPECT_NEAR(row[12], 800, 1e-9) << "at the end";
    under.facets = global(cap.mesh.surfaces.at("z_max")); // where nothing touches
    under.nodes.clear();
    for (Index n = 0; n < cap.nodes(); ++n)
        if (cap.mesh.nodes[n].z() > 1) under.nodes.push_back(cap.first_node + n);
    const auto none = make_contact_force_probe(blocks.model, under, about)->rows(blocks.snapshot())[0];
    EXPECT_EQ(none[2], 0);
    EXPECT_TRUE(std::isnan(none[6])) << "no centre";
    EXPECT_TRUE(std::isnan(none[11])) << "no mean of nothing";
    under.facets.clear();
    EXPECT_THROW((void)make_contact_force_probe(blocks.model, under, about), std::invalid_argument);
}

TEST(NodesProbe, ReducesWhatHasAValue) {
    const TwoBlocks blocks;
    model::Set set{"ends", 1, {12, 13, 23}, {}};
    const auto nodes = make_nodes_probe(blocks.model, set, {"displacement"}, {"mean", "sum"});
    EXPECT_EQ(names(*nodes).front(), "mean_displacement_x [m]");
    EXPECT_NEAR(nodes->rows(blocks.snapshot())[0][0], 0.02, round_off);
    EXPECT_NEAR(nodes->rows(blocks.snapshot())[0][5], -0.03, round_off);
    const auto slaves = make_slave_nodes_probe(blocks.model, 0, {"gap", "normal_stress"}, {"min", "max"});
    const auto row = slaves->rows(blocks.snapshot())[0];
    EXPECT_NEAR(row[0], -0.01, round_off) << "those without a partner left out";
    EXPECT_NEAR(row[3], 400, 1e-9);
}

TEST(NodesProbe, TakesTheMeanOverTheAreaByTheShapeFunctions) {
    for (const mesh::CellType type : {mesh::CellType::hex8, mesh::CellType::tet10}) {
        model::Model model;
        model::Body body{"block", mesh::make_block({0, 0, 0}, {2, 1, 1}, {2, 1, 1}, type), 0, {}, {}, {}};
        for (Vec3& X : body.mesh.nodes) X.x() = X.x() * (1 + X.x()) / 3; // elements of unlike sizes, 0 to 2
        if (type == mesh::CellType::tet10)                               // with straight edges
            for (std::size_t e = 0; e < static_cast<std::size_t>(body.mesh.element_count()); ++e) {
                const Index* cell = body.mesh.blocks.front().connectivity.data() + 10 * e;
                for (std::size_t m = 0; m < 6; ++m)
                    body.mesh.nodes[cell[4 + m]] = (body.mesh.nodes[cell[fe::Tet10::edges[m][0]]] +
                                                    body.mesh.nodes[cell[fe::Tet10::edges[m][1]]]) /
                                                   2;
            }
        model::Set top{"top", 0, {}, body.mesh.surfaces.at("z_max")};
        for (Index n = 0; n < body.mesh.node_count(); ++n)
            if (body.mesh.nodes[n].z() == 1) top.nodes.push_back(n);
        model.X = body.mesh.nodes;
        model.bodies.push_back(std::move(body));
        model::State state;
        // what the elements hold exactly: x for hexahedra, x^2 for ten nodes
        const bool quadratic = type == mesh::CellType::tet10;
        for (const Vec3& X : model.X) state.u.values().emplace_back(quadratic ? X.x() * X.x() : X.x(), 0, 0);
        const auto probe = make_nodes_probe(model, top, {"displacement"}, {"area_mean"});
        EXPECT_EQ(names(*probe).front(), "area_mean_displacement_x [m]");
        EXPECT_NEAR(probe->rows(Snapshot(model, state, no_contact, {}))[0][0], quadratic ? 4.0 / 3 : 1, round_off);
        top.facets.clear();
        EXPECT_THROW((void)make_nodes_probe(model, top, {"displacement"}, {"area_mean"}), std::invalid_argument);
    }
    const TwoBlocks blocks; // all slave nodes have the same area
    const auto pair = make_slave_nodes_probe(blocks.model, 0, {"normal_stress"}, {"mean", "area_mean"});
    const auto row = pair->rows(blocks.snapshot())[0];
    EXPECT_NEAR(row[1], row[0], round_off * row[0]);
}

TEST(SectionForceProbe, CarriesTheStressOfTheSection) {
    TwoBlocks blocks;
    move(blocks, [](const Vec3& X) { return Vec3(1e-3 * X.x(), 0, 0); });
    const Vec3 P(0.9, 0.5, 0.5); // between the middles of the two elements: the cut goes along x = 1
    const auto row = make_section_force_probe(blocks.model, 0, P, {1, 0, 0})->rows(blocks.snapshot())[0];
    const double F = TwoBlocks::E * 1e-3; // on 1 m^2, nu = 0
    EXPECT_NEAR(row[0], F, round_off * F) << "tension along the normal";
    for (const std::size_t k : {1U, 2U, 3U, 4U, 5U}) EXPECT_NEAR(row[k], 0, round_off * F);
    const auto back = make_section_force_probe(blocks.model, 0, P, {-1, 0, 0})->rows(blocks.snapshot())[0];
    EXPECT_NEAR(back[0], -F, round_off * F) << "the other part on this one";
    const auto aside = make_section_force_probe(blocks.model, 0, {1, 0.25, 0}, {1, 0, 0})->rows(blocks.snapshot())[0];
    EXPECT_NEAR(aside[4], 0.5 * F, round_off * F) << "about a point half a metre below its middle";
    EXPECT_NEAR(aside[5], -0.25 * F, round_off * F);
    EXPECT_THROW((void)make_section_force_probe(blocks.model, 0, {3, 0, 0}, {1, 0, 0}), std::invalid_argument);
}

TEST(SectionForceProbe, TakesMomentsOfWhereTheSectionIsNow) {
    TwoBlocks blocks;
    move(blocks, [](const Vec3& X) { return Vec3(1e-3 * X.x(), 0, 0.5); }); // stretched, and half a metre up
    const auto row = make_section_force_probe(blocks.model, 0, {0.9, 0.5, 0.5}, {1, 0, 0})->rows(blocks.snapshot())[0];
    const double F = TwoBlocks::E * 1e-3; // on 1 m^2, nu = 0
    EXPECT_NEAR(row[0], F, round_off * F);
    EXPECT_NEAR(row[4], 0.5 * F, round_off * F);
}

class ProbeFiles : public InTemporaryFolder {};

TEST_F(ProbeFiles, HoldTimeUnitsAndEmptyCells) {
    const TwoBlocks blocks;
    const auto probe = make_contact_line_probe(blocks.model, 0, {0.5, 0.5, 1}, {2.5, 0.5, 1}, 2, {"gap"});
    ProbeFile(folder, "line", *probe).write(blocks.snapshot());
    EXPECT_EQ(content(ProbeFile::path(folder, "line")).substr(0, 44), "time [s],s [m],X [m],Y [m],Z [m],gap [m]\n2.5");
    const NumberTable table = read_numbers(ProbeFile::path(folder, "line"));
    EXPECT_TRUE(std::isnan(table.columns[5][1]));
    EXPECT_EQ(name_of_column(table.names[5]), "gap");
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
