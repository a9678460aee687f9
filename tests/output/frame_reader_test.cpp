#include "osculate/output/csv_reader.hpp"
#include "osculate/output/frame_reader.hpp"
#include "osculate/output/frames.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"

#include <cmath>
#include <fstream>
#include <gmock/gmock.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;

class FrameReader : public InTemporaryFolder {
protected:
    const TwoBlocks blocks;
};

TEST_F(FrameReader, GivesBackWhatWasWritten) {
    Frames frames(folder, {{"displacement", "stress"}, {"gap", "status", "area"}, {}}, blocks.model);
    frames.write(blocks.snapshot(), 12);
    const Frame slave = read_frame(folder / "frames/joint.slave_00012.vtp");
    EXPECT_EQ(slave.time, 2.5);
    const model::SlaveNodes& nodes = blocks.model.pairs[0]->slaves();
    ASSERT_EQ(slave.points.size(), nodes.node.size());
    for (std::size_t i = 0; i < slave.points.size(); ++i) EXPECT_EQ(slave.points[i], blocks.model.X[nodes.node[i]]);
    ASSERT_NE(slave.find("area"), nullptr);
    EXPECT_EQ(slave.find("area")->values, nodes.area);
    EXPECT_TRUE(slave.find("status")->integer);
    EXPECT_EQ(slave.find("stress"), nullptr);
    const Frame cap = read_frame(folder / "frames/cap_00012.vtu");
    EXPECT_EQ(cap.points.size(), 12U);
    EXPECT_EQ(cap.find("stress")->components, 6);
    EXPECT_EQ(cap.find("stress")->values, field(FieldPlace::body, "stress").values(blocks.snapshot(), 1));
}

TEST_F(FrameReader, TheLastFrameIsTheOneOfTheLargestNumber) {
    Frames frames(folder, {{"displacement"}, {"gap"}, {}}, blocks.model);
    frames.write(blocks.snapshot(), 0);
    EXPECT_FALSE(last_frame(folder, "cap")) << "the initial one tells nothing";
    for (const long number : {7, 123456, 99999}) frames.write(blocks.snapshot(), number);
    EXPECT_EQ(last_frame(folder, "cap")->filename(), "cap_123456.vtu");
    EXPECT_EQ(last_frame(folder, "joint.slave")->filename(), "joint.slave_123456.vtp");
    EXPECT_FALSE(last_frame(folder, "joint"));
    EXPECT_FALSE(last_frame(folder / "nowhere", "cap"));
}

TEST_F(FrameReader, NamesAFileThatIsNone) {
    EXPECT_THROW((void)read_frame(folder / "missing.vtp"), std::runtime_error);
}

TEST_F(FrameReader, ReadsTablesOfNumbers) {
    std::ofstream(folder / "t.csv") << "time,pair.a.x\n1,-2.5e-3\n2,\n3,4"; // the last line is being written
    const NumberTable table = read_numbers(folder / "t.csv");
    EXPECT_THAT(table.names, ElementsAre("time", "pair.a.x"));
    EXPECT_THAT(table.columns[0], ElementsAre(1, 2));
    EXPECT_EQ(table.columns[1][0], -2.5e-3);
    EXPECT_TRUE(std::isnan(table.columns[1][1]));
    std::ofstream(folder / "t.csv") << "a,b\n1\n";
    EXPECT_THROW((void)read_numbers(folder / "t.csv"), std::runtime_error);
    std::ofstream(folder / "t.csv") << "a\nx\n";
    EXPECT_THROW((void)read_numbers(folder / "t.csv"), std::runtime_error);
    EXPECT_THROW((void)read_numbers(folder / "missing.csv"), std::runtime_error);
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
