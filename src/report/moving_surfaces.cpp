#include "osculate/report/moving_surfaces.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/without_traps.hpp"
#include "osculate/output/fields.hpp"
#include "osculate/output/frame_reader.hpp"
#include "osculate/output/series_reader.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <unordered_map>

namespace osculate::report {

namespace fs = std::filesystem;

namespace {

/// Frames of a series: files in the order of the parts. A frame that is not whole yet is left out.
struct FrameList {
    std::vector<std::string> parts;
    std::vector<double> times;
    std::vector<std::vector<std::string>> files; ///< frame by frame, part by part
};

FrameList list_frames(const std::vector<output::SeriesEntry>& entries) {
    FrameList list;
    for (const output::SeriesEntry& entry : entries) {
        if (list.parts.empty() || entry.part == list.parts.front()) {
            list.times.push_back(entry.time);
            list.files.emplace_back();
        }
        if (list.times.size() == 1) list.parts.push_back(entry.part);
        list.files.back().push_back(entry.file);
    }
    while (!list.files.empty() && list.files.back().size() != list.parts.size()) {
        list.files.pop_back();
        list.times.pop_back();
    }
    return list;
}

/// `count` of `all` numbers, evenly, first and last among them.
std::vector<std::size_t> evenly(std::size_t all, std::size_t count) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < std::min(all, count); ++i)
        chosen.push_back(count >= all ? i : (i * (all - 1) + (count - 1) / 2) / (count - 1));
    return chosen;
}

std::string unit_of(PartKind kind, const std::string& name) {
    const output::FieldPlace where = kind == PartKind::body    ? output::FieldPlace::body
                                     : kind == PartKind::slave ? output::FieldPlace::slave
                                                               : output::FieldPlace::master;
    for (const output::OutputField& field : output::all_fields())
        if (field.name == name && (field.where == where || name == "displacement")) return field.unit;
    return "";
}

bool ends(const std::string& text, const std::string& ending) {
    return text.size() > ending.size() && text.ends_with(ending);
}

MovingPart make_part(const std::string& name, const fs::path& first) {
    MovingPart part;
    part.name = name;
    const bool surface = first.extension() == ".vtp";
    if (surface && ends(name, ".slave")) {
        part.kind = PartKind::slave;
        part.name.resize(name.size() - std::string(".slave").size());
    } else if (surface && ends(name, ".master")) {
        part.kind = PartKind::master;
        part.name.resize(name.size() - std::string(".master").size());
    }
    const output::Frame frame = output::read_frame(first);
    std::unordered_map<Index, std::uint32_t> point_of;
    for (const mesh::Facet& facet : output::read_facets(first)) {
        std::array<std::uint32_t, 4>& corners = part.facets.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) {
            const Index node = facet.nodes[std::min(c, static_cast<std::size_t>(facet.count) - 1)];
            const auto [at, fresh] = point_of.emplace(node, static_cast<std::uint32_t>(part.nodes.size()));
            if (fresh) {
                part.nodes.push_back(node);
                part.points.push_back(frame.points.at(static_cast<std::size_t>(node)));
            }
            corners[c] = at->second;
        }
    }
    for (const output::Array& array : frame.arrays)
        part.fields.push_back({array.name, unit_of(part.kind, array.name), array.integer, {array.components, {}}});
    return part;
}

void add_frame(MovingPart& part, const output::Frame& frame) {
    for (PartField& field : part.fields) {
        const output::Array* array = frame.find(field.name);
        const auto components = static_cast<std::size_t>(field.values.components);
        if (array == nullptr || array->components != field.values.components ||
            array->values.size() != frame.points.size() * components)
            throw std::runtime_error("the frames of '" + part.name + "' do not hold the same fields");
        std::vector<float>& values = field.values.frames.emplace_back();
        values.reserve(part.nodes.size() * components);
        constexpr double largest = std::numeric_limits<float>::max();
        for (const Index node : part.nodes)
            for (std::size_t c = 0; c < components; ++c) {
                const double value = array->values.at(static_cast<std::size_t>(node) * components + c);
                values.push_back(std::isfinite(value) ? static_cast<float>(std::clamp(value, -largest, largest))
                                                      : std::numeric_limits<float>::quiet_NaN());
            }
    }
}

MovingSurfaces read(const fs::path& folder, const FrameBudget& budget) {
    MovingSurfaces all;
    const FrameList list = list_frames(output::read_series(folder / "series.pvd"));
    if (list.times.empty()) {
        all.notes.emplace_back("series.pvd lists no frame yet.");
        return all;
    }
    std::size_t per_frame = 0;
    for (std::size_t p = 0; p < list.parts.size(); ++p) {
        MovingPart& part = all.parts.emplace_back(make_part(list.parts[p], folder / list.files.front()[p]));
        for (const PartField& field : part.fields)
            per_frame += part.points.size() * static_cast<std::size_t>(field.values.components);
    }
    const std::size_t fitting =
        std::clamp<std::size_t>(budget.values / std::max<std::size_t>(per_frame, 1), 2, budget.frames);
    const std::vector<std::size_t> chosen = evenly(list.times.size(), fitting);
    for (const std::size_t f : chosen) {
        for (std::size_t p = 0; p < list.parts.size(); ++p)
            add_frame(all.parts[p], output::read_frame(folder / list.files[f][p]));
        all.times.push_back(list.times[f]);
    }
    if (chosen.size() < list.times.size())
        all.notes.push_back(fmt::format("{} of {} frames are in this report, evenly spread, the first and the last one "
                                        "among them; the folder of the run has them all.",
                                        chosen.size(), list.times.size()));
    return all;
}

} // namespace

const PartField* MovingPart::find(const std::string& field) const {
    for (const PartField& one : fields)
        if (one.name == field) return &one;
    return nullptr;
}

MovingSurfaces read_moving_surfaces(const fs::path& run_folder, const FrameBudget& budget) {
    const WithoutTraps values_may_be_no_numbers;
    MovingSurfaces none;
    if (!fs::exists(run_folder / "series.pvd")) {
        none.notes.emplace_back(
            "The run wrote no frames (output.frame_every: 0, or a template without fields): there is "
            "nothing to show in three dimensions.");
        return none;
    }
    try {
        return read(run_folder, budget);
    } catch (const std::exception& error) {
        none.notes.push_back(std::string("The frames cannot be shown: ") + error.what() + ".");
        return none;
    }
}

void thin_out(MovingSurfaces& surfaces, std::size_t count) {
    require(count >= 2, "first and last frame stay");
    const std::vector<std::size_t> chosen = evenly(surfaces.times.size(), count);
    const auto keep = [&](auto& list) {
        auto old = std::move(list);
        list.clear();
        for (const std::size_t f : chosen) list.push_back(std::move(old[f]));
    };
    keep(surfaces.times);
    for (MovingPart& part : surfaces.parts)
        for (PartField& field : part.fields) keep(field.values.frames);
}

} // namespace osculate::report
