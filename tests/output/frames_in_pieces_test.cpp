/// Frames that several processes write together.

#include "osculate/output/frame_reader.hpp"
#include "osculate/output/frames.hpp"
#include "osculate/output/series_reader.hpp"
#include "osculate/output/vtk_pieces.hpp"
#include "output/temporary_folder.hpp"
#include "output/two_blocks.hpp"
#include "support/thread_ranks.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <set>
#include <tuple>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;
using testing::StartsWith;
using testing::Truly;

/// The base has four elements, the cap three; processes 0 and 2 have parts of the base, 1 and 2 of the cap.
class FramesInPieces : public InTemporaryFolder {
protected:
    FramesInPieces() {
        TwoBlocks::Refined refined;
        refined.base = {4, 1, 1};
        refined.cap = {3, 1, 1};
        blocks.emplace(refined);
        model::State& state = blocks->state;
        for (std::size_t i = 0; i < state.u.size(); ++i) { // stresses of all kinds
            const Vec3& X = blocks->model.X[static_cast<Index>(i)];
            state.u[i] += 1e-3 * Vec3(X.x() * X.y(), X.z() * X.x(), X.x() * X.x());
        }
        state.v = state.a = state.u; // and values that tell one node from another
        for (Vec3& a : state.a) a *= 7;
        for (std::size_t i = 0; i < state.u.size(); ++i) {
            reactions.emplace_back(static_cast<double>(i), 0.5, -1);
            rest.emplace_back(-3, static_cast<double>(i), 0.25);
            if (i % 3 == 0) audit.nodes.emplace_back(static_cast<Index>(i), 1e-3 * static_cast<double>(i + 1));
        }
        for (Index node = 0; node < blocks->model.nodes(); ++node) {
            const double x = blocks->model.X[node].x();
            owner.push_back(model::body_index(blocks->model, node) == 0 ? (x < 1 ? 0 : 2) : (x < 1.5 ? 1 : 2));
        }
    }
    void write(const FrameFields& fields, std::vector<std::string>* problems = nullptr) {
        support::on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
            const Share share(ranks, owner);
            Frames frames(folder, fields, blocks->model, false, {}, &share);
            if (ranks->rank() == 0) files = frames.files(4);
            try {
                frames.write(snapshot(), 4);
            } catch (const std::runtime_error& error) {
                if (problems != nullptr) (*problems)[static_cast<std::size_t>(ranks->rank())] = error.what();
            }
        });
    }
    [[nodiscard]] Snapshot snapshot() const {
        return {blocks->model, blocks->state, blocks->contact, reactions, rest, 0.5, &audit};
    }
    std::optional<TwoBlocks> blocks;
    std::vector<Vec3> reactions, rest;
    contact::AuditResult audit;
    std::vector<int> owner;
    std::vector<std::string> files;
    const FrameFields all{{"displacement", "stress", "strain", "energy_density", "contact_status"}, {"gap"}, {}};
};

TEST_F(FramesInPieces, HoldTogetherWhatOneProcessWrites) {
    FrameFields every{{}, {"gap"}, {}};
    for (const OutputField& field : all_fields())
        if (field.where == FieldPlace::body) every.body.emplace_back(field.name);
    const auto same = Truly([](const std::tuple<double, double>& pair) {
        const auto [one, other] = pair;
        return one == other || (std::isnan(one) && std::isnan(other)); // without a partner
    });
    Frames whole(folder / "whole", every, blocks->model);
    whole.write(snapshot(), 4);
    write(every);
    for (const char* body : {"base", "cap"}) {
        const std::string name = std::string("frames/") + body + "_00004";
        const Frame expected = read_frame(folder / "whole" / (name + ".vtu")),
                    found = read_frame(folder / (name + ".pvtu"));
        EXPECT_EQ(found.time, expected.time);
        EXPECT_EQ(found.points, expected.points);
        ASSERT_EQ(found.arrays.size(), expected.arrays.size());
        for (std::size_t a = 0; a < found.arrays.size(); ++a) {
            EXPECT_EQ(found.arrays[a].name, expected.arrays[a].name);
            EXPECT_EQ(found.arrays[a].integer, expected.arrays[a].integer);
            EXPECT_THAT(found.arrays[a].values, Pointwise(same, expected.arrays[a].values)) << found.arrays[a].name;
        }
        const auto faces = [](const fs::path& path) {
            std::set<std::set<Index>> corners;
            for (const mesh::Facet& facet : read_facets(path)) corners.emplace(facet.begin(), facet.end());
            return corners;
        };
        EXPECT_EQ(faces(folder / (name + ".pvtu")), faces(folder / "whole" / (name + ".vtu")))
            << "without cuts between pieces";
    }
    EXPECT_EQ(content(folder / "frames/joint.slave_00004.vtp"), content(folder / "whole/frames/joint.slave_00004.vtp"));
}

TEST_F(FramesInPieces, AreListedByTheFirstProcess) {
    write(all);
    EXPECT_THAT(files,
                ElementsAre("frames/base_00004.pvtu", "frames/pieces/base_00004_0.vtu",
                            "frames/pieces/base_00004_2.vtu", "frames/cap_00004.pvtu", "frames/pieces/cap_00004_1.vtu",
                            "frames/pieces/cap_00004_2.vtu", "frames/joint.slave_00004.vtp"));
    for (const std::string& file : files) EXPECT_TRUE(fs::exists(folder / file)) << file;
    EXPECT_EQ(files_in(folder / "frames/pieces"), 4U);
    EXPECT_THAT(pieces_in(folder / "frames/cap_00004.pvtu"),
                ElementsAre(folder / "frames/pieces/cap_00004_1.vtu", folder / "frames/pieces/cap_00004_2.vtu"));
    EXPECT_TRUE(Frames::is_piece_of("frames/pieces/cap_00004_2.vtu", "frames/cap_00004.pvtu"));
    for (const char* other : {"frames/pieces/cap_00005_2.vtu", "frames/pieces/cap_00004_1_00004_0.vtu",
                              "frames/pieces/base_00004_2.vtu", "frames/cap_00004.pvtu"})
        EXPECT_FALSE(Frames::is_piece_of(other, "frames/cap_00004.pvtu")) << other;
    EXPECT_FALSE(Frames::is_piece_of("frames/pieces/cap_00004_2.vtu", "frames/cap_00004.vtu"));
    EXPECT_THAT(content(folder / "frames/cap_00004.pvtu"),
                AllOf(HasSubstr("ComponentName5=\"XZ\""), HasSubstr("location=\"vtkDataArray\">Pa<")));
    std::vector<std::string> listed;
    for (const SeriesEntry& entry : read_series(folder / "series.pvd")) listed.push_back(entry.file);
    EXPECT_THAT(listed, ElementsAre("frames/base_00004.pvtu", "frames/cap_00004.pvtu", "frames/joint.slave_00004.vtp"));
    EXPECT_EQ(last_frame(folder, "cap"), folder / "frames/cap_00004.pvtu");
}

TEST_F(FramesInPieces, EndAllProcessesWithTheReasonOfTheOneThatFails) {
    fs::create_directories(folder / "frames/pieces/cap_00004_1.vtu/in_the_way");
    std::vector<std::string> problems(3);
    write(all, &problems);
    for (const std::string& problem : problems) {
        EXPECT_THAT(problem, StartsWith("process 1: "));
        EXPECT_THAT(problem, HasSubstr("cap_00004_1.vtu"));
    }
    EXPECT_TRUE(read_series(folder / "series.pvd").empty());
    EXPECT_FALSE(fs::exists(folder / "frames/cap_00004.pvtu"));
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
