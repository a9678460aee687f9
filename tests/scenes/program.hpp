#pragma once
/// Runs the program as a user would, in a folder of its own, and reads what it leaves there.

#include "osculate/app/command_line.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace osculate::scenes {

inline std::string content(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// Path of a scene of the repository.
inline std::string scene_file(const std::string& relative) {
    return (std::filesystem::path(support::source_tree()) / relative).string();
}

/// A CSV file of this program, whose tests hold no quoted fields.
struct Csv {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;

    explicit Csv(const std::filesystem::path& path) {
        std::ifstream file(path);
        std::string line;
        while (std::getline(file, line)) {
            std::vector<std::string> cells(1);
            for (const char c : line) {
                if (c == ',')
                    cells.emplace_back();
                else
                    cells.back() += c;
            }
            (columns.empty() ? columns : rows.emplace_back()) = cells;
        }
    }
    [[nodiscard]] std::string text(std::size_t row, const std::string& column) const {
        const auto at = std::ranges::find(columns, column);
        if (at == columns.end()) throw std::out_of_range("no column " + column);
        return rows.at(row).at(static_cast<std::size_t>(at - columns.begin()));
    }
    [[nodiscard]] double number(std::size_t row, const std::string& column) const {
        return std::stod(text(row, column));
    }
};

struct Outcome {
    int code = -1; ///< of the exit; -1 when the program ended otherwise
    std::string out, err;
};

class Program : public testing::Test {
protected:
    Program() {
        std::string name = (std::filesystem::temp_directory_path() / "osculate_scenes_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        folder = name;
    }
    /// Starts a program of its own in `folder`, whose words go to out.txt and err.txt there.
    [[nodiscard]] pid_t start(std::vector<std::string> words) const {
        words.insert(words.begin(), "osculate");
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            std::filesystem::current_path(folder);
            for (const auto& [file, to] : {std::pair{"out.txt", STDOUT_FILENO}, std::pair{"err.txt", STDERR_FILENO}})
                dup2(open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600), to);
            execv(OSCULATE_PROGRAM, argv.data());
            _exit(127);
        }
        return child;
    }
    ~Program() override { std::filesystem::remove_all(folder); }

    /// Runs the program in a process of its own, whose current folder is `folder`.
    /// @param before  called in that process first
    Outcome osculate(std::vector<std::string> arguments, const std::function<void()>& before = {}) const {
        arguments.insert(arguments.begin(), "osculate");
        std::fflush(nullptr);
        const pid_t child = fork();
        if (child == 0) {
            std::filesystem::current_path(folder);
            redirect("stdout.txt", STDOUT_FILENO);
            redirect("stderr.txt", STDERR_FILENO);
            if (before) before();
            std::vector<char*> argv;
            for (std::string& argument : arguments) argv.push_back(argument.data());
            argv.push_back(nullptr);
            std::exit(app::command_line(static_cast<int>(arguments.size()), argv.data()));
        }
        int status = 0;
        waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "stdout.txt"),
                content(folder / "stderr.txt")};
    }

    /// Runs a scene into `folder`/run and expects it to end well.
    std::filesystem::path run(const std::string& scene, const std::vector<std::string>& changes = {}) const {
        std::vector<std::string> arguments{"run", scene, "-o", "run", "--quiet"};
        for (const std::string& change : changes) arguments.insert(arguments.end(), {"--set", change});
        const Outcome outcome = osculate(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return folder / "run";
    }

    std::filesystem::path folder;

private:
    static void redirect(const char* file, int descriptor) {
        const int opened = open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(opened, descriptor);
        close(opened);
    }
};

} // namespace osculate::scenes
