#include "scene/study_reader.hpp"

#include <algorithm>

namespace osculate::scene {

void StudyReader::quantity(StudyQuantity& q) {
    reader_.text({.name = "unit", .meaning = ""}, q.unit);
    q.label = q.name;
    reader_.text({.name = "label", .meaning = ""}, q.label);
    const Tree& here = *tree_.find("quantities")->find(q.name);
    const auto wrong = [&](const std::string& key, const std::string& expected, const std::string& found) {
        const Tree* at = here.find(key);
        reader_.fault(at != nullptr ? *at : here, {.name = key}, expected, found);
    };
    Words sources;
    for (const char* source : {"contact", "body", "history"})
        if (here.find(source)) sources.emplace_back(source);
    if (sources.size() > 1) wrong(sources[1], "only one of contact, body, history", join(sources, " and "));
    std::string pair, body;
    reader_.text({.name = "contact"}, pair);
    reader_.text({.name = "body"}, body);
    StudyText row;
    text("history", "a formula of the columns of history.csv", row);
    q.source = !pair.empty()   ? RowSource::contact
               : !body.empty() ? RowSource::body
               : !row.empty()  ? RowSource::history
                               : RowSource::summary;
    q.part = pair + body;
    text("value", "a formula", q.value);
    text("of", "a formula of a row", q.of);
    text("exact", "a formula of a row", q.exact);
    text("where", "a formula of a row", q.where);
    text("order_by", "a formula of a row", q.order_by);
    text("scale", "a formula of numbers", q.scale);
    text("reference", "a formula of numbers, or finest", q.reference);
    static const Words reductions{"last", "first", "min",       "max",    "mean",
                                  "rms",  "sum",   "amplitude", "ripple", "roughness"};
    std::size_t reduction = 0;
    reader_.word({.name = "reduce"}, reductions, reduction);
    q.reduce = reductions[reduction];
    static const Words norms{"rms", "max", "mean"};
    word(reader_, {.name = "norm"}, norms, q.norm);
    reader_.flag({.name = "area"}, q.area);
    static const Words errors{"relative", "absolute"};
    std::size_t error = 0;
    reader_.word({.name = "error"}, errors, error);
    q.relative = error == 0;
    reader_.flag({.name = "plot"}, q.plot);

    if (q.source == RowSource::history && q.value.empty()) {
        if (!q.of.empty()) wrong("of", "none beside history, which is the formula of a row", "both");
        q.of = row;
    } else if (q.source == RowSource::history && row.text != "all") {
        wrong("history", "all, as value says what to do with the rows", "'" + row.text + "'");
    }
    if (q.value.empty() == q.of.empty())
        wrong("value", q.source == RowSource::summary ? "it, or contact, body or history" : "it or of",
              q.value.empty() ? "neither" : "both");
    if (q.source == RowSource::summary && !q.of.empty()) wrong("of", "none without contact or body", "one");
    if (!q.value.empty() && !q.exact.empty()) wrong("exact", "none beside value", "both");
    if (!q.exact.empty() && !q.reference.empty()) wrong("reference", "none beside exact", "both");
    if (q.area && (q.source != RowSource::contact || q.exact.empty()))
        wrong("area", "none without contact and exact values", "true");
    const bool ordered = q.reduce == "first" || q.reduce == "last" || q.reduce == "roughness";
    if (!q.of.empty() && q.exact.empty() && ordered && q.source != RowSource::history && q.order_by.empty())
        wrong("order_by", "one for reduce: " + q.reduce + " of nodes, or another reduce", "none");
}

} // namespace osculate::scene
