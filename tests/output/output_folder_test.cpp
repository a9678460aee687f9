/// Which folders Osculate goes into, and what it removes there: what its manifest lists, and nothing else.

#include "osculate/core/error.hpp"
#include "osculate/output/output_folder.hpp"
#include "temporary_folder.hpp"

#include <functional>
#include <gmock/gmock.h>
#include <optional>
#include <set>
#include <sys/wait.h>
#include <unistd.h>

namespace osculate::output::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Entry = OutputFolder::Entry;

class Folder : public InTemporaryFolder {
protected:
    static void write(const fs::path& path, const std::string& text = "text") {
        fs::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
    }
    /// What the folder holds, manifests left out.
    [[nodiscard]] std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().filename() != OutputFolder::manifest && !entry.is_directory())
                names.insert(fs::relative(entry.path(), folder).string());
        return names;
    }
    /// A run that writes these.
    void run(const std::vector<std::string>& names, Entry entry = Entry::careful) const {
        OutputFolder out(folder, entry, names);
        out.remove_all_but({});
        for (const std::string& name : names) write(out.path_of(name));
    }
    /// Why it does not go in; empty: it does.
    [[nodiscard]] std::string refusal(Entry entry = Entry::careful, const std::vector<std::string>& wanted = {}) const {
        try {
            const OutputFolder out(folder, entry, wanted);
        } catch (const SceneError& error) {
            return error.what();
        }
        return {};
    }
};

TEST_F(Folder, GoesIntoOneThatIsAbsentOrEmptyOrItsOwn) {
    EXPECT_EQ(refusal(), "") << "empty";
    EXPECT_EQ(refusal(), "") << "its own";
    fs::remove_all(folder);
    EXPECT_EQ(refusal(), "") << "absent";
    folder /= "deep/er";
    EXPECT_EQ(refusal(), "") << "below one that is absent";
    EXPECT_TRUE(OutputFolder::has_manifest(folder));
}

TEST_F(Folder, RefusesOthersAndNamesWhatIsThereAndTheWaysOut) {
    for (const char* name : {"a.csv", "b.csv", "c.csv", "d.csv", "e.csv", "sub/f.csv"}) write(folder / name);
    EXPECT_THAT(refusal(),
                AllOf(HasSubstr(folder.string() + ": expected a folder that is absent, is empty or holds the "
                                                  "osculate_manifest.txt of an earlier run"),
                      HasSubstr("found 'a.csv', 'b.csv', 'c.csv', 'd.csv' and 2 more"), HasSubstr("--force"),
                      HasSubstr("--new takes " + folder.string() + "-2")));
    EXPECT_EQ(files().size(), 6U);
    EXPECT_FALSE(fs::exists(folder / OutputFolder::manifest)) << "nothing is left in a folder that is refused";
}

TEST_F(Folder, AFileThatOnlyHasTheManifestsNameIsAStranger) {
    write(folder / OutputFolder::manifest, "my own list\nprecious.txt\n");
    write(folder / "precious.txt");
    EXPECT_THAT(refusal(), HasSubstr("found 'osculate_manifest.txt', 'precious.txt'"));
}

TEST_F(Folder, FoldersOfOtherRunsAreNoStrangers) {
    { const OutputFolder below(folder / "runs" / "surface", Entry::careful); }
    EXPECT_EQ(refusal(), "");
}

TEST_F(Folder, RemovesWhatItListsAndNothingElse) {
    run({"history.csv", "frames/a_00000.vtu", "frames/a_00001.vtu", "plots/force.csv"});
    write(folder / "frames" / "a_00001.vtu.part"); // of a process that was killed
    for (const char* mine : {"notes.txt", "frames/a_00002.vtu", "frames/mine.vtu", "plots/mine.csv", "checkpoint/mine"})
        write(folder / mine);
    run({"history.csv", "steps.csv"});
    EXPECT_THAT(files(), ElementsAre("checkpoint/mine", "frames/a_00002.vtu", "frames/mine.vtu", "history.csv",
                                     "notes.txt", "plots/mine.csv", "steps.csv"));
    fs::remove(folder / "plots/mine.csv");
    run({"plots/force.csv"});
    run({"history.csv"});
    EXPECT_FALSE(fs::exists(folder / "plots")) << "folders that are empty go, too";
}

TEST_F(Folder, KeepsWhatIsToStay) {
    run({"history.csv", "frames/a_00000.vtu", "frames/a_00001.vtu"});
    write(folder / "frames" / "a_00000.vtu.part");
    OutputFolder out(folder, Entry::careful);
    out.remove_all_but({"history.csv", "frames/a_00000.vtu", "never.written"});
    EXPECT_THAT(files(), ElementsAre("frames/a_00000.vtu", "history.csv"));
    EXPECT_THAT(out.files(), ElementsAre("frames/a_00000.vtu", "history.csv"));
}

TEST_F(Folder, RefusesToOverwriteWhatItDidNotWrite) {
    run({"history.csv"});
    write(folder / "steps.csv", "mine");
    write(folder / "frames" / "a_00012.vtu", "mine");
    write(folder / "frames" / "a_b.vtu", "mine");
    EXPECT_THAT(refusal(Entry::careful, {"history.csv", "steps.csv", "frames/a_*.vtu"}),
                HasSubstr("found 'frames/a_00012.vtu', 'steps.csv'; "));
    EXPECT_EQ(refusal(Entry::careful, {"history.csv", "frames/b_*.vtu"}), "");
    OutputFolder out(folder, Entry::careful);
    EXPECT_THROW(out.claim({"steps.csv"}), RunFailure) << "as it may come there later";
    EXPECT_EQ(content(folder / "steps.csv"), "mine");
}

TEST_F(Folder, APatternHasAsManyNumbersAsStars) {
    run({"history.csv"});
    write(folder / "frames/pieces/a_00003_12.vtu", "mine");
    EXPECT_THAT(refusal(Entry::careful, {"frames/pieces/a_*_*.vtu"}), HasSubstr("a_00003_12.vtu"));
    for (const char* other : {"frames/pieces/a_*.vtu", "frames/pieces/a_*_*_*.vtu", "frames/pieces/b_*_*.vtu"})
        EXPECT_EQ(refusal(Entry::careful, {"history.csv", other}), "") << other;
}

TEST_F(Folder, ForcedOverwritesAndDeletesNothing) {
    for (const char* mine : {"history.csv", "notes.txt", "frames/a_00000.vtu", "frames/a_00001.vtu"})
        write(folder / mine, "mine");
    run({"history.csv", "frames/a_00000.vtu"}, Entry::force);
    EXPECT_EQ(content(folder / "history.csv"), "text");
    for (const char* mine : {"notes.txt", "frames/a_00001.vtu"}) EXPECT_EQ(content(folder / mine), "mine");
    run({});
    EXPECT_THAT(files(), ElementsAre("frames/a_00001.vtu", "notes.txt"))
        << "what was overwritten is its own since then";
}

TEST_F(Folder, ForcedNeverWritesThroughALinkOfSomeone) {
    const fs::path elsewhere = folder / "elsewhere.csv", there = folder / "there";
    write(elsewhere, "precious");
    fs::create_directories(there);
    fs::create_symlink(elsewhere, there / "history.csv");
    OutputFolder out(there, Entry::force, {"history.csv"});
    EXPECT_THROW(out.claim({"history.csv"}), RunFailure);
}

TEST_F(Folder, NoPathLeadsOutOfIt) {
    const fs::path inside = folder / "in";
    fs::create_directories(inside);
    write(folder / "precious");
    for (const std::string& path :
         {std::string("../precious"), (folder / "precious").string(), std::string("frames/../../precious"),
          std::string("./../precious"), std::string("frames/"), std::string("osculate_manifest.txt"), std::string(),
          std::string("a\x1b[2J")}) {
        write(inside / OutputFolder::manifest, "osculate manifest 1, process 7\nhistory.csv\n" + path + "\n");
        write(inside / "history.csv");
        std::string said;
        for (const Entry entry : {Entry::careful, Entry::force, Entry::beside})
            EXPECT_THROW(
                try { OutputFolder(inside, entry).remove_all_but({}); } catch (const SceneError& error) {
                    said = error.what();
                    throw;
                },
                SceneError)
                << path;
        EXPECT_THAT(said, AllOf(HasSubstr("osculate_manifest.txt:3:1: expected the path of a file inside the folder"),
                                Not(HasSubstr("\x1b"))));
        EXPECT_TRUE(fs::exists(folder / "precious"));
        EXPECT_TRUE(fs::exists(inside / "history.csv")) << "all of the manifest is looked at first";
    }
}

TEST_F(Folder, RemovesNothingBehindALink) {
    const fs::path inside = folder / "in", outside = folder / "out";
    write(outside / "a_00000.vtu", "precious");
    fs::create_directories(inside);
    fs::create_directory_symlink(outside, inside / "frames");
    write(inside / "history.csv");
    write(inside / OutputFolder::manifest, "osculate manifest 1, process 7\nframes/a_00000.vtu\nhistory.csv\n");
    try {
        OutputFolder(inside, Entry::careful).remove_all_but({});
        FAIL() << "it went through the link";
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("in/frames: expected a folder, as the files in it are to be removed, found a "
                              "symbolic link"));
    }
    EXPECT_EQ(content(outside / "a_00000.vtu"), "precious");
    EXPECT_TRUE(fs::exists(inside / "history.csv")) << "nothing is removed before all is looked at";
}

TEST_F(Folder, AListedLinkOrFolderTakesNothingWithIt) {
    const fs::path precious = folder / "precious", inside = folder / "in";
    write(precious);
    fs::create_directories(inside / "history.csv");
    write(inside / "history.csv" / "mine");
    fs::create_symlink(precious, inside / "steps.csv");
    write(inside / OutputFolder::manifest, "osculate manifest 1, process 7\nhistory.csv\nsteps.csv\n");
    OutputFolder(inside, Entry::careful).remove_all_but({});
    EXPECT_TRUE(fs::exists(precious));
    EXPECT_TRUE(fs::exists(inside / "history.csv" / "mine"));
    EXPECT_FALSE(fs::is_symlink(inside / "steps.csv")) << "the link itself was listed";
}

TEST_F(Folder, ListsAFileBeforeItIsThereAndForgetsHalfALine) {
    {
        OutputFolder out(folder, Entry::careful);
        out.claim({"history.csv"});
        out.claim({"frames/a_00000.vtu", "history.csv"});
        EXPECT_THAT(content(folder / OutputFolder::manifest), testing::EndsWith("\nhistory.csv\nframes/a_00000.vtu\n"));
    }
    std::ofstream(folder / OutputFolder::manifest, std::ios::app) << "frames/a_00"; // killed as it wrote
    OutputFolder out(folder, Entry::careful);
    EXPECT_THAT(out.files(), ElementsAre("frames/a_00000.vtu", "history.csv"));
    out.claim({"steps.csv"});
    EXPECT_THAT(content(folder / OutputFolder::manifest), HasSubstr("\nhistory.csv\nsteps.csv\n"));
}

TEST_F(Folder, AFullDiskSpoilsNoLineOfTheManifest) {
    OutputFolder out(folder, Entry::careful);
    out.claim({"history.csv"});
    const std::string before = content(folder / OutputFolder::manifest);
    {
        const FullDisk disk(before.size() + 5);
        EXPECT_THROW(out.claim({"frames/a_00000.vtu"}), RunFailure);
    }
    EXPECT_EQ(content(folder / OutputFolder::manifest), before);
}

TEST_F(Folder, HasOneProcessInIt) {
    std::optional<OutputFolder> first(std::in_place, folder, Entry::careful);
    for (const Entry entry : {Entry::careful, Entry::force, Entry::adopt})
        EXPECT_THAT(refusal(entry), HasSubstr("process " + std::to_string(getpid()) + " at work in it"));
    first->remove_all_but({}); // writes the manifest anew
    EXPECT_NE(refusal(), "");
    EXPECT_EQ(refusal(Entry::beside), "") << "a report of a run that is going on";
    first.reset();
    EXPECT_EQ(refusal(), "");
}

TEST_F(Folder, AKilledProcessLeavesNoLock) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t child = fork();
    if (child == 0) {
        const OutputFolder out(folder, Entry::careful);
        (void)!::write(ready[1], "r", 1);
        pause();
        _exit(0);
    }
    char byte = 0;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_THAT(refusal(), HasSubstr("process " + std::to_string(child)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(refusal(), "");
    close(ready[0]);
    close(ready[1]);
}

TEST_F(Folder, ALaterReportIsListedForTheRunThatIsGoingOn) {
    OutputFolder going_on(folder, Entry::careful);
    write(OutputFolder(folder, Entry::beside).path_of("report.html"));
    EXPECT_NO_THROW(going_on.claim({"report.html"}));
    write(OutputFolder(folder, Entry::beside).path_of("report/start.png"));
    going_on.remove_all_but({});
    EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Folder, OfAVersionWithoutManifestsIsAdoptedByItsRun) {
    for (const char* name : {"scene.yaml", "frames/a_00000.vtu", "frames/a_00007.vtu", "notes.txt", "frames/mine.vtu"})
        write(folder / name);
    const std::vector<std::string> wanted{"scene.yaml", "frames/a_*.vtu"};
    {
        OutputFolder out(folder, Entry::adopt, wanted);
        out.remove_all_but({"scene.yaml", "frames/a_00000.vtu"});
    }
    EXPECT_THAT(files(), ElementsAre("frames/a_00000.vtu", "frames/mine.vtu", "notes.txt", "scene.yaml"));
    write(folder / "frames/a_00009.vtu");
    EXPECT_THAT(OutputFolder(folder, Entry::adopt, wanted).files(), ElementsAre("frames/a_00000.vtu", "scene.yaml"))
        << "once it has a manifest, that alone counts";
}

TEST_F(Folder, NumbersFolders) {
    const fs::path base = folder / "run";
    EXPECT_EQ(OutputFolder::numbered(base), base) << "absent";
    EXPECT_EQ(OutputFolder::numbered(base / ""), base) << "empty";
    write(base / "notes.txt");
    EXPECT_EQ(OutputFolder::numbered(base / ""), folder / "run-2");
    { const OutputFolder used(folder / "run-2", Entry::careful); }
    EXPECT_EQ(OutputFolder::numbered(base), folder / "run-3") << "that of an earlier run is not taken again";
    write(folder / "run-4");
    write(folder / "run-3/notes.txt");
    EXPECT_EQ(OutputFolder::numbered(base), folder / "run-5");
}

} // namespace
} // namespace osculate::output::OSCULATE_THIS_FILE
