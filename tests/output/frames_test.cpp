#include "osculate/output/frames.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"

#include <gmock/gmock.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class FramesFolder : public InTemporaryFolder {
protected:
    template <class Reader> vtkSmartPointer<vtkPointSet> read(const std::string& file) const {
        vtkNew<Reader> reader;
        reader->SetFileName((folder / "frames" / file).c_str());
        reader->Update();
        return reader->GetOutput();
    }

    static std::vector<std::string> arrays_of(vtkPointSet& data) {
        std::vector<std::string> names;
        for (int i = 0; i < data.GetPointData()->GetNumberOfArrays(); ++i)
            names.emplace_back(data.GetPointData()->GetArrayName(i));
        return names;
    }

    const TwoBlocks blocks;
};

TEST_F(FramesFolder, BodiesHoldTheirFieldsOnReferencePositions) {
    Frames frames(folder, {{"displacement", "stress", "von_mises", "reaction"}, {}, {}}, blocks.model);
    frames.write(blocks.snapshot(), 7);
    EXPECT_EQ(files_in(folder / "frames"), 2U) << "surfaces without fields have no files";
    const auto cap = read<vtkXMLUnstructuredGridReader>("cap_00007.vtu");
    ASSERT_EQ(cap->GetNumberOfPoints(), 12);
    EXPECT_EQ(cap->GetNumberOfCells(), 2);
    EXPECT_THAT(arrays_of(*cap), ElementsAre("displacement", "stress", "von_mises", "reaction"));
    for (int i = 0; i < 12; ++i) {
        const Vec3 point = Eigen::Map<const Vec3>(cap->GetPoint(i));
        EXPECT_EQ(point, blocks.model.X[12 + i]);
        EXPECT_EQ(Vec3(Eigen::Map<const Vec3>(cap->GetPointData()->GetArray("displacement")->GetTuple3(i))),
                  TwoBlocks::shift);
    }
    EXPECT_THAT(content(folder / "series.pvd"), HasSubstr("timestep=\"2.5\" group=\"\" part=\"1\" name=\"cap\" "
                                                          "file=\"frames/cap_00007.vtu\""));
}

TEST_F(FramesFolder, SurfacesHoldTheirFieldsAndWarpLikeBodies) {
    Frames frames(folder, {{}, {"gap", "status"}, {"contact_force"}}, blocks.model);
    frames.write(blocks.snapshot(), 0);
    EXPECT_EQ(files_in(folder / "frames"), 2U);
    const auto slave = read<vtkXMLPolyDataReader>("joint.slave_00000.vtp");
    const auto master = read<vtkXMLPolyDataReader>("joint.master_00000.vtp");
    EXPECT_THAT(arrays_of(*slave), ElementsAre("displacement", "gap", "status"));
    EXPECT_THAT(arrays_of(*master), ElementsAre("displacement", "contact_force"));
    ASSERT_EQ(slave->GetNumberOfCells(), 2);
    ASSERT_EQ(master->GetNumberOfCells(), 2);
    double bounds[6];
    slave->GetBounds(bounds); // the facets lie where the cap's underside was
    EXPECT_THAT(bounds, ElementsAre(0.5, 2.5, 0.25, 0.75, 1, 1));
    master->GetBounds(bounds);
    EXPECT_THAT(bounds, ElementsAre(0, 2, 0, 1, 1, 1));
    for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(slave->GetPointData()->GetArray("displacement")->GetComponent(i, 0), TwoBlocks::shift.x());
        EXPECT_EQ(master->GetPointData()->GetArray("displacement")->GetComponent(i, 0), 0);
    }
}

TEST_F(FramesFolder, ForgetsTheFramesOfBeforeAndRemovesNone) {
    Frames before(folder, {{"displacement"}, {"gap"}, {}}, blocks.model);
    before.write(blocks.snapshot(), 3);
    const std::vector<std::string> files = before.files(3);
    EXPECT_THAT(files, ElementsAre("frames/base_00003.vtu", "frames/cap_00003.vtu", "frames/joint.slave_00003.vtp"));
    const Frames after(folder, {{"displacement"}, {}, {}}, blocks.model);
    for (const std::string& file : files) EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    EXPECT_THAT(content(folder / "series.pvd"), Not(HasSubstr("DataSet ")));
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
