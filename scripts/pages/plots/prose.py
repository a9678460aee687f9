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


def weightings():
    """Rows of README's table of node and mortar."""
    def pick(study, column, **where):
        return [float(row[column]) for row in read(study) if all(row[key] == value for key, value in where.items())]

    def worst(study, column, **where):
        return max(pick(study, column, **where))

    patch = pick("taylor_patch", "worst_pressure.error", weighting="node")
    yield f"| patch test, worst node | fails by {span([100 * error for error in patch], 0)} % |"
    for title, tube in (("half-tube, ripple with `blend`", "base"), ("the same, tube's mesh halved", "halved")):
        node, mortar = (100 * worst("half_tube_ripple", "ripple.error", surface="blend", weighting=weighting,
                                    sliding_step="0.1m", tube=tube) for weighting in ("node", "mortar"))
        yield f"| {title} | {node:.2f} % | {mortar:.2f} % |"
    for title, mesh in (("Hertz, ball, `blend`, 8 elements across: peak, radius", "8_across"),
                        ("16 elements across", "16_across")):
        node, mortar = (", ".join(format(100 * worst("hertz_sphere", what + ".error", model="quarter", surface="blend",
                                                     weighting=weighting, mesh=mesh), ".2f") for what in ("peak_pressure", "contact_radius"))
                        for weighting in ("node", "mortar"))
        yield f"| {title} | {node} % | {mortar} % |"
    cpu = [pick("half_tube_ripple", "cpu_seconds", surface="blend", weighting="mortar", sliding_step="0.1m", tube=tube)[0]
           / pick("half_tube_ripple", "cpu_seconds", surface="blend", weighting="node", sliding_step="0.1m", tube=tube)[0]
           for tube in ("base", "between", "halved")]
    yield f"| half-tube with `blend`, CPU time over that of `node` | 1 | {span(cpu)} |"


def claims(runs):
    """(file, text it must hold); spaces and line ends are alike."""
    ripple = lambda name, master: f"{runs[name][master]['ripple']:.2f}"
    foundations = [f"foundation_{mesh}" for mesh in ("quad", "tri", "hybrid")]
    yield "README.md", (
        f"{ripple('half_tube', 'blend')} % against 1.2 %, and {ripple('half_tube_halved', 'blend')} % against 0.4 % with the "
        f"tube's mesh halved (in steps of 0.025 m: {ripple('half_tube_fine_steps', 'blend')} %, aim 1.5 %). 3 rings (`surface: "
        f"{{blend: {{ring: 3}}}}`) give {ripple('half_tube', 'blend_ring3')} and {ripple('half_tube_halved', 'blend_ring3')} %, "
        f"for {span(cpu_ratios(runs, ['half_tube', 'half_tube_halved', *foundations], 'blend_ring3', 'blend'))} times the CPU "
        f"time. `rpim` ripples less, {ripple('half_tube', 'rpim')} and {ripple('half_tube_halved', 'rpim')} %, with kinks.")
    yield "README.md", (
        f"`blend` takes {span(cpu_ratios(runs, foundations, 'blend', 'facets'))} times the CPU time of `facets`, `rpim` "
        f"{span(cpu_ratios(runs, foundations, 'rpim', 'facets'))} times.")
    for line in weightings():
        yield "README.md", line
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
