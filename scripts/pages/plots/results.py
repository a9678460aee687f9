"""docs/results.md and the README's table, from docs/data/figures.json: what scripts/pages/figures measured in the runs.

    results.py --check      exit 1 where a page, or a figure quoted in prose, is not what the data make it
"""
import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import prose  # noqa: E402
from common import STAMP  # noqa: E402
from markdown import number, table

DATA = Path("docs/data/figures.json")
RESULTS = Path("docs/results.md")
README = Path("README.md")
METHODS = ("facets", "facets_h0", "rpim", "blend", "default")
TITLES = {"facets": "`facets`, `node`", "facets_h0": "`facets`, `node`, `hysteresis: 0`", "rpim": "`rpim`, `node`",
          "blend": "`blend`, `node`", "default": "default: `blend`, `petrov_galerkin`"}
RIPPLES = {"half_tube": "0.1 m steps", "half_tube_fine_steps": "0.025 m steps", "half_tube_halved": "halved tube"}
# the half-tube with the defaults, one thing changed at a time: what, (run, method)
OPTIONS = {
    "nothing": ("half_tube", "default"),
    "`blend` of 3 rings": ("half_tube", "default_ring3"),
    "basis `multiquadric`": ("half_tube", "default_multiquadric"),
    "basis `r3`": ("half_tube", "default_r3"),
    "basis `r5`": ("half_tube", "default_r5"),
    "hexahedra `b_bar`": ("half_tube_b_bar", "default"),
    "hexahedra `incompatible_modes`": ("half_tube_incompatible_modes", "default"),
}
INERTIA = {"half_tube_dynamic": 30, "half_tube_fast": 0.3}  # with inertia: seconds of the slide
LINES = {"half_tube_line": "along the tube", "half_tube_line_axial": "around the tube"}
MESHES = ("quad", "tri", "hybrid")
MU = 0.1  # friction of every scene
THREADS = 2
PARTS = {"search": "search", "patches": "patches", "contact": "contact", "assembly": "assembly",
         "factor": "factorisation", "solve": "solves", "output": "output"}


def title(method):
    return TITLES[method]


def fixed(value, digits):
    return "-" if value is None else number(value, digits, "f")


def section(title, header, rows):
    return f"## {title}\n{table(header, rows)}"


def both_seconds(run):
    return [fixed(run["seconds"][kind], 1) for kind in ("total", "cpu")]


def half_tube_table(runs):
    rows = []
    for method in METHODS:
        run = runs["half_tube"][method]
        N, D = run["normal"], run["driving"]
        press, slide, worst, cuts = run["iterations"]
        rows.append([title(method), fixed(N / 1e6, 3), fixed(D / 1e6, 4), fixed(D / (MU * N), 4), press, fixed(slide, 2),
                     worst, cuts, f"{run['first_residual']:.0e}", *both_seconds(run)])
    return section("Half-tube: pressed, then slid by 3 m",
                   ["method", "N, MN", "D, MN", "D/(mu N)", "iterations: press", "mean of the slides",
                    "most of a slide", "cut steps", "last residual of the press", "seconds", "CPU seconds"], rows)


def ripple_table(runs):
    rows = [[title(method), *(fixed(runs[name][method]["ripple"], 2) for name in RIPPLES)] for method in METHODS]
    return section("Half-tube: ripple of the driving force, peak-to-peak over mean, %", ["method", *RIPPLES.values()], rows)


def options_table(runs):
    rows = [[what, fixed(runs[name][method]["ripple"], 2), fixed(runs[name][method]["iterations"][1], 2)]
            for what, (name, method) in OPTIONS.items()]
    return section("Half-tube with the defaults: ripple with one thing changed",
                   ["changed", "ripple, 0.1 m steps, %", "iterations: mean of the slides"], rows)


def inertia_table(runs):
    static = runs["half_tube"]["blend"]
    rows = [["static", fixed(static["driving"] / 1e6, 4), *["-"] * 4, static["attempts"], *both_seconds(static)]]
    for name, duration in INERTIA.items():
        run = runs[name]["blend"]
        rows.append([f"{duration} s", fixed(run["friction"] / 1e6, 4), fixed(run["kinetic"] / 1e6, 4),
                     fixed(run["friction_work"] / 1e6, 3), fixed(run["algorithmic"] / 1e6, 4), f"{run['unbalance']:.0e}",
                     run["attempts"], *both_seconds(run)])
    return section("Half-tube with inertia: the same 3 m in 30 s and in 0.3 s, `blend`, `node`",
                   ["slide", "friction, MN, mean of 0.5 to 2.9 m", "largest kinetic energy, MJ", "friction work, MJ",
                    "algorithmic dissipation, MJ", "largest unbalance of the ledger / energy", "attempts", "s", "CPU s"],
                   rows)


def foundation_table(runs):
    rows = []
    for mesh in MESHES:
        for method in METHODS:
            run, tight = (runs[f"foundation_{mesh}{which}"][method] for which in ("", "_tight"))
            rows.append([mesh, title(method), fixed(run["roughness"], 4), fixed(run["normal"] / 1e6, 3),
                         run["iterations"][0], tight["iterations"][0] if tight["status"] == "done" else "-",
                         f"{tight['last_residual']:.0e}"])
    return section("Foundation: pressed on soil, three divisions of the soil's surface",
                   ["soil surface", "method", "roughness", "N, MN", "iterations", "to `solver.tolerance: 1e-12`",
                    "residual then"], rows)


def cost_table(runs):
    rows = []
    for mesh in MESHES:
        of_mesh = runs[f"foundation_{mesh}"]
        for method in METHODS:
            of, facets = of_mesh[method]["seconds"], of_mesh["facets"]["seconds"]
            both = [cell for kind in ("total", "cpu") for cell in (fixed(of[kind], 1), fixed(of[kind] / facets[kind], 2))]
            rows.append([mesh, title(method), *both, *(fixed(of[part], 2) for part in PARTS),
                         of_mesh[method]["factorisations"]])
    return section(f"Foundation: seconds, {THREADS} threads",
                   ["soil surface", "method", "total", "over facets", "CPU", "over facets", *PARTS.values(),
                    "factorisations"], rows)


def line_table(runs):
    rows = []
    for name, what in LINES.items():
        for method in METHODS:
            run = runs[name][method]
            press, slide, worst, cuts = run["iterations"]
            rows.append([what, title(method), run["status"], press, fixed(slide, 2), worst, cuts,
                         " ".join(map(str, run["status_changes"])), " ".join(f"{r:.0e}" for r in run["residuals"])])
    return section("Half-tube, a mesh line of the contactor on one of the tube",
                   ["mesh line", "method", "ended", "iterations: press", "mean of 10 slides", "most of a slide",
                    "cut steps", "status changes at the iterates of the pressure step", "its last four residuals"], rows)


def readme_table(runs):
    rows = []
    for method in METHODS:
        run, foundation = runs["half_tube"][method], runs["foundation_quad"][method]
        press, slide, *_ = run["iterations"]
        rows.append([title(method), fixed(run["normal"] / 1e6, 2),
                     fixed(run["driving"] / (MU * run["normal"]), 4), fixed(run["ripple"], 2),
                     fixed(runs["half_tube_halved"][method]["ripple"], 2), f"{press}, {fixed(slide, 1)}",
                     fixed(foundation["roughness"], 3), fixed(foundation["seconds"]["cpu"], 1)])
    return table(["half-tube, mu = 0.1", "N, MN", "D/(mu N)", "ripple of D, %", "with the tube's mesh halved",
                  "iterations: press, mean of the slides", "foundation: roughness", "CPU seconds"], rows)


def results_page(runs):
    tables = (half_tube_table, ripple_table, options_table, inertia_table, foundation_table, cost_table, line_table)
    return RESULTS_HEAD + "\n".join(make(runs) for make in tables)


def readme_page(runs):
    head, rest = README.read_text().split("<!-- figures -->\n")
    tail = rest.split("<!-- end -->\n")[1]
    return f"{head}<!-- figures -->\n{readme_table(runs)}\n<!-- end -->\n{tail}"


def pages():
    runs = json.loads(DATA.read_text())
    return {RESULTS: results_page(runs), README: readme_page(runs)}


def main():
    if sys.argv[1:] != ["--check"]:
        sys.exit(__doc__)
    wrong = [f"{path} is not what {DATA} makes it" for path, text in pages().items() if STAMP.sub("", path.read_text()) != text]
    wrong += prose.faults(json.loads(DATA.read_text()))
    for line in wrong:
        print(line)
    sys.exit(1 if wrong else 0)


RESULTS_HEAD = """# Results

`scripts/pages/figures` runs the scenes of `configs/paper` and writes this page; do not edit it. Seconds are those of the
fastest of at least three runs, on the machine of the last run. Other programs ran on that machine too, so CPU seconds compare
better. A method is a master surface and a discretisation; `rpim` and `blend` have their defaults, 2 rings and, with `node`, the
multiquadric with R = 1.42, q = 1.03, m = 6. Facets change the facet of a node only for one that is closer by 3 % of its size
(`hysteresis`), which hides a part of their ripple and biases D; the rows with `hysteresis: 0` have neither.

- N is the sum of the nodal normal forces, D is the force that drives the contactor. Means and ripples are taken over
  distances from 0.5 m on, which are the paper's sliding steps 5 to 30. Steps of 0.1 m on facets of 1 m miss the
  extremes of the ripple.
- *Halved* is the tube with twice as many facets in both directions (`[26, 24, 3]`), 0.375 x 0.5 m.
- Roughness is the root mean square of the second differences of the nodal contact pressure along y = 0, divided by the
  mean pressure. The end nodes are left out.
- Residuals are divided by the reference force ([theory](theory.md), section 6). They are largest components, except the last
  four of the mesh lines, which are 2-norms. The linear systems are solved only to a tenth of `solver.tolerance`.

![Driving force over sliding distance](images/friction.png)

![Friction over the distance of the driven rear, with inertia](images/inertia.png)

![Contact pressure along the centre line of the foundation](images/pressure.png)

"""

if __name__ == "__main__":
    main()
