#include "osculate/report/moving_surfaces.hpp"

#include "osculate/output/frames.hpp"
#include "osculate/output/series_reader.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"

#include <gmock/gmock.h>

namespace osculate::report::OSCULATE_THIS_FILE {
namespace {

using output::content;
using output::TwoBlocks;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MovingSurfaces : public output::InTemporaryFolder {
protected:
    /// Frames at 0, 1, ... s, in which the cap has moved by so many shifts.
    void write(int frames) {
        output::Frames files(folder, {{"displacement", "von_mises"}, {"gap", "contact_force"}, {}}, blocks.model);
        for (int f = 0; f < frames; ++f) {
            blocks.state.time = f;
            for (Index i = 0; i < blocks.model.bodies[1].nodes(); ++i)
                blocks.state.u[blocks.model.bodies[1].first_node + i] = f * TwoBlocks::shift;
            files.write(blocks.snapshot(), f);
        }
        files.finish();
    }
    TwoBlocks blocks;
};

TEST_F(MovingSurfaces, AreTheExteriorsOfTheBodiesAndTheContactSurfaces) {
    write(3);
    const report::MovingSurfaces all = read_moving_surfaces(folder, {});
    EXPECT_THAT(all.times, ElementsAre(0, 1, 2));
    EXPECT_THAT(all.notes, IsEmpty());
    ASSERT_EQ(all.parts.size(), 3U);
    const MovingPart& base = all.parts[0];
    EXPECT_EQ(base.name, "base");
    EXPECT_EQ(base.kind, PartKind::body);
    EXPECT_EQ(base.facets.size(), 10U); // of two cubes side by side
    EXPECT_EQ(base.points.size(), 12U);
    for (const auto& facet : base.facets)
        for (const std::uint32_t corner : facet) EXPECT_LT(corner, 12U);
    EXPECT_EQ(all.parts[2].kind, PartKind::slave);
    EXPECT_EQ(all.parts[2].name, "joint");
    EXPECT_EQ(all.parts[2].points.size(), 6U);
    EXPECT_EQ(all.parts[2].find("gap")->unit, "m");
    const PartField& u = *all.parts[1].find("displacement");
    ASSERT_EQ(u.values.frames.size(), 3U);
    EXPECT_FLOAT_EQ(u.values.frames[2][0], 0.04F);
    EXPECT_FLOAT_EQ(u.values.frames[2][5], -0.02F);
}

TEST_F(MovingSurfaces, TooManyFramesAreThinnedOutEvenlyAndSaidSo) {
    write(11);
    report::MovingSurfaces all = read_moving_surfaces(folder, {.frames = 6});
    EXPECT_THAT(all.times, ElementsAre(0, 2, 4, 6, 8, 10));
    EXPECT_THAT(all.notes, ElementsAre(HasSubstr("6 of 11 frames")));
    thin_out(all, 2);
    EXPECT_THAT(all.times, ElementsAre(0, 10));
    EXPECT_FLOAT_EQ(all.parts[1].find("displacement")->values.frames[1][0], 0.2F);
    EXPECT_THAT(read_moving_surfaces(folder, {.values = 1}).times, ElementsAre(0, 10));
}

TEST_F(MovingSurfaces, OfARunWithoutFramesAreNoneAndSayWhy) {
    const report::MovingSurfaces none = read_moving_surfaces(folder, {});
    EXPECT_THAT(none.times, IsEmpty());
    EXPECT_THAT(none.notes, ElementsAre(HasSubstr("wrote no frames")));
}

TEST_F(MovingSurfaces, OfADamagedFrameAreNoneAndNameIt) {
    write(3);
    std::ofstream(folder / "frames/cap_00001.vtu") << "<nothing/>";
    const report::MovingSurfaces none = read_moving_surfaces(folder, {});
    EXPECT_THAT(none.parts, IsEmpty());
    EXPECT_THAT(none.notes, ElementsAre(HasSubstr("cap_00001.vtu")));
}

TEST_F(MovingSurfaces, AFrameThatIsNotWholeIsLeftOut) {
    write(3);
    std::string series = content(folder / "series.pvd");
    const std::size_t last = series.rfind("<DataSet");
    series.erase(last, series.find('\n', last) - last);
    std::ofstream(folder / "series.pvd") << series;
    EXPECT_THAT(read_moving_surfaces(folder, {}).times, ElementsAre(0, 1));
}

TEST_F(MovingSurfaces, ASeriesComesBackAsItWasWritten) {
    write(2);
    const std::vector<output::SeriesEntry> entries = output::read_series(folder / "series.pvd");
    ASSERT_EQ(entries.size(), 6U);
    EXPECT_EQ(entries[3].time, 1);
    EXPECT_EQ(entries[5].part, "joint.slave");
    EXPECT_EQ(entries[5].file, "frames/joint.slave_00001.vtp");
    std::ofstream(folder / "series.pvd") << "<VTKFile>";
    EXPECT_THROW((void)output::read_series(folder / "series.pvd"), std::runtime_error);
}

} // namespace
} // namespace osculate::report::OSCULATE_THIS_FILE
