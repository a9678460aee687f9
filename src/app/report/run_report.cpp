#include "osculate/app/run_report.hpp"

#include "app/report/run_page.hpp"
#include "app/report/run_report_plots.hpp"
#include "osculate/app/diary.hpp"
#include "osculate/app/version.hpp"
#include "osculate/core/error.hpp"
#include "osculate/report/page.hpp"

#include <fstream>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

/// Whole or not at all: the file of before stays until its place is taken.
void write_whole(const fs::path& path, const std::string& content) {
    const fs::path aside = path.string() + ".part";
    {
        std::ofstream file(aside, std::ios::binary);
        file << content;
        file.close();
        if (!file) {
            std::error_code none;
            fs::remove(aside, none);
            throw std::runtime_error("cannot write " + path.string());
        }
    }
    fs::rename(aside, path);
}

report::PageOptions options_for(const fs::path& folder) {
    report::PageOptions options;
    options.version = version;
    options.libraries = {{"SUNDIALS", OSCULATE_SUNDIALS}, {"VTK", OSCULATE_VTK}, {"Eigen", OSCULATE_EIGEN}};
    try {
        options.attempts = attempts_so_far(folder);
        options.diary = summary_of(options.attempts);
    } catch (const SceneError& error) {
        options.notes.push_back("The diary is left out: " + error.faults().front().message() + ".");
    }
    return options;
}

} // namespace

void check_run_folder(const fs::path& folder) {
    Fault fault;
    fault.file = folder.string();
    fault.expected = "the folder of a run";
    std::error_code none;
    if (!fs::is_directory(folder, none))
        fault.found = fs::exists(folder, none) ? "a file" : "nothing of that name";
    else if (!fs::exists(folder / "summary.json") && !fs::exists(folder / "scene.yaml")) {
        fault.expected += ", which holds summary.json and scene.yaml";
        fault.found = "neither of them in it";
    } else
        return;
    throw SceneError({fault});
}

report::Page live_page(const fs::path& run_folder, const report::LiveOptions& live) {
    report::PageOptions options = options_for(run_folder);
    options.live = live;
    return report::make_page(run_folder, options);
}

WrittenReport write_report(const fs::path& run_folder) {
    check_run_folder(run_folder);
    try {
        output::OutputFolder run(run_folder, output::OutputFolder::Entry::beside);
        return write_report(run);
    } catch (const RunFailure& error) {
        throw ReportFailure(std::string("the report cannot be written: ") + error.what());
    }
}

WrittenReport write_report(output::OutputFolder& run) {
    const fs::path& run_folder = run.path();
    try {
        report::Page page = report::make_page(run_folder, options_for(run_folder));
        const fs::path beside = run_folder / "report";
        fs::create_directories(beside);
        for (const auto& [name, content] : page.pictures) write_whole(run.path_of("report/" + name), content);
        if (std::string plots = write_report_plots(run); !plots.empty()) page.notes.push_back(std::move(plots));
        const fs::path path = run.path_of("report.html");
        write_whole(path, page.html);
        return {path, std::move(page.notes)};
    } catch (const SceneError&) {
        throw;
    } catch (const std::runtime_error& error) { // fs::filesystem_error among them
        throw ReportFailure(std::string("the report cannot be written: ") + error.what());
    }
}

} // namespace osculate::app
