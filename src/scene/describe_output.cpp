/// The keys of `output`, which templates hold, too.

#include "scene/describe.hpp"
#include "scene/describe_parts.hpp"

#include <algorithm>
#include <numbers>

namespace osculate::scene {

namespace {

const Words body_fields{"displacement",   "velocity",     "acceleration",  "stress",           "strain",
                        "von_mises",      "stress_max",   "stress_mid",    "stress_min",       "reaction",
                        "energy_density", "penetration",  "contact_force", "contact_pressure", "contact_gap",
                        "contact_status", "contact_slip", "plastic_strain"};
const Words slave_fields{"gap",       "contact_force", "normal_stress",       "slip",         "status",      "normal",
                         "slip_rate", "area",          "tangential_traction", "friction_use", "master_facet"};
const Words master_fields{"contact_force", "normal_stress"};
const Words reductions{"mean", "max", "min", "sum", "area_mean"};

void body(Visitor& v, std::string& name) {
    v.text({.name = "body", .meaning = "Body.", .required = true, .names = Names::body}, name);
}
void pair(Visitor& v, std::string& name) {
    v.text({.name = "pair", .meaning = "Contact pair.", .required = true, .names = Names::pair}, name);
}
void place(Visitor& v, const char* name, const char* meaning, Vec3& value) {
    v.vector({.name = name, .meaning = meaning, .unit = dimension::length, .range = range::position, .required = true},
             value);
}
void fields(Visitor& v, const Words& vocabulary, std::vector<std::string>& names, const char* usual) {
    v.words({.name = "fields", .meaning = "Fields, see docs/output.md.", .default_text = usual}, vocabulary, names);
}
void reduce(Visitor& v, std::vector<std::string>& names, const char* usual) {
    v.words(
        {.name = "reduce",
         .meaning = "How the nodes' values are combined; area_mean weights them with the areas that belong to them.",
         .default_text = usual},
        reductions, names);
}
void samples(Visitor& v, int& count) {
    v.integer({.name = "samples", .meaning = "Places, both ends among them.", .range = {.low = 2, .high = 100000}},
              count);
}

void describe(Visitor& v, PointProbe& p) {
    body(v, p.body);
    place(v, "at", "Reference position.", p.at);
    fields(v, body_fields, p.fields, "[displacement]");
}
void describe(Visitor& v, LineProbe& p) {
    body(v, p.body);
    place(v, "from", "Reference position of the first sample.", p.from);
    place(v, "to", "Reference position of the last sample; samples outside of the body have no values.", p.to);
    samples(v, p.samples);
    fields(v, body_fields, p.fields, "[displacement, stress]");
}
void describe(Visitor& v, ContactLineProbe& p) {
    pair(v, p.pair);
    place(v, "from", "Start; each sample is taken at the closest point of the undeformed slave surface.", p.from);
    place(v, "to", "End.", p.to);
    samples(v, p.samples);
    fields(v, slave_fields, p.fields, "[normal_stress]");
}
void describe(Visitor& v, ContactArcProbe& p) {
    pair(v, p.pair);
    place(v, "centre", "A point of the axis.", p.centre);
    v.vector({.name = "axis", .meaning = "Axis of the arc.", .range = range::direction, .direction = true}, p.axis);
    place(v, "from",
          "Start; its distance from the axis is the radius. Each sample is taken at the closest point of the "
          "undeformed slave surface.",
          p.from);
    v.number({.name = "angle",
              .meaning = "About the axis, to the end.",
              .unit = dimension::angle,
              .range = {.low = -2 * std::numbers::pi, .high = 2 * std::numbers::pi}},
             p.angle);
    samples(v, p.samples);
    fields(v, slave_fields, p.fields, "[normal_stress]");
}
void describe(Visitor& v, ContactForceProbe& p) {
    v.text({.name = "set", .meaning = "Set of nodes.", .required = true, .names = Names::set}, p.set);
    v.vector({.name = "point", .meaning = "Moments are about it.", .unit = dimension::length, .range = range::position},
             p.point);
}
void describe(Visitor& v, NodesProbe& p) {
    v.text({.name = "set", .meaning = "Set of nodes.", .required = true, .names = Names::set}, p.set);
    fields(v, body_fields, p.fields, "[displacement]");
    reduce(v, p.reduce, "[mean]");
}
void describe(Visitor& v, SlaveNodesProbe& p) {
    pair(v, p.pair);
    fields(v, slave_fields, p.fields, "[normal_stress]");
    reduce(v, p.reduce, "[max]");
}
void describe(Visitor& v, SectionForceProbe& p) {
    body(v, p.body);
    place(v, "point", "A point of the plane; moments are about it.", p.point);
    v.vector({.name = "normal",
              .meaning = "Normal of the plane: the part it points into acts on the other one.",
              .range = range::direction,
              .required = true,
              .direction = true},
             p.normal);
}

void describe(Visitor& v, Probe& probe) {
    static const Words tags{"point", "line",        "contact_line",  "contact_arc",
                            "nodes", "slave_nodes", "contact_force", "section_force"};
    one_of(v, tags,
           {"Fields at a point of a body.", "Fields along a line through a body.",
            "Fields of the slave surface below a line.", "Fields of the slave surface along an arc.",
            "Fields of a set's nodes, reduced.", "Fields of a pair's slave nodes, reduced.",
            "Resultant of all contact on a set's nodes, with its centre and pressures.",
            "Force and moment through a plane cut of a body, from the forces of the elements beside it."},
           true, probe.kind, [&](auto& kind) { describe(v, kind); });
    v.integer({.name = "every",
               .meaning = "Accepted steps between rows; the last step always has one.",
               .range = {.low = 1, .high = 1e6}},
              probe.every);
}

void describe(Visitor& v, Curve& curve) {
    v.text({.name = "rows", .meaning = "history, or the name of a probe."}, curve.rows);
    v.text({.name = "x", .meaning = "Formula over the columns of that table."}, curve.x);
    v.text({.name = "y",
            .meaning = "Formula; pair.*.normal in it stands for every matching column: one curve for each, or none.",
            .required = true},
           curve.y);
    v.text({.name = "where", .meaning = "Formula: rows where it is not 0.", .default_text = "all rows"}, curve.where);
    v.flag({.name = "last", .meaning = "Only the rows of the last time."}, curve.last);
}

void describe(Visitor& v, Plot& plot) {
    v.text({.name = "title", .meaning = "Title.", .default_text = "the plot's name"}, plot.title);
    v.text({.name = "x_label", .meaning = "Label of the abscissa.", .default_text = "the formula"}, plot.x_label);
    v.text({.name = "y_label", .meaning = "Label of the ordinate.", .default_text = "the formula"}, plot.y_label);
    named(v, {.name = "curves", .meaning = "Curves by their title.", .required = true, .item = "curve"}, plot.curves,
          [&](const std::string& name, Curve& curve) { v.group({.name = name}, [&] { describe(v, curve); }); });
}

void describe(Visitor& v, Derivative& derivative) {
    v.text({.name = "key", .meaning = "Path of a number of the scene, as for --set.", .required = true},
           derivative.key);
    v.number({.name = "change",
              .meaning =
                  "Relative change of the number between whose two sides the derivative is a difference: its error "
                  "is of the order of the square.",
              .range = {.low = 1e-8, .high = 1e-2}},
             derivative.change);
    v.number(
        {.name = "step",
         .meaning = "The change itself, in SI, in place of the relative one: numbers that are 0 need it. 0: relative.",
         .range = {.low = 0, .high = 1e9}},
        derivative.step);
}

void direction(Visitor& v, Vec3& value) {
    v.vector({.name = "direction",
              .meaning = "Its component along this direction.",
              .range = range::direction,
              .required = true,
              .direction = true},
             value);
}
void describe(Visitor& v, MeanDisplacement& mean) {
    v.text({.name = "set", .meaning = "Set of nodes.", .required = true, .names = Names::set}, mean.set);
    direction(v, mean.direction);
}
void describe(Visitor& v, PairForce& force) {
    pair(v, force.pair);
    direction(v, force.direction);
}
void describe(Visitor& v, SupportForce& force) {
    v.text({.name = "set", .meaning = "Set of nodes.", .required = true, .names = Names::set}, force.set);
    direction(v, force.direction);
}

void describe(Visitor& v, Gradient& gradient) {
    static const Words tags{"displacement", "contact_force", "reaction"};
    one_of(v, tags,
           {"Mean displacement of a set's nodes at the end of the run.",
            "Contact force on a pair's slave side at the end of the run.",
            "Force of the supports and driven motions on a set at the end of the run."},
           true, gradient.of, [&](auto& of) { describe(v, of); });
    named(v,
          {.name = "by",
           .meaning = "Numbers of the scene, by names for the table; `NAME: KEY` is short for `NAME: {key: KEY}`.",
           .required = true,
           .item = "derivative"},
          gradient.by,
          [&](const std::string& name, Derivative& by) { v.group({.name = name}, [&] { describe(v, by); }); });
}

} // namespace

void describe_output(Visitor& v, Output& output) {
    constexpr const char* from_template = "the template's";
    v.words({.name = "body_fields", .meaning = "Fields of the bodies' frames.", .default_text = from_template},
            body_fields, output.body_fields);
    v.words({.name = "slave_fields", .meaning = "Fields of the slave surfaces' frames.", .default_text = from_template},
            slave_fields, output.slave_fields);
    v.words(
        {.name = "master_fields", .meaning = "Fields of the master surfaces' frames.", .default_text = from_template},
        master_fields, output.master_fields);
    static const Words histories{"pairs", "reactions"};
    std::vector<std::string> history;
    if (output.history_pairs) history.push_back(histories[0]);
    if (output.history_reactions) history.push_back(histories[1]);
    v.words({.name = "history", .meaning = "Column groups of history.csv.", .default_text = from_template}, histories,
            history);
    output.history_pairs = std::ranges::count(history, histories[0]) > 0;
    output.history_reactions = std::ranges::count(history, histories[1]) > 0;
    v.flag({.name = "iterations", .meaning = "Write iterations.csv.", .default_text = from_template},
           output.iterations);
    v.integer({.name = "frame_every",
               .meaning = "Accepted steps between frames; 0 writes none.",
               .range = {.low = 0, .high = 1e6},
               .default_text = from_template},
              output.frame_every);
    const auto group = [&v]<class T>(const std::string& name, T& value) {
        v.group({.name = name}, [&] { describe(v, value); });
    };
    named(v,
          {.name = "probes",
           .meaning = "Values at places of the scene, into probes/NAME.csv; beside those of the template.",
           .item = "probe"},
          output.probes, group);
    named(
        v,
        {.name = "plots",
         .meaning = "Curves drawn at the end of the run, into plots/NAME.{csv,svg,png}; beside those of the template.",
         .item = "plot"},
        output.plots, group);
    named(v,
          {.name = "derivatives",
           .meaning = "Derivatives of history.csv and of the probes by numbers of the scene, into derivatives/NAME; "
                      "`NAME: KEY` is short for `NAME: {key: KEY}`.",
           .item = "derivative"},
          output.derivatives, group);
    named(v,
          {.name = "gradients",
           .meaning = "Derivatives of single quantities at the end of the run by many numbers of the scene, by its "
                      "adjoint, into "
                      "gradients/NAME.csv.",
           .item = "gradient"},
          output.gradients, group);
    v.flag({.name = "paraview",
            .meaning = "Write show_in_paraview.py beside the series, which shows it.",
            .default_text = from_template},
           output.paraview);
    v.flag({.name = "report", .meaning = "Write a report at the end of the run.", .default_text = from_template},
           output.report);
    v.flag({.name = "failed_iterate",
            .meaning = "If the run gives up, write the last iterate, its statuses and the forces out of balance as a "
                       "frame, into the folder failed."},
           output.failed_iterate);
}

void describe_template(Visitor& v, std::string& extends, Output& output) {
    v.text({.name = "extends", .meaning = "Template whose keys are used if this one does not have them."}, extends);
    describe_output(v, output);
}

} // namespace osculate::scene
