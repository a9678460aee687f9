"""The page that sums up the studies: aims, and a row per problem. Figures come from docs/verification/data alone."""
import math

from markdown import number, seconds, table

NODE = {"surface": "blend", "weighting": "node"}  # the default
MORTAR = {"surface": "blend", "weighting": "mortar"}

# study, the run by its axes, quantities
ROWS = [
    ("taylor_patch", {"pattern": "quad", "side": "fine_slave", "mesh": "5_on_4"} | NODE, ["worst_pressure"]),
    ("taylor_patch", {"pattern": "quad", "side": "fine_slave", "mesh": "5_on_4"} | MORTAR, ["worst_pressure"]),
    ("taylor_patch", {"pattern": "triangle", "side": "fine_slave", "mesh": "5_on_4"} | MORTAR, ["worst_pressure"]),
    ("taylor_patch", {"pattern": "hybrid", "side": "fine_slave", "mesh": "5_on_4"} | MORTAR, ["worst_pressure"]),
    ("hertz_sphere", {"model": "quarter", "side": "ball_master", "mesh": "8_across"} | NODE,
     ["peak_pressure", "contact_radius", "profile"]),
    ("hertz_sphere", {"model": "quarter", "side": "ball_master", "mesh": "16_across"} | NODE,
     ["peak_pressure", "contact_radius", "profile"]),
    ("hertz_cylinder", {"model": "quarter", "side": "cylinder_master", "mesh": "8_across"} | NODE,
     ["peak_pressure", "half_width", "profile"]),
    ("hertz_cylinder", {"model": "quarter", "side": "cylinder_master", "mesh": "32_across"} | NODE,
     ["peak_pressure", "half_width", "profile"]),
    ("cattaneo_mindlin", {"side": "cylinder_master", "mesh": "40_across"} | NODE, ["stick_half_width", "peak_traction"]),
    ("cattaneo_mindlin", {"side": "cylinder_master", "mesh": "40_across"} | MORTAR, ["stick_half_width", "peak_traction"]),
    ("nested_tubes", {"side": "inner_slave", "mesh": "40_in_32"} | NODE, ["ripple", "mean_pressure"]),
    ("nested_tubes", {"side": "inner_slave", "mesh": "40_in_32"} | MORTAR, ["ripple", "mean_pressure"]),
    ("half_tube_ripple", {"sliding_step": "0.1m", "tube": "base"} | NODE, ["ripple"]),
    ("half_tube_ripple", {"sliding_step": "0.025m", "tube": "base"} | NODE, ["ripple"]),
    ("half_tube_ripple", {"sliding_step": "0.1m", "tube": "halved"} | NODE, ["ripple"]),
    ("half_tube_ripple", {"sliding_step": "0.1m", "tube": "base"} | MORTAR, ["ripple"]),
    *[("foundation", {"soil": soil, "mesh": "given"} | pairing, ["roughness"])
      for soil in ("quad", "tri", "hybrid") for pairing in (NODE, MORTAR)],
    ("foundation", {"soil": "quad", "mesh": "given"} | NODE, ["force"]),
    ("incline", {"friction": "slides", "surface": "blend", "step": "20ms"}, ["acceleration"]),
    ("incline", {"friction": "sticks", "surface": "blend", "step": "20ms"}, ["acceleration"]),
    ("falling_block", {"allowed": "1e-3", "fall_steps": "200"}, ["touch"]),
    ("two_bars", {"integrator": "alpha_0.5", "elements": "100"}, ["stress", "plateau", "duration"]),
    ("rod_impact", {"integrator": "newmark", "elements": "100"}, ["displacement", "reaction", "energy"]),
    ("hertz_impact", {"surface": "blend", "mesh": "given"}, ["duration", "force", "energy"]),
    ("metal_bar", {"surface": "blend", "mesh": "40"}, ["energy", "rebound"]),
    ("time_integrators", {"integrator": "alpha_1", "vibrate_steps": "400"}, ["momentum", "energy"]),
    ("time_integrators", {"integrator": "backward_euler", "vibrate_steps": "400"}, ["momentum", "energy"]),
]
# study, surface, mesh, method, kinds of error
SURFACE_ROWS = [
    ("table1", "sphere", "1", "height_1", ["position", "normal"]),
    ("table1", "sphere", "1", "blend_2", ["position", "normal"]),
    ("table1", "saddle", "1", "blend_2", ["position", "normal"]),
    ("surface_convergence", "sphere", "5", "blend_2", ["position", "normal", "curvature"]),
    ("surface_convergence", "torus", "5", "blend_2", ["position", "normal", "curvature"]),
    ("surface_options", "sphere", "4", "blend_2_r5", ["position", "normal", "curvature"]),
]


class Study:
    """Rows of a study with its texts."""

    def __init__(self, texts, rows):
        self.texts, self.rows = texts, rows

    def only(self, **axes):
        return [row for row in self.rows if all(row[axis] == value for axis, value in axes.items())]

    def one(self, **axes):
        found = self.only(**axes)
        if len(found) != 1:
            raise ValueError(f"{len(found)} runs of {self.texts['title']} have {axes}")
        return found[0]

    def values(self, column, **axes):
        """Numbers of the runs that have one."""
        return [float(row[column]) for row in self.only(**axes) if row[column]]


def percent(value):
    return "-" if math.isnan(value) else f"{100 * value:.3g} %"


def problem(name, texts):
    return f"[{texts['title']}]({name}.md)"


def run_row(name, study, axes, quantity):
    of, row = study.texts["quantities"][quantity], study.one(**axes)
    at = lambda column: float(row[column]) if row.get(column) else math.nan
    unit = f" {of['unit']}" if of.get("unit") else ""
    error, shown = at(f"{quantity}.error"), "-"
    if "exact" not in of:
        shown = number(at(f"{quantity}.value"), 6) + unit
    is_share = "exact" in of and ("scale" in of or not unit) or "exact" not in of and of.get("error") != "absolute"
    ended = "" if row["status"] == "done" else f" ({row['status'].replace('_', ' ')})"
    return [problem(name, study.texts), study.texts["source"], ", ".join(axes[a] for a in study.texts["axes"] if a in axes),
            of.get("label", quantity), shown + ended, percent(error) if is_share else number(error) + unit,
            seconds(at("cpu_seconds")), f"`scripts/pages/verification --only {name}`"]


def surface_row(name, study, surface, mesh, method, kind, unit):
    row, facets = (study.one(surface=surface, mesh=mesh, method=m) for m in (method, "facets"))
    mean = float(row[f"{kind}.mean"])
    return [problem(name, study.texts), study.texts["source"], f"{surface}, {row['facets']} facets, {method}",
            f"error of {kind}, mean ({number(mean / float(facets[f'{kind}.mean']), 2)} of that of facets)", "-",
            f"{number(mean)} {unit}", seconds(float(row.get("cpu_seconds") or math.nan)),
            f"`scripts/pages/verification --only {name}`"]


def worst(study, quantity, **axes):
    return max(study.values(f"{quantity}.error", **axes))


def within(name, label, measured, aim, form=percent):
    return [name, label, f"at most {form(aim)}", form(measured), "met" if measured <= aim else "**missed**"]


def beside(name, label, measured):
    """What has no aim of its own."""
    return [name, label, "none", measured, ""]


def hertz_aims(s, name, master, slave, quantities):
    study = s[name]
    one = problem(name, study.texts)
    across = dict(model="quarter", mesh="8_across", **NODE)
    for quantity in quantities:
        label = study.texts["quantities"][quantity]["label"]
        yield within(one, f"{label}, default, 8 elements across, worse side as master",
                     worst(study, quantity, **across), 0.02)
    series = [study.only(model="quarter", side=side, **NODE) for side in (master, slave)]
    rises = sum(float(fine[f"{q}.error"]) > float(coarse[f"{q}.error"]) for runs in series for q in quantities
                for coarse, fine in zip(runs, runs[1:]))
    refinements = sum(len(runs) - 1 for runs in series) * len(quantities)
    yield within(one, f"refinements that raise one of these errors, default, of {refinements}", rises, 0,
                 lambda v: str(v))
    for weighting in ("node", "mortar"):
        ratios = [float(row["profile.error"]) / float(study.one(**{axis: row[axis] for axis in study.texts["axes"]}
                                                                | {"surface": "facets"})["profile.error"])
                  for row in study.only(surface="blend", weighting=weighting)]
        yield within(one, f"profile with blend over that with facets, {weighting}, worst mesh", max(ratios), 1,
                     lambda v: number(v))
    both = [(float(a["peak_pressure.value"]), float(b["peak_pressure.value"])) for side in (master, slave)
            for a, b in [(study.one(model="full", side=side, mesh="8_across", **NODE),
                          study.one(model="quarter", side=side, mesh="8_across", **NODE))]]
    yield within(one, "largest pressure, full against quarter model, default", max(abs(a / b - 1) for a, b in both), 1e-6,
                 lambda v: number(v, 2))


def patch_aims(s):
    study = s["taylor_patch"]
    one = problem("taylor_patch", study.texts)
    short = lambda v: number(v, 2)
    for pattern in ("quad", "triangle", "hybrid"):
        for surface in ("facets", "rpim", "blend"):
            ask = dict(pattern=pattern, surface=surface)
            label = f"pressure of the worst node, {pattern}, {surface}, worst of the meshes"
            yield within(one, f"{label}, mortar", worst(study, "worst_pressure", weighting="mortar", **ask), 1e-10, short)
            yield beside(one, f"{label}, node", short(worst(study, "worst_pressure", weighting="node", **ask)))


def tube_aims(s):
    study = s["nested_tubes"]
    for weighting in ("node", "mortar"):
        for side in ("inner_slave", "outer_slave"):
            yield within(problem("nested_tubes", study.texts), f"ripple, blend, {weighting}, {side}, mesh given",
                         worst(study, "ripple", surface="blend", weighting=weighting, side=side, mesh="40_in_32"), 0.005)


def foundation_aims(s):
    study = s["foundation"]
    for soil in ("tri", "hybrid"):
        for surface in ("facets", "rpim", "blend"):
            ask = dict(soil=soil, surface=surface, mesh="given")
            for what, where in (("roughness", ""), ("inner_roughness", " 1 m and more from the edges")):
                ratio = worst(study, what, weighting="mortar", **ask) / worst(study, what, weighting="node", **ask)
                yield within(problem("foundation", study.texts),
                             f"roughness{where} with mortar over that with node, {soil}, {surface}", ratio, 0.5,
                             lambda v: number(v, 2))


def span(points):
    errors = [error for _, error in points]
    return f"{percent(min(errors))} to {percent(max(errors))}"


def front(points):
    best = []
    for time, error in sorted(points):
        if not best or error < best[-1][1]:
            best.append((time, error))
    return best


def time_at(points, error):
    """CPU seconds of a Pareto front at an error between its ends, linear in logarithms."""
    for (t1, e1), (t2, e2) in zip(points, points[1:]):
        if error >= e2:
            return t1 * (t2 / t1) ** (math.log(e1 / min(error, e1)) / math.log(e1 / e2))
    return points[-1][0]


def cost_ratio(first, second):
    """As study::cost_ratio: the ratio of times in the middle of the errors both reach, and that error."""
    a, b = front(first), front(second)
    least, largest = max(a[-1][1], b[-1][1]), min(a[0][1], b[0][1])
    if least > largest:
        return None
    error = math.sqrt(least * largest)
    return time_at(a, error) / time_at(b, error), error


def half_tube_aims(s):
    study = s["half_tube_ripple"]
    one = problem("half_tube_ripple", study.texts)
    for step, tube, aim in (("0.1m", "base", 0.012), ("0.1m", "halved", 0.004), ("0.025m", "base", 0.015)):
        yield within(one, f"ripple, default, {tube} tube, steps of {step}",
                     worst(study, "ripple", sliding_step=step, tube=tube, **NODE), aim)
    runs = {m: [(float(r["cpu_seconds"]), float(r["ripple.error"]))
                for r in study.only(surface=m, weighting="node", sliding_step="0.1m") if r["ripple.error"]]
            for m in ("facets", "rpim", "blend")}
    shared = cost_ratio(runs["facets"], runs["blend"])
    yield beside(one, "CPU seconds of facets over those of blend at equal ripple, node",
                 f"{shared[0]:.3g} (at {percent(shared[1])})" if shared else
                 f"no ripple in common: facets {span(runs['facets'])}, blend {span(runs['blend'])}")
    # at the time of each run with blend: its ripple over the least that facets reach by then
    least = lambda m, time: min((e for t, e in runs[m] if t <= time), default=math.inf)
    over = lambda other: max(least("blend", time) / least(other, time) for time, _ in runs["blend"])
    yield within(one, "ripple with blend over the least with facets for no more CPU seconds, node, worst run with blend",
                 over("facets"), 1, lambda v: number(v, 2))
    yield beside(one, "the same over the least with rpim", number(over("rpim"), 2))
    for surface in ("facets", "rpim", "blend"):
        yield beside(one, f"ripple, {surface}, node, quartered tube",
                     percent(worst(study, "ripple", surface=surface, weighting="node", tube="quartered")))


def slip_aims(s):
    study = s["cattaneo_mindlin"]
    for quantity in ("stick_half_width", "peak_traction"):
        for weighting in ("node", "mortar"):
            label = study.texts["quantities"][quantity]["label"]
            yield within(problem("cattaneo_mindlin", study.texts),
                         f"{label}, blend, {weighting}, 40 elements across, worse side as master",
                         worst(study, quantity, surface="blend", weighting=weighting, mesh="40_across"), 0.02)


AIMS = {
    "hertz_sphere": lambda s: hertz_aims(s, "hertz_sphere", "ball_master", "ball_slave",
                                         ["peak_pressure", "contact_radius", "profile"]),
    "hertz_cylinder": lambda s: hertz_aims(s, "hertz_cylinder", "cylinder_master", "cylinder_slave",
                                           ["peak_pressure", "half_width", "profile"]),
    "cattaneo_mindlin": slip_aims, "taylor_patch": patch_aims, "nested_tubes": tube_aims, "foundation": foundation_aims,
    "half_tube_ripple": half_tube_aims,
}

HEAD = """# Verification: the scoreboard

{problems} problems with known answers. Every figure comes from the runs of `scripts/pages/verification`, which writes this page
and the pages it links to from the tables in `data`; do not edit them. Settings are the defaults, `blend` and `node`, unless a
row says otherwise. CPU seconds are those of one run on one thread, on the machine of the last run.

{summary}
"""
TAIL = """## What is compared

Tests (`ctest -R docs`) generate this page, the pages of the studies, [results](../results.md), and the table and figures in
the README and the theory again from the stored tables. They fail on any difference. Pictures show the same runs as the tables
beside them. The tests do not cover:

- times of kernels by `scripts/measure/bench`: the README's table of evaluations and all tables of [search](../search.md);
- what an older OpenBLAS costs on some machines, in the README;
- figures of single tests in [theory](../theory.md), sections 3, 6 and 9: those tests print them.
"""


def page(studies):
    s = {name: Study(*study) for name, study in studies.items()}
    rows = [run_row(name, s[name], axes, q) for name, axes, quantities in ROWS if name in s for q in quantities]
    units = {"position": "m", "normal": "rad", "curvature": "1/m"}
    rows += [surface_row(name, s[name], surface, mesh, method, kind, units[kind])
             for name, surface, mesh, method, kinds in SURFACE_ROWS if name in s for kind in kinds]
    aims = [row for name, of in AIMS.items() if name in s for row in of(s)]
    met = sum(row[4] == "met" for row in aims)
    missed = [f"{row[0]}: {row[1]}: {row[3]}, aim {row[2]}" for row in aims if "missed" in row[4]]
    summary = f"Of {met + len(missed)} aims, {met} are met and {len(missed)} missed"
    summary += (":\n\n" + "\n".join(f"- {line}" for line in missed)) if missed else "."
    if "taylor_patch" in s:
        of = lambda weighting: number(worst(s["taylor_patch"], "worst_pressure", weighting=weighting), 2)
        summary += (f"\n\nContact at slave nodes (`node`, the default) does not pass the patch test on meshes that do not match: "
                    f"pressures at single\nnodes are wrong by up to {of('node')} of the pressure, even on fine meshes. "
                    f"With `mortar` they are wrong by at most {of('mortar')}, which\ncomes from `solver.tolerance`.")
    return "\n".join([
        HEAD.format(problems=len(s), summary=summary), "## Aims\n",
        table(["problem", "figure", "aim", "measured", ""], aims), "## Problems\n",
        table(["problem", "reference", "settings", "quantity", "value", "error", "CPU s", "command"], rows), TAIL])
