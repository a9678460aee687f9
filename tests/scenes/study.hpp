#pragma once
/// A small study, and `osculate study` run by the program itself: it starts itself anew.

#include "scenes/program.hpp"

#include <map>

namespace osculate::scenes {

namespace fs = std::filesystem;

inline const std::string press_yaml = scene_file("tests/scenes/press.yaml");

inline const std::string small_study = R"(title: Pressed and pulled
problem: A small one.
source: none
scene: )" + press_yaml + R"(
axes:
  friction: {key: contact.joint.friction, values: [0.1, 0.3]}
  mesh:
    coarse: {set: {bodies.cap.mesh.block.divisions: [2, 2, 1]}, parameters: {h: 0.5}}
    fine: {set: {bodies.cap.mesh.block.divisions: [4, 4, 2]}, parameters: {h: 0.25}}
quantities:
  weight:
    unit: N
    contact: joint
    value: sum(force_z)
    reference: 1e5
  pressure:
    contact: joint
    of: normal_stress
    exact: 1e5
    scale: 1e5
    area: true
  dragged:
    history: pair.joint.friction / pair.joint.normal
    reference: finest
    error: absolute
  cap:
    body: cap
    value: max(x - X - ux) + max(von_mises)
refine: mesh
)";

class StudyProgram : public Program {
protected:
    std::string write(const std::string& text) const {
        std::ofstream(folder / "small.yaml") << text;
        return (folder / "small.yaml").string();
    }

    Outcome study(std::vector<std::string> words) const {
        words.insert(words.begin(), "study");
        int status = 0;
        waitpid(start(words), &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out.txt"), content(folder / "err.txt")};
    }

    /// What every run of a study took, by its name: no two runs take the same time.
    std::map<std::string, std::string> seconds_of_runs(const fs::path& table) const {
        const Csv csv(table);
        std::map<std::string, std::string> seconds;
        for (std::size_t i = 0; i < csv.rows.size(); ++i)
            seconds[csv.rows[i][0] + csv.rows[i][1]] = csv.text(i, "wall_seconds");
        return seconds;
    }
};

/// The tests' reader of tables knows no quotes: names of runs hold a comma, so they take two cells.
inline Csv table_of(const fs::path& path) {
    Csv csv(path);
    csv.columns.insert(csv.columns.begin(), "id");
    return csv;
}

} // namespace osculate::scenes
