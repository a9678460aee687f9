#include "report/page_data.hpp"

#include "osculate/report/picture.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <type_traits>

namespace osculate::report {

using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_numbers = 2'000'000;      ///< of a table
constexpr std::size_t most_path_numbers = 2'000'000; ///< of all paths together, two bytes each
constexpr std::size_t most_rejected = 2000, most_accepted = 20000;

const char* name_of(PartKind kind) {
    return kind == PartKind::body ? "body" : kind == PartKind::slave ? "slave" : "master";
}

} // namespace

std::string PageData::add(const Bytes& bytes) {
    arrays_.push_back(base64(bytes));
    return fmt::format("array-{}", arrays_.size() - 1);
}

void PageData::add_table(const char* name, const output::NumberTable& table, std::vector<std::string>& notes) {
    const std::size_t rows = table.columns.front().size(), columns = table.columns.size();
    const std::size_t every = std::max<std::size_t>(1, (rows * columns + most_numbers - 1) / most_numbers);
    std::vector<float> values;
    std::size_t kept = 0;
    for (const std::vector<double>& column : table.columns) {
        kept = 0;
        for (std::size_t r = 0; r < rows; ++r)
            if (r % every == 0 || r + 1 == rows) {
                values.push_back(static_cast<float>(column[r]));
                ++kept;
            }
    }
    if (every > 1) notes.push_back(fmt::format("Plots of {}.csv show every {}-th of its {} rows.", name, every, rows));
    json[name] = {{"names", table.names}, {"rows", kept}, {"array", add(packed_floats(values))}};
}

void PageData::add_attempts(const std::vector<time::Attempt>& attempts, std::vector<std::string>& notes) {
    std::size_t accepted = 0, rejected = 0;
    for (const time::Attempt& a : attempts) ++(a.verdict == time::Verdict::accept ? accepted : rejected);
    const std::size_t every = std::max<std::size_t>(1, (accepted + most_accepted - 1) / most_accepted);
    Json taken = Json::array(), cut = Json::array();
    std::size_t k = 0;
    for (const time::Attempt& a : attempts) {
        if (a.verdict == time::Verdict::accept) {
            if (k++ % every == 0) taken.push_back({a.time, a.dt, a.iterations, a.attempt});
        } else if (cut.size() < most_rejected) {
            cut.push_back({a.time, a.dt, a.iterations, a.attempt, time::name(a.reason), a.body, a.node, a.value});
        }
    }
    if (every > 1)
        notes.push_back(fmt::format("The plot of steps shows every {}-th of {} accepted ones.", every, accepted));
    if (rejected > most_rejected)
        notes.push_back(
            fmt::format("The plot of steps marks the first {} of {} rejected ones.", most_rejected, rejected));
    json["attempts"] = {{"accepted", taken}, {"rejected", cut}};
}

void PageData::add_plots(const std::vector<PlotFile>& plots) {
    json["plots"] = Json::array();
    for (const PlotFile& plot : plots) {
        Json curves = Json::array();
        for (const PlotCurve& curve : plot.curves) {
            std::vector<float> points(curve.x.begin(), curve.x.end());
            points.insert(points.end(), curve.y.begin(), curve.y.end());
            curves.push_back({{"name", curve.name}, {"points", curve.x.size()}, {"array", add(packed_floats(points))}});
        }
        json["plots"].push_back(
            {{"title", plot.title}, {"x_label", plot.x_label}, {"y_label", plot.y_label}, {"curves", curves}});
    }
}

void PageData::add_paths(const std::vector<PathFile>& paths, std::vector<std::string>& notes) {
    json["paths"] = Json::array();
    for (const PathFile& path : paths) {
        const std::size_t times = path.times.size(), numbers = times * path.at.size() * path.fields.size();
        const std::size_t share = most_path_numbers / paths.size();
        const std::size_t every = std::max<std::size_t>(1, (numbers + share - 1) / share);
        const auto kept = [&](const auto& all) {
            std::remove_cvref_t<decltype(all)> some;
            for (std::size_t f = 0; f < times; ++f)
                if (f % every == 0 || f + 1 == times) some.push_back(all[f]);
            return some;
        };
        if (every > 1)
            notes.push_back(
                fmt::format("The plot of probes/{}.csv shows every {}-th of its {} times.", path.name, every, times));
        Json fields = Json::array();
        for (const PathField& field : path.fields) {
            const Packed packed = pack({1, kept(field.values.frames)});
            fields.push_back({{"name", field.name},
                              {"unit", field.unit},
                              {"components", 1},
                              {"low", packed.low},
                              {"step", packed.step},
                              {"array", add(packed.bytes)}});
        }
        json["paths"].push_back({{"name", path.name},
                                 {"angle", path.angle},
                                 {"size", path.at.size()},
                                 {"at", add(packed_floats(path.at))},
                                 {"times", kept(path.times)},
                                 {"fields", fields}});
    }
}

Json PageData::view_of(const MovingSurfaces& surfaces) {
    Json parts = Json::array();
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const MovingPart& part : surfaces.parts)
        for (const Vec3& X : part.points) {
            low = low.cwiseMin(X);
            high = high.cwiseMax(X);
        }
    const Vec3 middle = (low + high) / 2; // what is far from the origin keeps its digits
    for (const MovingPart& part : surfaces.parts) {
        std::vector<float> points;
        for (const Vec3& X : part.points)
            for (int c = 0; c < 3; ++c) points.push_back(static_cast<float>(X[c] - middle[c]));
        std::vector<std::uint32_t> facets, nodes;
        for (const auto& facet : part.facets) facets.insert(facets.end(), facet.begin(), facet.end());
        for (const Index node : part.nodes) nodes.push_back(static_cast<std::uint32_t>(node));
        Json fields = Json::array();
        for (const PartField& field : part.fields) {
            const Packed packed = pack(field.values);
            fields.push_back({{"name", field.name},
                              {"unit", field.unit},
                              {"components", field.values.components},
                              {"integer", field.integer},
                              {"low", packed.low},
                              {"step", packed.step},
                              {"array", add(packed.bytes)}});
        }
        parts.push_back({{"name", part.name},
                         {"kind", name_of(part.kind)},
                         {"body", part.body},
                         {"size", part.points.size()},
                         {"points", add(packed_floats(points))},
                         {"nodes", add(packed_integers(nodes))},
                         {"facets", add(packed_integers(facets))},
                         {"fields", fields}});
    }
    Json colours = Json::array();
    for (const auto& colour : colour_map()) colours.push_back({colour[0], colour[1], colour[2]});
    const PictureOptions options;
    return {{"times", surfaces.times},
            {"origin", {middle.x(), middle.y(), middle.z()}},
            {"eye", {options.towards_eye.x(), options.towards_eye.y(), options.towards_eye.z()}},
            {"field", field_to_show(surfaces).name},
            {"colours", colours},
            {"parts", parts}};
}

void PageData::add_view(MovingSurfaces& surfaces, std::size_t largest, std::vector<std::string>& notes) {
    const std::size_t before = arrays_.size(), all = surfaces.times.size();
    for (;;) {
        arrays_.resize(before);
        Json view = view_of(surfaces);
        std::size_t size = 0;
        for (std::size_t i = before; i < arrays_.size(); ++i) size += arrays_[i].size();
        const std::size_t frames = surfaces.times.size();
        if (size <= largest || frames <= 2) {
            if (frames < all)
                notes.push_back(fmt::format("The three-dimensional view holds {} of {} frames, so that the page can be "
                                            "mailed; the folder of the run has them all.",
                                            frames, all));
            if (size > largest)
                notes.push_back(
                    fmt::format("The three-dimensional view takes {} MB, with two frames only.", size / 1000000));
            json["view"] = std::move(view);
            return;
        }
        const double share = 0.95 * static_cast<double>(largest) / static_cast<double>(size);
        thin_out(surfaces,
                 std::clamp<std::size_t>(static_cast<std::size_t>(share * static_cast<double>(frames)), 2, frames - 1));
    }
}

std::string PageData::html() const {
    std::string text;
    std::string plain = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    for (std::size_t at = plain.find('<'); at != std::string::npos; at = plain.find('<', at))
        plain.replace(at, 1, "\\u003c");
    text += "<script type=\"application/json\" id=\"report-data\">" + plain + "</script>\n";
    for (std::size_t i = 0; i < arrays_.size(); ++i)
        text += fmt::format("<script type=\"text/plain\" id=\"array-{}\">{}</script>\n", i, arrays_[i]);
    return text;
}

} // namespace osculate::report
