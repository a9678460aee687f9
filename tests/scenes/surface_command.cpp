#include "osculate/core/types.hpp"
#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;

// tube of radius 3 m and length 12 m, seven facets around and six along it
constexpr int around = 7, along = 6, facets = around * along, refine = 4;
constexpr int samples_per_facet = (refine + 1) * (refine + 1);

class SurfaceCommand : public Program {
protected:
    /// Writes the coarse half-tube's surface of one kind into `folder`/<kind>.
    Outcome surface(const std::string& kind, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"surface",  scene_file("configs/paper/half_tube.yaml"),
                                           "-o",       kind,
                                           "--refine", std::to_string(refine),
                                           "--set",    "bodies.tube.mesh.half_tube.divisions=[7, 6, 1]",
                                           "--set",    "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]",
                                           "--set",    "contact.sliding.surface=" + kind};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return osculate(arguments);
    }
    vtkNew<vtkPolyData> read(const std::string& file) const {
        vtkNew<vtkXMLPolyDataReader> reader;
        reader->SetFileName((folder / file).c_str());
        reader->Update();
        vtkNew<vtkPolyData> data;
        data->ShallowCopy(reader->GetOutput());
        return data;
    }
    /// Largest angle between normals at one place of the tessellation, by comparing all points at facet edges.
    static double jump(vtkPolyData& data) {
        constexpr double same_place = 0.05; // m; samples are 0.3 m apart, the two sides of an edge millimetres
        double largest = 0;
        vtkDataArray* normal = data.GetPointData()->GetArray("normal");
        for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
            for (vtkIdType j = 0; j < i; ++j) {
                const Vec3 a(data.GetPoint(i));
                const Vec3 b(data.GetPoint(j));
                if ((a - b).norm() > same_place) continue;
                const Vec3 na(normal->GetTuple3(i)), nb(normal->GetTuple3(j));
                largest = std::max(largest, std::atan2(na.cross(nb).norm(), na.dot(nb)));
            }
        return largest;
    }
};

class EverySurface : public SurfaceCommand, public testing::WithParamInterface<const char*> {};

TEST_P(EverySurface, IsWrittenAndReadsBack) {
    const std::string kind = GetParam();
    const Outcome outcome = surface(kind);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("pair sliding: 42 master facets, 56 vertices, 0 feature edge(s), 26 boundary"));
    const auto data = read(kind + "/sliding.vtp");
    ASSERT_EQ(data->GetNumberOfPoints(), facets * samples_per_facet);
    EXPECT_EQ(data->GetNumberOfPolys(), facets * refine * refine);
    for (const char* name :
         {"normal", "mean_curvature", "gauss_curvature", "distance", "patch_nodes", "found", "facet"})
        ASSERT_NE(data->GetPointData()->GetArray(name), nullptr) << name;
    vtkDataArray* found = data->GetPointData()->GetArray("found");
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) ASSERT_EQ(found->GetTuple1(i), 1) << i;

    const auto edges = read(kind + "/sliding_edges.vtp");
    EXPECT_EQ(edges->GetNumberOfLines(), 2 * (around + along));
    ASSERT_NE(edges->GetCellData()->GetArray("feature"), nullptr);
    EXPECT_EQ(edges->GetCellData()->GetArray("feature")->GetRange()[1], 0);
}

TEST_P(EverySurface, PassesThroughTheNodes) {
    ASSERT_EQ(surface(GetParam()).code, 0);
    const auto data = read(std::string(GetParam()) + "/sliding.vtp");
    vtkDataArray* distance = data->GetPointData()->GetArray("distance");
    double largest = 0;
    for (int f = 0; f < facets; ++f)
        for (const int corner : {0, refine, samples_per_facet - refine - 1, samples_per_facet - 1}) {
            constexpr double round_off = 1e-11; // m: condition of the patches times round-off of 12 m
            const vtkIdType i = f * samples_per_facet + corner;
            EXPECT_NEAR(distance->GetTuple1(i), 0, round_off);
            EXPECT_NEAR(std::hypot(data->GetPoint(i)[0], data->GetPoint(i)[2]), 3, round_off) << "nodes are exact";
        }
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) largest = std::max(largest, -distance->GetTuple1(i));
    // a smooth surface lies behind the facets by nearly their sagitta, 3 m (1 - cos(90 deg / 7))
    const double sagitta = 3 * (1 - std::cos(M_PI / 2 / around));
    const bool flat = std::string(GetParam()) == "facets";
    constexpr double part = 0.2; // of the sagitta, by which so coarse a patch may miss the circle
    EXPECT_NEAR(largest, flat ? 0 : sagitta, flat ? 1e-12 : part * sagitta);
}

TEST_P(EverySurface, HasTheCurvatureOfTheTubeUnlessItIsFlat) {
    ASSERT_EQ(surface(GetParam()).code, 0);
    const auto data = read(std::string(GetParam()) + "/sliding.vtp");
    vtkDataArray* mean = data->GetPointData()->GetArray("mean_curvature");
    double sum = 0;
    for (vtkIdType i = 0; i < mean->GetNumberOfTuples(); ++i)
        sum += mean->GetTuple1(i) / static_cast<double>(mean->GetNumberOfTuples());
    // hollow, radius 3 m: -1/6, and coarse smooth surfaces come within 5 % of it on average
    const double exact = std::string(GetParam()) == "facets" ? 0 : -1.0 / 6;
    EXPECT_NEAR(sum, exact, 0.05 / 6);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EverySurface, testing::Values("facets", "rpim", "blend"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(SurfaceCommand, BlendHasNoJumpOfTheNormalWhereFacetsAndPatchesDo) {
    std::vector<double> jumps;
    for (const char* kind : {"facets", "rpim", "blend"}) {
        // with the multiquadric the largest jump is across an edge, not across a corner, which is no edge
        const Outcome outcome = surface(kind, {"--set", "contact.sliding.discretisation=node"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        jumps.push_back(jump(*read(std::string(kind) + "/sliding.vtp")));
        const std::string words = "jump of the normal across facet edges ";
        const std::size_t at = outcome.out.find(words);
        ASSERT_NE(at, std::string::npos);
        constexpr double printed = 1e-3; // four digits
        EXPECT_NEAR(std::stod(outcome.out.substr(at + words.size())), jumps.back() * 180 / M_PI,
                    printed * jumps.back() * 180 / M_PI + 1e-6);
    }
    EXPECT_NEAR(jumps[0], M_PI / around, 1e-9) << "facets of a regular prism";
    EXPECT_LT(jumps[1], 0.2 * jumps[0]);
    EXPECT_GT(jumps[1], 1e-4) << "a patch per facet changes from facet to facet";
    EXPECT_LT(jumps[2], 1e-9) << "round-off";
}

TEST_F(SurfaceCommand, RefusesAPairTheSceneDoesNotHave) {
    const Outcome outcome = surface("facets", {"--pair", "slidin"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("'slidin'"));
    EXPECT_THAT(outcome.err, HasSubstr("'sliding'"));
    EXPECT_FALSE(std::filesystem::exists(folder / "facets"));
}

TEST_F(SurfaceCommand, WritesTrianglesAndTheDefaultFolder) {
    const Outcome outcome = osculate({"surface", scene_file("tests/scenes/press.yaml"), "--refine", "2", "--set",
                                      "bodies.base.mesh.block.element=wedge6", "--set", "contact.joint.surface=blend"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto data = read("out/press/surface/joint.vtp");
    EXPECT_EQ(data->GetNumberOfPolys(), 4 * 4 * 2 * 2 * 2);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) EXPECT_NEAR(data->GetPoint(i)[2], 1, 1e-12);
    // every cell has the orientation of the surface: area vectors point up and cover the block's top
    double area = 0;
    for (vtkIdType c = 0; c < data->GetNumberOfPolys(); ++c) {
        vtkNew<vtkIdList> corners;
        data->GetCellPoints(c, corners);
        ASSERT_EQ(corners->GetNumberOfIds(), 3);
        const Vec3 a(data->GetPoint(corners->GetId(0)));
        const Vec3 b(data->GetPoint(corners->GetId(1)));
        const Vec3 d(data->GetPoint(corners->GetId(2)));
        EXPECT_GT((b - a).cross(d - a).z(), 0);
        area += (b - a).cross(d - a).z() / 2;
    }
    EXPECT_NEAR(area, 4, 1e-12);
}

TEST_F(SurfaceCommand, ShowsFeatureEdgesApartFromTheBoundary) {
    // top and sides of the block, above its bottom layer of elements
    const Outcome outcome = osculate({"surface", scene_file("tests/scenes/press.yaml"), "-o", "here", "--refine", "2",
                                      "--set", "sets.ground={body: base, box: {min: [-1, -1, 0.4], max: [3, 3, 2]}}"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("pair joint: 32 master facets, 41 vertices, 20 feature edge(s), 16 boundary"));
    const auto edges = read("here/joint_edges.vtp");
    ASSERT_EQ(edges->GetNumberOfLines(), 16 + 20) << "the open rim; the top's four sides and four short corners";
    vtkDataArray* feature = edges->GetCellData()->GetArray("feature");
    for (vtkIdType c = 0; c < 36; ++c) {
        vtkNew<vtkIdList> line;
        edges->GetCellPoints(c, line);
        ASSERT_EQ(line->GetNumberOfIds(), 3);
        const double z = Vec3(edges->GetPoint(line->GetId(1))).z(); // middle of an edge
        EXPECT_EQ(feature->GetTuple1(c), z > 0.5 + 1e-9 ? 1 : 0) << c;
    }
}

/// Half of a tube's length and the right half of its inside, with two symmetry planes, beside the whole.
class MirroredSurface : public SurfaceCommand, public testing::WithParamInterface<const char*> {
protected:
    [[nodiscard]] Outcome quarter() const {
        // boxes: the inner facets right of x = 0; the nodes of the two planes
        return osculate(
            {"surface",  scene_file("configs/paper/half_tube.yaml"),
             "-o",       "quarter",
             "--refine", "4",
             "--set",    "bodies.tube.mesh.half_tube.divisions=[12, 3, 1]",
             "--set",    "bodies.tube.mesh.half_tube.length=6 m",
             "--set",    "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]",
             "--set",    "sets.tube_inner={body: tube, box: {min: [-0.001, -1, -3.001], max: [3.001, 7, 0.001]}}",
             "--set",    "sets.middle={body: tube, box: {min: [-0.001, -1, -5], max: [0.001, 7, 1]}}",
             "--set",    "sets.far_end={body: tube, surface: y_max}",
             "--set",    "supports.middle={symmetry: [1, 0, 0]}",
             "--set",    "supports.far_end={symmetry: [0, 1, 0]}",
             "--set",    std::string("contact.sliding.surface=") + GetParam()});
    }
    [[nodiscard]] Outcome whole() const {
        return osculate({"surface", scene_file("configs/paper/half_tube.yaml"), "-o", "whole", "--refine", "4", "--set",
                         "bodies.tube.mesh.half_tube.divisions=[12, 6, 1]", "--set",
                         "bodies.contactor.mesh.contactor.divisions=[6, 8, 1]", "--set",
                         std::string("contact.sliding.surface=") + GetParam()});
    }
};

TEST_P(MirroredSurface, IsDrawnOnceAndIsThatOfTheWhole) {
    constexpr int own = 6 * 3;
    const Outcome part = quarter(), all = whole();
    ASSERT_EQ(part.code, 0) << part.err;
    ASSERT_EQ(all.code, 0) << all.err;
    EXPECT_THAT(part.out, HasSubstr("18 master facets, 28 vertices, 0 feature edge(s), 9 boundary edge(s)"));
    EXPECT_THAT(part.out, HasSubstr("mirror images of facets beyond symmetry planes, not drawn"));
    EXPECT_THAT(part.out, HasSubstr("surface found at 450 of 450 samples"));
    const auto a = read("quarter/sliding.vtp"), b = read("whole/sliding.vtp");
    ASSERT_EQ(a->GetNumberOfPolys(), own * refine * refine);
    ASSERT_EQ(a->GetNumberOfPoints(), own * samples_per_facet);
    EXPECT_EQ(a->GetPointData()->GetArray("facet")->GetRange()[1], own - 1);
    EXPECT_EQ(read("quarter/sliding_edges.vtp")->GetNumberOfLines(), 9) << "the rim and the near end, not the planes";
    for (vtkIdType c = 0; c < a->GetNumberOfPolys(); ++c) {
        vtkNew<vtkIdList> corners;
        a->GetCellPoints(c, corners);
        for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k) {
            const Vec3 p(a->GetPoint(corners->GetId(k)));
            constexpr double lean = 1e-4; // m: a facet's own patch is not quite perpendicular to the plane
            EXPECT_GT(p.x(), -lean);
            EXPECT_LT(p.y(), 6 + lean);
        }
    }
    for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i) {
        const Vec3 p(a->GetPoint(i)), n(a->GetPointData()->GetArray("normal")->GetTuple3(i));
        constexpr double round_off = 1e-9; // curvatures: second derivatives of patches of condition 1e5
        bool seen = false;
        for (vtkIdType k = 0; k < b->GetNumberOfPoints() && !seen; ++k) {
            if ((Vec3(b->GetPoint(k)) - p).norm() > round_off) continue;
            if ((Vec3(b->GetPointData()->GetArray("normal")->GetTuple3(k)) - n).norm() > round_off) continue;
            seen = true; // the other facets of an edge have the same place, and with patches another normal
            for (const char* name : {"mean_curvature", "gauss_curvature", "distance", "patch_nodes"})
                seen = seen && std::abs(a->GetPointData()->GetArray(name)->GetTuple1(i) -
                                        b->GetPointData()->GetArray(name)->GetTuple1(k)) < round_off;
        }
        EXPECT_TRUE(seen) << p.transpose();
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MirroredSurface, testing::Values("facets", "rpim", "blend"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
