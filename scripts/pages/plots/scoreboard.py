"""The page that sums up the studies: aims, and a row per problem. Figures come from docs/verification/data alone."""
import math

from markdown import number, seconds, table

DEFAULT = {"surface": "blend", "weighting": "petrov_galerkin"}  # of static scenes
NODE = {"surface": "blend", "weighting": "node"}  # of scenes with a dynamic stage
MORTAR = {"surface": "blend", "weighting": "mortar"}

# study, the run by its axes, quantities
ROWS = [
    *[("taylor_patch", {"pattern": pattern, "side": "fine_slave", "mesh": "5_on_4"} | method, ["worst_pressure"])
      for pattern in ("quad", "triangle", "hybrid") for method in (DEFAULT, NODE)],
    *[("hertz_sphere", {"model": "quarter", "side": side, "mesh": mesh} | DEFAULT,
       ["peak_pressure", "contact_radius", "profile"])
      for mesh in ("8_across", "16_across") for side in ("ball_master", "ball_slave")],
    *[("hertz_cylinder", {"model": "quarter", "side": side, "mesh": mesh} | DEFAULT,
       ["peak_pressure", "half_width", "profile"])
      for mesh in ("8_across", "16_across") for side in ("cylinder_master", "cylinder_slave")],
    *[("cattaneo_mindlin", {"side": "cylinder_master", "mesh": "40_across"} | method, ["stick_half_width", "peak_traction"])
      for method in (DEFAULT, NODE)],
    *[("nested_tubes", {"side": "inner_slave", "mesh": "40_in_32"} | method, ["ripple", "mean_pressure"])
      for method in (DEFAULT, NODE)],
    *[("half_tube_ripple", {"sliding_step": "0.1m", "tube": tube} | DEFAULT, ["ripple", "friction"])
      for tube in ("base", "halved", "quartered")],
    ("half_tube_ripple", {"sliding_step": "0.025m", "tube": "base"} | DEFAULT, ["ripple"]),
    ("half_tube_ripple", {"sliding_step": "0.1m", "tube": "base"} | NODE, ["ripple"]),
    *[("foundation", {"soil": soil, "mesh": "given"} | method, ["roughness"])
      for soil in ("quad", "tri", "hybrid") for method in (DEFAULT, NODE)],
    ("foundation", {"soil": "quad", "mesh": "given"} | DEFAULT, ["force"]),
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
    ("table1", "sphere", "1", "blend", ["position", "normal"]),
    ("table1", "saddle", "1", "blend", ["position", "normal"]),
    ("surface_convergence", "sphere", "5", "blend", ["position", "normal", "curvature"]),
    ("surface_convergence", "torus", "5", "blend", ["position", "normal", "curvature"]),
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


def hertz_aims(s, name, sides, quantities):
    study = s[name]
    one = problem(name, study.texts)
    for mesh, aims in (("8_across", (0.005, 0.006, 0.008)), ("16_across", (0.0015, 0.002, 0.002))):
        for quantity, aim in zip(quantities, aims):
            yield within(one, f"{study.texts['quantities'][quantity]['label']}, {mesh.replace('_', ' elements ')}, worse side "
                              "as master", worst(study, quantity, model="quarter", mesh=mesh, **DEFAULT), aim)
    sums = [[sum(float(row[f"{q}.error"]) for q in quantities) for row in study.only(model="quarter", side=side, **DEFAULT)]
            for side in sides]
    rises = sum(fine > coarse for of_side in sums for coarse, fine in zip(of_side, of_side[1:]))
    yield within(one, f"refinements that raise the sum of the three, of {sum(len(of) - 1 for of in sums)}", rises, 0, str)
    both = [(float(a["peak_pressure.value"]), float(b["peak_pressure.value"])) for side in sides
            for a, b in [(study.one(model="full", side=side, mesh="8_across", **DEFAULT),
                          study.one(model="quarter", side=side, mesh="8_across", **DEFAULT))]]
    yield within(one, "largest pressure, full against quarter model", max(abs(a / b - 1) for a, b in both), 1e-6,
                 lambda v: number(v, 2))


def patch_aims(s):
    study = s["taylor_patch"]
    one = problem("taylor_patch", study.texts)
    short = lambda v: number(v, 2)
    for pattern in ("quad", "triangle", "hybrid"):
        for surface in ("blend", "rpim", "facets"):
            ask = dict(pattern=pattern, surface=surface)
            label = f"pressure of the worst node, {pattern}{'' if surface == 'blend' else ', ' + surface}, worst of sides and meshes"
            yield within(one, label, worst(study, "worst_pressure", weighting="petrov_galerkin", **ask), 1e-10, short)
    for weighting in ("mortar", "node"):
        yield beside(one, f"the same, {weighting}, worst of all", short(worst(study, "worst_pressure", weighting=weighting)))


def tube_aims(s):
    study = s["nested_tubes"]
    for side in ("inner_slave", "outer_slave"):
        one = problem("nested_tubes", study.texts)
        yield within(one, f"ripple, {side}, mesh given", worst(study, "ripple", side=side, mesh="40_in_32", **DEFAULT), 0.001)
        for other in (MORTAR, NODE):
            yield beside(one, f"the same, {other['weighting']}",
                         percent(worst(study, "ripple", side=side, mesh="40_in_32", **other)))


def foundation_aims(s):
    study = s["foundation"]
    one = problem("foundation", study.texts)
    for soil in ("tri", "hybrid"):
        ask = dict(soil=soil, surface="blend", mesh="given")
        for what, where in (("roughness", ""), ("inner_roughness", " 1 m and more from the edges")):
            ratio = lambda weighting: (worst(study, what, weighting=weighting, **ask)
                                       / worst(study, what, weighting="node", **ask))
            yield within(one, f"roughness{where} over that with node, {soil}", ratio("petrov_galerkin"), 0.5,
                         lambda v: number(v, 2))
            yield beside(one, "the same, mortar over node", number(ratio("mortar"), 2))


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
    for step, tube, aim in (("0.1m", "base", 0.005), ("0.1m", "halved", 0.003), ("0.1m", "quartered", 0.001),
                            ("0.025m", "base", 0.004)):
        yield within(one, f"ripple, {tube} tube, steps of {step}",
                     worst(study, "ripple", sliding_step=step, tube=tube, **DEFAULT), aim)
    for tube in ("base", "halved", "quartered"):
        yield within(one, f"D/(mu N) less 1, {tube} tube",
                     worst(study, "friction", sliding_step="0.1m", tube=tube, **DEFAULT), 0.001)
    for other in (NODE, MORTAR):
        yield beside(one, f"ripple, {other['weighting']}, base and halved tube", ", ".join(
            percent(worst(study, "ripple", sliding_step="0.1m", tube=tube, **other)) for tube in ("base", "halved")))
    cpu = lambda tube, method: study.values("cpu_seconds", sliding_step="0.1m", tube=tube, **method)[0]
    yield beside(one, "CPU seconds over those of node: base, between, halved, quartered tube", ", ".join(
        number(cpu(tube, DEFAULT) / cpu(tube, NODE), 2) for tube in ("base", "between", "halved", "quartered")))
    runs = {m["weighting"] + m["surface"]: [(float(r["cpu_seconds"]), float(r["ripple.error"]))
                                            for r in study.only(sliding_step="0.1m", **m) if r["ripple.error"]]
            for m in (DEFAULT, {"surface": "facets", "weighting": "node"})}
    facets, best = runs["nodefacets"], runs["petrov_galerkinblend"]
    shared = cost_ratio(facets, best)
    yield beside(one, "CPU seconds of facets with node over those of the default at equal ripple",
                 f"{shared[0]:.3g} (at {percent(shared[1])})" if shared else
                 f"no ripple in common: facets {span(facets)}, default {span(best)}")
    # at the time of each run with the default: its ripple over the least that facets reach by then
    least = lambda of, time: min((e for t, e in of if t <= time), default=math.inf)
    yield within(one, "ripple over the least with facets and node for no more CPU seconds, worst run",
                 max(least(best, time) / least(facets, time) for time, _ in best), 1, lambda v: number(v, 2))


def slip_aims(s):
    study = s["cattaneo_mindlin"]
    one = problem("cattaneo_mindlin", study.texts)
    for quantity, aim in (("stick_half_width", 0.003), ("peak_traction", 0.01)):
        label = study.texts["quantities"][quantity]["label"]
        yield within(one, f"{label}, 40 elements across, worse side as master",
                     worst(study, quantity, mesh="40_across", **DEFAULT), aim)
        for other in (NODE, MORTAR):
            yield beside(one, f"the same, {other['weighting']}",
                         percent(worst(study, quantity, mesh="40_across", **other)))


def surface_aims(s):
    study = s["table1"]
    for surface in ("sphere", "saddle"):
        for kind in ("position", "normal"):
            ratios = [float(row[f"{kind}.mean"])
                      / float(study.one(surface=surface, mesh=row["mesh"], method="facets")[f"{kind}.mean"])
                      for row in study.only(surface=surface, method="blend")]
            yield within(problem("table1", study.texts), f"error of {kind} over that of facets, {surface}, geometric mean "
                         "over the meshes", math.exp(sum(map(math.log, ratios)) / len(ratios)), 1, lambda v: number(v, 3))


AIMS = {
    "hertz_sphere": lambda s: hertz_aims(s, "hertz_sphere", ("ball_master", "ball_slave"),
                                         ["peak_pressure", "contact_radius", "profile"]),
    "hertz_cylinder": lambda s: hertz_aims(s, "hertz_cylinder", ("cylinder_master", "cylinder_slave"),
                                           ["peak_pressure", "half_width", "profile"]),
    "cattaneo_mindlin": slip_aims, "taylor_patch": patch_aims, "nested_tubes": tube_aims, "foundation": foundation_aims,
    "half_tube_ripple": half_tube_aims, "table1": surface_aims,
}

HEAD = """# Verification: the scoreboard

{problems} problems with known answers. Every figure comes from the runs of `scripts/pages/verification`, which writes this page
and the pages it links to from the tables in `data`; do not edit them. Settings are the defaults unless a row says
otherwise: `blend`, with `petrov_galerkin` in static scenes and `node` in those with a dynamic stage. CPU seconds are those of one run on one thread, on the machine of the last run.

{summary}
"""
TAIL = """## What is compared

Tests (`ctest -R docs`) generate this page, the pages of the studies, [results](../results.md), and the table and figures in
the README, the [limits](../limits.md) and the theory again from the stored tables. They fail on any difference. Pictures show the
same runs as the tables beside them. The tests do not cover:

- times of kernels by `scripts/measure/bench`: the table of evaluations of [performance](../performance.md) and all tables of
  [search](../search.md);
- what an older OpenBLAS costs on some machines, in performance;
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
    if missed:
        summary += "\n\nThe pages of these problems say why, under *known defects*."
    return "\n".join([
        HEAD.format(problems=len(s), summary=summary), "## Aims\n",
        table(["problem", "figure", "aim", "measured", ""], aims), "## Problems\n",
        table(["problem", "reference", "settings", "quantity", "value", "error", "CPU s", "command"], rows), TAIL])
