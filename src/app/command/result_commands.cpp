#include "app/command/result_commands.hpp"

#include "app/report/film.hpp"
#include "app/view/view_command.hpp"
#include "osculate/app/diary.hpp"
#include "osculate/app/run_report.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace osculate::app {

namespace {

void report_run(const std::string& folder) {
    const WrittenReport report = write_report(folder);
    constexpr double mega = 1e6;
    print(fmt::format("{} ({:.1f} MB); pictures and plots in {}\n", report.page.string(),
                      static_cast<double>(std::filesystem::file_size(report.page)) / mega,
                      (report.page.parent_path() / "report").string()));
    for (const std::string& note : report.notes) print("  " + note + "\n");
}

CLI::App* add(CLI::App& program, const char* name, const char* what, std::string& folder) {
    CLI::App* command = program.add_subcommand(name, what);
    command->add_option("DIR", folder, "Folder of the run's files")->required();
    return command;
}

} // namespace

void print(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stdout);
}

std::vector<Command> add_result_commands(CLI::App& program) {
    struct Arguments {
        std::string folder;
        ViewCommand view;
        FilmCommand film;
    };
    const auto arguments = std::make_shared<Arguments>(); // as long as the actions
    std::vector<Command> commands;
    commands.push_back(
        {add(program, "diary", "Show what happened to every attempted step of a run, and why", arguments->folder),
         [arguments] { print(diary(arguments->folder)); }});
    commands.push_back({add(program, "report", "Write report.html of a run: one file that shows it, to mail or to keep",
                            arguments->folder),
                        [arguments] { report_run(arguments->folder); }});

    CLI::App* view =
        add(program, "view", "Show a run in a browser on this machine while it goes on, with a button that ends it",
            arguments->view.folder);
    view->add_option("--port", arguments->view.port, "Port on 127.0.0.1 [any that is free]")
        ->type_name("N")
        ->check(CLI::Range(1, 65535));
    commands.push_back({view, [arguments] { app::view(arguments->view); }});

    CLI::App* film =
        add(program, "film", "Make a film of a run, MP4 or GIF (needs gnuplot and ffmpeg)", arguments->film.folder);
    film->add_option("-o,--output", arguments->film.file, "The film [DIR/film.mp4]")->type_name("FILE.mp4|FILE.gif");
    film->add_option("--field", arguments->film.field, "Field of the bodies [von_mises, else displacement]")
        ->type_name("NAME");
    film->add_option("--seconds", arguments->film.seconds, "Length of the film [8]")
        ->type_name("S")
        ->check(CLI::Range(0.5, 3600.0));
    commands.push_back({film, [arguments] { print(write_film(arguments->film)); }});
    return commands;
}

} // namespace osculate::app
