#include "osculate/scene/nearest.hpp"
#include "scene/describe_parts.hpp"
#include "scene/study_reader.hpp"

#include <algorithm>

namespace osculate::scene {

std::size_t StudyReader::plotted_quantity() {
    Words known;
    for (const StudyQuantity& q : study_.quantities) known.push_back(q.name);
    const Key key{.name = "quantity", .required = true};
    const std::string expected = "one of the quantities " + join(known);
    const Tree* name = reader_.take(key, expected);
    if (!name) return known.size();
    const auto at = std::ranges::find(known, name->kind == Tree::Kind::scalar ? name->scalar : std::string());
    if (at == known.end()) reader_.fault(*name, key, expected, {}, nearest(name->scalar, known));
    return static_cast<std::size_t>(at - known.begin());
}

std::optional<StudyCoordinate> StudyReader::coordinate(const Tree& at, const Key& key) {
    Words known;
    for (std::size_t a = 0; a < study_.axes.size(); ++a) {
        const StudyAxis& axis = study_.axes[a];
        if (axis.variables.empty()) known.push_back(axis.name); // the number of a sample says nothing
        const bool own = at.kind == Tree::Kind::scalar && at.scalar == axis.name && axis.variables.empty();
        if (own) return StudyCoordinate{a, axis.name, axis.unit};
        if (axis.values.empty()) continue;
        for (const auto& [name, number] : axis.values.front().parameters) {
            if (name != axis.name) known.push_back(name);
            if (at.kind != Tree::Kind::scalar || at.scalar != name) continue;
            const auto variable = std::ranges::find(axis.variables, name, &SampledVariable::name);
            if (variable == axis.variables.end()) return StudyCoordinate{a, name};
            return StudyCoordinate{a, name, variable->unit, variable->logarithmic, axis.variables.size() > 1};
        }
    }
    reader_.fault(at, key, "an axis or a parameter of one: " + join(known), {}, nearest(at.scalar, known));
    return std::nullopt;
}

namespace {

/// Places of logarithmic axes have to be positive.
bool all_positive(const Study& study, const StudyCoordinate& over) {
    for (std::size_t v = 0; v < study.axes[over.axis].values.size(); ++v)
        if (const auto place = study.place_of(over, v); !place || !(*place > 0)) return false;
    return true;
}

} // namespace

void StudyReader::curves(StudyCurves& curves) {
    curves.quantity = plotted_quantity();
    const Key over{.name = "over", .required = true};
    const Tree* at = reader_.take(over, "an axis");
    std::vector<std::string> logarithmic;
    reader_.words({.name = "logarithmic"}, {"x", "y"}, logarithmic);
    if (!at) return;
    const auto read = coordinate(*at, over);
    if (!read) return;
    curves.over = *read;
    curves.logarithmic = std::ranges::count(logarithmic, "y") > 0;
    if (std::ranges::count(logarithmic, "x") == 0) return;
    if (!all_positive(study_, curves.over))
        return reader_.fault(*at, over, "an axis of positive numbers, as x is logarithmic");
    curves.over.logarithmic = true;
}

void StudyReader::contours(StudyContours& contours) {
    contours.quantity = plotted_quantity();
    const Key over{.name = "over", .required = true};
    const char* expected = "a list of two axes";
    const Tree* list = reader_.take(over, expected);
    std::vector<std::string> logarithmic;
    reader_.words({.name = "logarithmic"}, {"x", "y"}, logarithmic);
    if (!list) return;
    if (list->kind != Tree::Kind::list || list->children.size() != 2) return reader_.fault(*list, over, expected);
    bool read = true;
    for (std::size_t k = 0; k < 2; ++k)
        if (const auto one = coordinate(list->children[k], over))
            contours.over[k] = *one;
        else
            read = false;
    if (!read) return;
    if (contours.over[0].axis == contours.over[1].axis)
        return reader_.fault(*list, over, expected, "'" + study_.axes[contours.over[0].axis].name + "' twice");
    for (std::size_t k = 0; k < 2; ++k) {
        StudyCoordinate& c = contours.over[k];
        if (study_.axes[c.axis].values.size() < 2 || c.sampled)
            reader_.fault(list->children[k], over, "an axis of two or more values that are not samples");
        if (std::ranges::count(logarithmic, k == 0 ? "x" : "y") == 0) continue;
        if (!all_positive(study_, c))
            reader_.fault(list->children[k], over, "an axis of positive numbers, as it is logarithmic");
        c.logarithmic = true;
    }
}

void StudyReader::add_curves() {
    for (std::size_t a = 0; a < study_.axes.size(); ++a) {
        const StudyAxis& axis = study_.axes[a];
        if (static_cast<int>(a) == study_.refine || axis.values.size() < 2) continue;
        std::vector<StudyCoordinate> over;
        if (axis.values.front().number) over.push_back({a, axis.name, axis.unit});
        for (const SampledVariable& v : axis.variables)
            over.push_back({a, v.name, v.unit, v.logarithmic, axis.variables.size() > 1});
        for (std::size_t q = 0; q < study_.quantities.size(); ++q)
            for (const StudyCoordinate& c : over)
                if (const StudyQuantity& quantity = study_.quantities[q]; !quantity.has_error() && quantity.plot)
                    study_.curves.push_back({quantity.name + "_over_" + c.name, q, c});
    }
}

void StudyReader::plots() {
    const Tree* plots = tree_.find("plots");
    const bool chosen = plots && plots->kind == Tree::Kind::map && (plots->find("curves") || plots->find("contours"));
    reader_.group({.name = "plots"}, [&] {
        axis_list("colour_by", study_.colour_by);
        Named<StudyCurves> curves_read;
        named(reader_, {.name = "curves", .names = Names::identifier, .item = "plot"}, curves_read,
              [&](const std::string& name, StudyCurves& one) {
                  one.name = name;
                  reader_.group({.name = name}, [&] { curves(one); });
              });
        for (auto& [name, one] : curves_read) study_.curves.push_back(std::move(one));
        Named<StudyContours> contours_read;
        named(reader_, {.name = "contours", .names = Names::identifier, .item = "plot"}, contours_read,
              [&](const std::string& name, StudyContours& one) {
                  one.name = name;
                  reader_.group({.name = name}, [&] { contours(one); });
              });
        for (auto& [name, one] : contours_read) study_.contours.push_back(std::move(one));
    });
    if (!chosen) add_curves();
}

} // namespace osculate::scene
