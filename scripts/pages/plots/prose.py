"""Figures quoted in running text: what a file must say, from the stored data."""
import csv
import re
from pathlib import Path

STUDIES = Path("docs/verification/data")


def span(values, digits=1):
    """"1.4 to 2.1"; one number where both ends read the same."""
    ends = [f"{end:.{digits}f}" for end in (min(values), max(values))]
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def cpu_ratios(runs, scenes, master, other):
    return [runs[scene][master]["seconds"]["cpu"] / runs[scene][other]["seconds"]["cpu"] for scene in scenes]


def read(name):
    with open(STUDIES / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def option_ratios(surface, mesh, method):
    """Mean errors over those of blend_2: position, normal, curvature."""
    rows = {row["method"]: row for row in read("surface_options") if (row["surface"], row["mesh"]) == (surface, mesh)}
    return [float(rows[method][f"{kind}.mean"]) / float(rows["blend_2"][f"{kind}.mean"])
            for kind in ("position", "normal", "curvature")]


def options(surfaces, meshes, method):
    return [ratio for surface in surfaces for mesh in meshes for ratio in option_ratios(surface, mesh, method)]


def inverse(values):
    return [1 / value for value in values]


def discretisations():
    """Rows of the table of docs/discretisations.md."""
    def pick(study, column, **where):
        return [float(row[column]) for row in read(study)
                if row[column] and all(row[key] == value for key, value in where.items())]

    def cells(of):
        return " | ".join(of(weighting) for weighting in ("petrov_galerkin", "mortar", "node"))

    def patch(weighting):
        worst = max(pick("taylor_patch", "worst_pressure.error", weighting=weighting))
        return "to round-off" if worst < 1e-10 else f"wrong by up to {100 * worst:.0f} %"

    yield f"| patch test, worst node, worst of meshes and sides | {cells(patch)} |"
    ripple = lambda tube: lambda w: f"{100 * pick('half_tube_ripple', 'ripple.error', surface='blend', weighting=w, sliding_step='0.1m', tube=tube)[0]:.2f} %"
    yield f"| half-tube, ripple | {cells(ripple('base'))} |"
    yield f"| the same, tube's mesh halved | {cells(ripple('halved'))} |"
    for side in ("inner_slave", "outer_slave"):
        tubes = lambda w: f"{100 * pick('nested_tubes', 'ripple.error', surface='blend', weighting=w, side=side, mesh='40_in_32')[0]:.2f} %"
        yield f"| tubes one inside the other, ripple of the pressure, `{side}` | {cells(tubes)} |"
    for title, mesh in (("Hertz, ball, 8 elements across: peak, radius", "8_across"), ("16 elements across", "16_across")):
        hertz = lambda w: ", ".join(format(100 * max(pick("hertz_sphere", what + ".error", model="quarter", surface="blend",
                                                          weighting=w, mesh=mesh)), ".2f")
                                    for what in ("peak_pressure", "contact_radius")) + " %"
        yield f"| {title} | {cells(hertz)} |"
    rough = lambda w: f"{pick('foundation', 'inner_roughness.error', soil='tri', surface='blend', weighting=w, mesh='given')[0]:.2g}"
    yield f"| foundation on triangles, roughness 1 m and more from the edges | {cells(rough)} |"
    cpu = lambda w: span([pick("half_tube_ripple", "cpu_seconds", surface="blend", weighting=w, sliding_step="0.1m", tube=tube)[0]
                          / pick("half_tube_ripple", "cpu_seconds", surface="blend", weighting="node", sliding_step="0.1m", tube=tube)[0]
                          for tube in ("base", "between", "halved")])
    yield f"| half-tube, CPU time over that of `node` | {cpu('petrov_galerkin')} | {cpu('mortar')} | 1 |"


def claims(runs):
    """(file, text it must hold); spaces and line ends are alike."""
    ripple = lambda method: (f"{runs['half_tube'][method]['ripple']:.2f} and "
                             f"{runs['half_tube_halved'][method]['ripple']:.2f} %")
    foundations = [f"foundation_{mesh}" for mesh in ("quad", "tri", "hybrid")]
    yield "docs/limits.md", (
        f"The driving force of the half-tube still ripples by {ripple('default')} with the tube's mesh as it is and halved (in "
        f"steps of 0.025 m by {runs['half_tube_fine_steps']['default']['ripple']:.2f} %). At slave nodes (`node`) `blend` ripples "
        f"by {ripple('blend')}, `rpim` by {ripple('rpim')}, `facets` without hysteresis by {ripple('facets_h0')}.")
    yield "docs/limits.md", (
        f"the default takes {span(cpu_ratios(runs, foundations, 'default', 'facets'))} times the CPU time of `facets` with `node`, "
        f"`blend` with `node` {span(cpu_ratios(runs, foundations, 'blend', 'facets'))} times.")
    for line in discretisations():
        yield "docs/discretisations.md", line
    searches = [run["seconds"]["search"] for scene in foundations for run in runs[scene].values()]
    yield "docs/search.md", f"the search takes {span(searches, 2)} s of the foundation runs"

    ends, every = ("1", "4"), ("sphere", "torus", "saddle")
    r5 = options(every, ends, "blend_2_r5")
    yield "docs/theory.md", f"2 rings are {span(options(every, ends, 'blend_1'))} times better than 1."
    yield "docs/theory.md", (
        f"r^5 with 2 rings is {span(inverse(r for r in r5 if r < 1))} times better where the mesh resolves the surface, and up "
        f"to {max(r5):.1f} times worse where it does not")
    sphere, torus, saddle = (options([surface], ends, "blend_2_r3") for surface in every)
    yield "docs/theory.md", (
        f"r^3 with 2 rings is within {100 * max(abs(r - 1) for r in sphere):.0f} % of the multiquadric on the sphere, better on "
        f"the torus by {span(inverse(torus))}, and on the saddle from {100 * (max(saddle) - 1):.0f} % worse to "
        f"{1 / min(saddle):.1f} times better.")


def faults(runs):
    plain = lambda text: re.sub(r"\s+", " ", text)
    return [f"{path} should say: {text}" for path, text in claims(runs) if plain(text) not in plain(Path(path).read_text())]
