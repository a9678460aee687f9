#include "app/report/film.hpp"

#include "app/fault.hpp"
#include "app/report/external_program.hpp"
#include "app/report/gnuplot.hpp"
#include "app/report/run_page.hpp"
#include "osculate/app/run_report.hpp"
#include "osculate/core/error.hpp"
#include "osculate/output/output_folder.hpp"
#include "osculate/report/picture.hpp"
#include "osculate/scene/nearest.hpp"
#include "osculate/scene/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>

namespace osculate::app {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_frames = 240;  ///< drawn; more would not be seen apart
constexpr int width = 1200, height = 750; ///< of the bodies, pixels
constexpr int full_width = 1280, full_height = 860;

/// A folder that is gone in the end.
class Scratch {
public:
    Scratch() {
        std::string name = (fs::temp_directory_path() / "osculate_film_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw ReportFailure("no temporary folder " + name);
        path_ = name;
    }
    ~Scratch() {
        std::error_code none;
        fs::remove_all(path_, none);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

/// The field that was asked for, or that of the report.
report::ShownField chosen_field(const report::MovingSurfaces& surfaces, const std::string& name) {
    if (name.empty()) return report::field_to_show(surfaces);
    std::vector<std::string> known;
    for (const report::MovingPart& part : surfaces.parts)
        for (const report::PartField& field : part.fields)
            if (part.kind == report::PartKind::body && std::ranges::count(known, field.name) == 0)
                known.push_back(field.name);
    if (std::ranges::count(known, name) == 0) {
        Fault unknown =
            fault("--field", fmt::format("a field of the bodies: {}", fmt::join(known, ", ")), "'" + name + "'");
        unknown.nearest = scene::nearest(name, known);
        throw SceneError({unknown});
    }
    return report::shown_field(surfaces, name);
}

std::string frame_name(std::size_t frame) {
    return fmt::format("bodies_{:04}.png", frame);
}

/// What gnuplot makes of the pictures of the bodies: time and legend around them.
std::string frames_script(const report::MovingSurfaces& surfaces, const report::ShownField& field,
                          const std::string& title) {
    std::string text = fmt::format("set terminal pngcairo size {},{} font 'sans,14' background 'white'\nunset "
                                   "border\nunset tics\nset xrange [0:{}]\n"
                                   "set yrange [0:{}]\nset lmargin 2\nset rmargin {}\n",
                                   full_width, full_height, width, height, field.name.empty() ? 2 : 12);
    std::string palette;
    const auto& map = report::colour_map();
    for (std::size_t i = 0; i < map.size(); ++i)
        palette += fmt::format("{}{} '#{:02x}{:02x}{:02x}'", i == 0 ? "" : ", ", i, map[i][0], map[i][1], map[i][2]);
    if (!field.name.empty()) {
        // "1.53 MPa" of the largest value says by what the legend's numbers are divided
        const double largest = std::max(std::abs(field.low), std::abs(field.high));
        const std::string words = scene::engineering(largest, field.unit);
        const std::size_t blank = words.find(' ');
        const std::string unit = blank == std::string::npos ? field.unit : words.substr(blank + 1);
        const double factor = blank == std::string::npos ? 1 : std::stod(words) / largest;
        std::string label = field.name;
        std::ranges::replace(label, '_', ' ');
        text += fmt::format("set palette defined ({})\nset cbrange [{:.9g}:{:.9g}]\nset cbtics\nset format cb '%g'\n"
                            "set cblabel {} noenhanced\n",
                            palette, factor * field.low, factor * field.high,
                            gnuplot_text(unit.empty() ? label : label + ", " + unit));
    }
    for (std::size_t f = 0; f < surfaces.times.size(); ++f) {
        const std::string time = scene::engineering(std::stod(fmt::format("{:.4g}", surfaces.times[f])), "s");
        text += fmt::format("set output 'frame_{:04}.png'\nset title {} noenhanced\nplot '{}' binary filetype=png with "
                            "rgbalpha notitle{}\n",
                            f, gnuplot_text(title + ", " + time), frame_name(f),
                            field.name.empty() ? "" : ", NaN with points palette notitle");
    }
    return text;
}

/// Every frame for its share of the run's time; the last one for a while.
std::string list_of_frames(const std::vector<double>& times, double seconds) {
    constexpr double shortest = 0.02, last = 0.6; // s
    const double all = times.back() - times.front();
    std::string text = "ffconcat version 1.0\n";
    for (std::size_t f = 0; f < times.size(); ++f) {
        const bool ends = f + 1 == times.size();
        const double share = ends || !(all > 0) ? 0 : (times[f + 1] - times[f]) / all;
        text += fmt::format("file frame_{:04}.png\nduration {:.6g}\n", f,
                            ends ? last : std::max(shortest, share * seconds));
    }
    return text + fmt::format("file frame_{:04}.png\n", times.size() - 1); // ffmpeg forgets the last duration otherwise
}

std::vector<std::string> encoder(bool gif, const std::string& file) {
    std::vector<std::string> words{"ffmpeg", "-nostdin", "-loglevel", "error",     "-y",
                                   "-f",     "concat",   "-i",        "frames.txt"};
    const std::vector<std::string> rest =
        gif ? std::vector<
                  std::string>{"-vf", "fps=15,scale=960:-1:flags=lanczos,split[a][b];[a]palettegen[p];[b][p]paletteuse",
                               "-loop", "0", file}
            : std::vector<std::string>{"-vf",      "fps=30",  "-c:v",      "libx264",    "-crf", "20",
                                       "-pix_fmt", "yuv420p", "-movflags", "+faststart", file};
    words.insert(words.end(), rest.begin(), rest.end());
    return words;
}

void write(const fs::path& path, std::string_view content) {
    std::ofstream file(path, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!file.flush()) throw ReportFailure("cannot write " + path.string());
}

void need(External result, const char* program, const char* package) {
    if (result == External::missing)
        throw ReportFailure(fmt::format("{} is not installed; a film needs it (Debian: {})", program, package));
    if (result == External::failed) throw ReportFailure(fmt::format("{} failed", program));
}

/// Where the film goes: a file of the user's, or one of the run, which a new run removes.
fs::path destination(const FilmCommand& command, const std::string& ending) {
    if (!command.file.empty()) return fs::absolute(command.file);
    output::OutputFolder run(command.folder, output::OutputFolder::Entry::beside);
    return fs::absolute(run.path_of("film" + ending));
}

} // namespace

std::string write_film(const FilmCommand& command) {
    check_run_folder(command.folder);
    const std::string ending = command.file.empty() ? ".mp4" : fs::path(command.file).extension().string();
    if (ending != ".mp4" && ending != ".gif")
        throw SceneError({fault("film", "a file that ends with .mp4 or .gif", "'" + command.file + "'")});
    report::MovingSurfaces surfaces = report::read_moving_surfaces(command.folder, {.frames = most_frames});
    if (surfaces.times.empty())
        throw SceneError(
            {fault("film", "a run with frames", surfaces.notes.empty() ? "none" : surfaces.notes.front())});
    report::PictureOptions options;
    options.width = width;
    options.height = height;
    options.field = chosen_field(surfaces, command.field);
    const Scratch scratch;
    for (std::size_t f = 0; f < surfaces.times.size(); ++f) {
        const report::Bytes png = report::draw(surfaces, f, options);
        if (png.empty())
            throw SceneError({fault("film", "frames with displacements of the bodies", "none (output.body_fields)")});
        write(scratch.path() / frame_name(f), {reinterpret_cast<const char*>(png.data()), png.size()});
    }
    const std::string title = fs::absolute(command.folder).lexically_normal().filename().string();
    write(scratch.path() / "frames.gp", frames_script(surfaces, options.field, title));
    write(scratch.path() / "frames.txt", list_of_frames(surfaces.times, command.seconds));
    need(run_external(scratch.path(), {"gnuplot", "frames.gp"}, true), "gnuplot", "gnuplot-nox");
    const std::string film = "film" + ending;
    need(run_external(scratch.path(), encoder(ending == ".gif", film)), "ffmpeg", "ffmpeg");
    const fs::path to = destination(command, ending);
    std::error_code failed;
    fs::copy_file(scratch.path() / film, to, fs::copy_options::overwrite_existing, failed);
    if (failed) throw ReportFailure("cannot write " + to.string() + ": " + failed.message());
    constexpr double mega = 1e6;
    std::string text = fmt::format("{}: {} frames, {:.1f} MB\n", to.string(), surfaces.times.size(),
                                   static_cast<double>(fs::file_size(to)) / mega);
    for (const std::string& note : surfaces.notes) text += "  " + note + "\n";
    return text;
}

} // namespace osculate::app
