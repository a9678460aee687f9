"""Runs the scenes, draws the pictures of docs/images and prints the figures quoted in README.md and docs.

    figures.py [--keep] OSCULATE      called by scripts/figures, from the root of the repository
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import vtk

RUNS = Path("out/figures")
IMAGES = Path("docs/images")
# name of a master: its value of the key `surface`
SURFACES = {
    "facets": "facets", "rpim": "rpim", "blend": "blend", "blend_ring3": "{blend: {ring: 3}}",
    "blend_r3": "{blend: {basis: r3}}", "blend_r5": "{blend: {basis: r5}}", "blend_q05": "{blend: {q: 0.5}}",
}
TITLES = {"blend_ring3": "blend, 3 rings"}
MASTERS = ("facets", "rpim", "blend", "blend_ring3")
DRAWN = MASTERS[:3]
LINES = {"facets": 'lw 1.5 lc rgb "#d95f02" title "facets"', "rpim": 'lw 1.5 lc rgb "#1f78b4" title "rpim"',
         "blend": 'lw 2 lc rgb "#111111" title "blend"'}
MU = 0.1  # friction of every scene below
THREADS = 2
TIMED = ("half_tube", "foundation_quad", "foundation_tri", "foundation_hybrid")
REPETITIONS = 3  # of these; the fastest is kept

HALVED = "bodies.tube.mesh.half_tube.divisions=[26, 24, 3]"
# name of a run: scene, pair, further settings; each runs once per master
SCENES = {
    "half_tube": ("half_tube", "sliding", []),
    "half_tube_fine_steps": ("half_tube", "sliding", ["stages.slide.steps=120"]),
    "half_tube_halved": ("half_tube", "sliding", [HALVED]),
    "foundation_quad": ("foundation_quad", "base", []),
    "foundation_tri": ("foundation_tri", "base", []),
    "foundation_hybrid": ("foundation_hybrid", "base", []),
    "foundation_quad_tight": ("foundation_quad", "base", ["solver.tolerance=1e-12"]),
    "foundation_tri_tight": ("foundation_tri", "base", ["solver.tolerance=1e-12"]),
    "foundation_hybrid_tight": ("foundation_hybrid", "base", ["solver.tolerance=1e-12"]),
    "half_tube_line": ("half_tube_line", "sliding", []),
    "half_tube_line_axial": ("half_tube_line_axial", "sliding", []),
}
# the half-tube with blend, one thing changed at a time: what, (run, master)
HEXAHEDRA = "bodies.{}.hex_formulation={}"
SCENES |= {f"half_tube_{f}": ("half_tube", "sliding", [HEXAHEDRA.format(body, f) for body in ("tube", "contactor")])
           for f in ("b_bar", "incompatible_modes")}
OPTIONS = {
    "blend as it is": ("half_tube", "blend"),
    "basis `r3`": ("half_tube", "blend_r3"),
    "basis `r5`": ("half_tube", "blend_r5"),
    "multiquadric with `q: 0.5`": ("half_tube", "blend_q05"),
    "hexahedra `b_bar`": ("half_tube_b_bar", "blend"),
    "hexahedra `incompatible_modes`": ("half_tube_incompatible_modes", "blend"),
}
# with inertia: name of a run and scene, seconds of the slide
INERTIA = {"half_tube_dynamic": 30, "half_tube_fast": 0.3}
SCENES |= {name: (name, "sliding", []) for name in INERTIA}
RUNS_OF_OPTIONS = set(OPTIONS.values()) | {(name, "blend") for name in INERTIA}


def folder(name, master):
    return RUNS / f"{name}_{master}"


def runs():
    named = [(name, master) for name in SCENES for master in MASTERS if (name, "blend") not in RUNS_OF_OPTIONS]
    return named + [("half_tube", master) for master in MASTERS] + sorted(RUNS_OF_OPTIONS - {("half_tube", "blend")})


def run_scenes(osculate, keep):
    # the sparse solvers call small dense kernels, where threads cost more than they give
    environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} | os.environ
    for name, master in runs():
        scene, pair, settings = SCENES[name]
        where = folder(name, master)
        done = where / "summary.json"
        if keep and done.is_file() and json.loads(done.read_text())["status"] == "done":
            continue
        words = [word for setting in [f"contact.{pair}.surface={SURFACES[master]}", *settings]
                 for word in ("--set", setting)]
        least = math.inf
        for _ in range(REPETITIONS if name in TIMED else 1):
            print(f"running {name} with {master} ...", file=sys.stderr, flush=True)
            last = RUNS / "last"
            shutil.rmtree(last, ignore_errors=True)
            ended = subprocess.run([osculate, "run", f"configs/paper/{scene}.yaml", "-o", last, "--quiet",
                                    "--threads", str(THREADS), *words], env=environment)
            # a run that gives up (exit 3) is a result, too
            if ended.returncode not in (0, 3):
                sys.exit(f"figures: {name} with {master} ended with exit code {ended.returncode}")
            total = json.loads((last / "summary.json").read_text())["seconds"]["total"]
            if total < least:
                least = total
                shutil.rmtree(where, ignore_errors=True)
                last.rename(where)


def table(path):
    with open(path, newline="") as file:
        return [{key: float(value) if value else None for key, value in row.items()} for row in csv.DictReader(file)]


def summary(name, master):
    return json.loads((folder(name, master) / "summary.json").read_text())


def attempts(name, master):
    with open(folder(name, master) / "steps.csv", newline="") as file:
        return list(csv.DictReader(file))


def mean(values):
    return sum(values) / len(values)


def slides(name, master):
    """Rows of the history after the pressure step."""
    return table(folder(name, master) / "history.csv")[1:]


def centre_line(name, master):
    """(x, pressure) of the slave nodes on y = 0 at the end: contact force along the normal over tributary area."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(sorted((folder(name, master) / "frames").glob("base.slave_*.vtp"))[-1]))
    reader.Update()
    surface = reader.GetOutput()
    stress = surface.GetPointData().GetArray("normal_stress")
    points = [(surface.GetPoint(i), stress.GetValue(i)) for i in range(surface.GetNumberOfPoints())]
    return sorted((p[0], value) for p, value in points if abs(p[1]) < 1e-9)


def roughness(pressures):
    """Root mean square second difference over the mean, without the singular nodes at the foundation's edges."""
    p = pressures[1:-1]
    second = [a - 2 * b + c for a, b, c in zip(p, p[1:], p[2:])]
    return math.sqrt(mean([d * d for d in second])) / mean(p[1:-1])


def iterations(name, master):
    """Of the first step, mean and largest of the others; all attempts of a step count. At last the attempts cut."""
    rows = attempts(name, master)
    steps, sum_ = [], 0
    for row in rows:
        sum_ += int(row["iterations"])
        if row["verdict"] == "accept":
            steps.append(sum_)
            sum_ = 0
    slides = steps[1:]
    return (steps[0] if steps else None, mean(slides) if slides else None, max(slides, default=None),
            len(rows) - len(steps))


def seconds(name, master):
    """Of the whole run: wall, CPU."""
    of = summary(name, master)["seconds"]
    return [number(of[kind], 1) for kind in ("total", "cpu")]


def title(master):
    return TITLES.get(master, master)


def table_of(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def markdown(title, header, rows):
    return f"## {title}\n{table_of(header, rows)}"


def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def late_forces(name, master):
    """Normal and driving force of the half-tube over the distances of the paper's sliding steps 5 to 30."""
    rows = slides(name, master)
    rows = rows[len(rows) // 6 - 1:]  # 30 steps or 120: from 0.5 m on
    return [row["pair.sliding.normal"] for row in rows], [abs(row["set.rear.reaction_y"]) for row in rows]


def ripple(name, master):
    _, D = late_forces(name, master)
    return 100 * (max(D) - min(D)) / mean(D)


def half_tube_table():
    rows = []
    for master in MASTERS:
        N, D = late_forces("half_tube", master)
        press, slide, worst, cuts = iterations("half_tube", master)
        rows.append([title(master), number(mean(N) / 1e6, 3), number(mean(D) / 1e6, 4),
                     number(mean(D) / (MU * mean(N)), 4), press, number(slide, 2), worst, cuts,
                     f"{float(attempts('half_tube', master)[0]['value']):.0e}",
                     *seconds("half_tube", master)])
    return markdown("Half-tube: pressed, then slid by 3 m",
                    ["master", "N, MN", "D, MN", "D/(mu N)", "iterations: press", "mean of the slides",
                     "most of a slide", "cut steps", "last residual of the press", "seconds", "CPU seconds"],
                    rows)


def driven(name):
    """Distance of the driven rear, m, and row of the history after every step of a slide with inertia."""
    rows = slides(name, "blend")
    begin, duration = rows[0]["time"] - rows[0]["dt"], INERTIA[name]
    parts = [(row["time"] - begin) / duration for row in rows]
    return [(3 * (s - math.sin(2 * math.pi * s) / (2 * math.pi)), row) for s, row in zip(parts, rows)]


def inertia_table():
    _, D = late_forces("half_tube", "blend")
    rows = [["static", number(mean(D) / 1e6, 4), *["-"] * 4, attempts("half_tube", "blend")[-1]["attempt"],
             *seconds("half_tube", "blend")]]
    for name, duration in INERTIA.items():
        steps = driven(name)
        friction = [row["pair.sliding.friction"] for y, row in steps if 0.5 <= y <= 2.9]
        last = steps[-1][1]
        energy = last["energy.friction"] + last["energy.kinetic"] + last["energy.strain"]
        balance = max(abs(row["energy.balance"]) for _, row in steps) / energy
        rows.append([f"{duration} s", number(mean(friction) / 1e6, 4), number(max(row["energy.kinetic"] for _, row in steps) / 1e6, 4),
                     number(last["energy.friction"] / 1e6, 3), number(last["energy.algorithmic"] / 1e6, 4), f"{balance:.0e}",
                     attempts(name, "blend")[-1]["attempt"], *seconds(name, "blend")])
    return markdown("Half-tube with inertia: the same 3 m in 30 s and in 0.3 s, blend",
                    ["slide", "friction, MN, mean of 0.5 to 2.9 m", "largest kinetic energy, MJ", "friction work, MJ",
                     "algorithmic dissipation, MJ", "largest unbalance of the ledger / energy", "attempts", "s", "CPU s"],
                    rows)


RIPPLES = {"half_tube": "0.1 m steps", "half_tube_fine_steps": "0.025 m steps", "half_tube_halved": "halved tube"}


def ripple_table():
    rows = [[title(master), *(number(ripple(name, master), 2) for name in RIPPLES)] for master in MASTERS]
    return markdown("Half-tube: ripple of the driving force, peak-to-peak over mean, %",
                    ["master", *RIPPLES.values()], rows)


def options_table():
    rows = [[what, number(ripple(*run), 2), number(iterations(*run)[1], 2)] for what, run in OPTIONS.items()]
    return markdown("Half-tube with blend: ripple with one thing changed",
                    ["changed", "ripple, 0.1 m steps, %", "iterations: mean of the slides"], rows)


MESHES = ("quad", "tri", "hybrid")


def foundation_table():
    rows = []
    for mesh in MESHES:
        for master in MASTERS:
            name, tight = f"foundation_{mesh}", f"foundation_{mesh}_tight"
            pressures = [value for _, value in centre_line(name, master)]
            last = table(folder(name, master) / "history.csv")[-1]
            rows.append([mesh, title(master), number(roughness(pressures), 4),
                         number(last["pair.base.normal"] / 1e6, 3), iterations(name, master)[0],
                         iterations(tight, master)[0] if summary(tight, master)["status"] == "done" else "-",
                         f"{float(attempts(tight, master)[-1]['value']):.0e}"])
    return markdown("Foundation: pressed on soil, three divisions of the soil's surface",
                    ["soil surface", "master", "roughness", "N, MN", "iterations", "to `solver.tolerance: 1e-12`",
                     "residual then"], rows)


PARTS = {"search": "search", "patches": "patches", "contact": "contact", "assembly": "assembly",
         "factor": "factorisation", "solve": "solves", "output": "output"}


def cost_table():
    rows = []
    for mesh in MESHES:
        for master in MASTERS:
            run = summary(f"foundation_{mesh}", master)
            of = run["seconds"]
            facets = summary(f"foundation_{mesh}", "facets")["seconds"]
            both = [cell for kind in ("total", "cpu")
                    for cell in (number(of[kind], 1), number(of[kind] / facets[kind], 2))]
            parts = [number(of[part], 2) for part in PARTS]
            rows.append([mesh, title(master), *both, *parts, run["factorisations"]])
    return markdown(f"Foundation: seconds, {THREADS} threads",
                    ["soil surface", "master", "total", "over facets", "CPU", "over facets", *PARTS.values(),
                     "factorisations"], rows)


def line_table():
    rows = []
    for name, what in (("half_tube_line", "along the tube"), ("half_tube_line_axial", "around the tube")):
        for master in MASTERS:
            press, slide, worst, cuts = iterations(name, master)
            lines = table(folder(name, master) / "iterations.csv")
            first = [row for row in lines if row["attempt"] == 1]
            rows.append([what, title(master), summary(name, master)["status"], press, number(slide, 2), worst, cuts,
                         " ".join(str(int(row["status_changes"])) for row in first),
                         " ".join(f"{row['residual']:.0e}" for row in first[-4:])])
    return markdown("Half-tube, a mesh line of the contactor on one of the tube",
                    ["mesh line", "master", "ended", "iterations: press", "mean of 10 slides", "most of a slide",
                     "cut steps", "status changes at the iterates of the pressure step", "its last four residuals"],
                    rows)


def readme_table():
    rows = []
    for master in MASTERS:
        N, D = late_forces("half_tube", master)
        press, slide, *_ = iterations("half_tube", master)
        pressures = [value for _, value in centre_line("foundation_quad", master)]
        rows.append([f"`{title(master)}`" if master in DRAWN else title(master), number(mean(N) / 1e6, 2),
                     number(mean(D) / (MU * mean(N)), 4), number(ripple("half_tube", master), 2),
                     number(ripple("half_tube_halved", master), 2), f"{press}, {number(slide, 1)}",
                     number(roughness(pressures), 3),
                     seconds("foundation_quad", master)[1]])
    return table_of(["half-tube, mu = 0.1", "N, MN", "D/(mu N)", "ripple of D, %", "with the tube's mesh halved",
                     "iterations: press, mean of the slides", "foundation: roughness", "CPU seconds"], rows)


def update_readme():
    path = Path("README.md")
    head, rest = path.read_text().split("<!-- figures -->\n")
    tail = rest.split("<!-- end -->\n")[1]
    path.write_text(f"{head}<!-- figures -->\n{readme_table()}\n\n<!-- end -->\n{tail}")


def gnuplot(script, **data):
    """Each data block is a list of (x, y, ...) rows, known to the script under its name."""
    blocks = "".join(f"${name} << EOD\n" + "\n".join(" ".join(map(repr, row)) for row in rows) + "\nEOD\n"
                     for name, rows in data.items())
    subprocess.run(["gnuplot"], input=blocks + script, text=True, check=True)


STYLE = """
set border 3 lc rgb "#444444"; set tics nomirror out textcolor rgb "#222222"
set grid ytics lc rgb "#dddddd" lt 1
set key top right samplen 2 spacing 1.2
"""


def draw_friction():
    curves = {master: [(0.025 * k, row["set.rear.reaction_y"] / 1e6)
                       for k, row in enumerate(slides("half_tube_fine_steps", master), 1)] for master in DRAWN}
    gnuplot(f"""
set terminal pngcairo size 900,380 font "sans,12" background "white"
set output "{IMAGES}/friction.png"
{STYLE}
set xlabel "sliding distance, m"; set ylabel "driving force, MN"
set xrange [0:3.05]; set yrange [1.64:1.80]; set ytics 0.04; set format y "%.2f"
set key bottom right
plot {", ".join(f"${master} with lines {LINES[master]}" for master in DRAWN)}
""", **curves)


def draw_inertia():
    static = [(0.1 * k, row["pair.sliding.friction"] / 1e6) for k, row in enumerate(slides("half_tube", "blend"), 1)]
    curves = {name: [(y, row["pair.sliding.friction"] / 1e6) for y, row in driven(name)] for name in INERTIA}
    gnuplot(f"""
set terminal pngcairo size 900,380 font "sans,12" background "white"
set output "{IMAGES}/inertia.png"
{STYLE}
set xlabel "distance of the driven rear, m"; set ylabel "friction, MN"
set xrange [0:3.05]; set yrange [1.6:1.9]; set format y "%.2f"
plot $static with linespoints pt 7 ps 0.5 lw 1.5 lc rgb "#111111" title "static", \\
     $half_tube_dynamic with lines lw 2 lc rgb "#1f78b4" title "in 30 s", \\
     $half_tube_fast with lines lw 1.5 lc rgb "#d95f02" title "in 0.3 s"
""", static=static, **curves)


def draw_pressure():
    curves = {f"{master}_{mesh}": [(x, p / 1e6) for x, p in centre_line(f"foundation_{mesh}", master)]
              for master in DRAWN for mesh in MESHES}
    panels = "".join(f"""
set title "{title}"
set ylabel "{'contact pressure, MPa' if mesh == 'quad' else ''}"
{'unset key' if mesh != 'hybrid' else 'set key top center'}
plot {", ".join(f"${master}_{mesh} with linespoints pt 7 ps 0.35 {LINES[master]}" for master in DRAWN)}
""" for mesh, title in (("quad", "quadrilaterals"), ("tri", "triangles"), ("hybrid", "both")))
    gnuplot(f"""
set terminal pngcairo size 1200,380 font "sans,12" background "white"
set output "{IMAGES}/pressure.png"
{STYLE}
set xlabel "x, m"; set xrange [-3.1:3.1]; set yrange [0.7:1.9]; set format y "%.1f"
set multiplot layout 1,3
{panels}
unset multiplot
""", **curves)


def draw_half_tube():
    subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1600x1200x24", "/usr/bin/python3",
                    Path(__file__).with_name("half_tube.py"), folder("half_tube", "blend"),
                    IMAGES / "half_tube.png"], check=True)


def main():
    arguments = sys.argv[1:]
    keep = "--keep" in arguments
    osculate = [a for a in arguments if a != "--keep"][0]
    run_scenes(osculate, keep)
    IMAGES.mkdir(parents=True, exist_ok=True)
    draw_friction()
    draw_pressure()
    draw_inertia()
    draw_half_tube()
    tables = (half_tube_table, ripple_table, options_table, inertia_table, foundation_table, cost_table, line_table)
    text = "\n\n".join(make() for make in tables) + "\n"
    Path("docs/results.md").write_text(RESULTS_HEAD + text)
    update_readme()
    print(text, end="")


RESULTS_HEAD = """# Results

Written by `scripts/figures`, which runs the scenes of `configs/paper`; edit nothing here. Seconds are those of the
machine it ran on last, the fastest of at least three runs; others were at work on it, so that CPU seconds compare better.
`rpim` and `blend` have their defaults, 2 rings and the multiquadric with R = 1.42, q = 1.03, m = 6, unless the tables say
otherwise.

- N is the sum of the nodal normal forces, D the force that drives the contactor; means and ripples are over distances
  from 0.5 m on, the paper's sliding steps 5 to 30. Steps of 0.1 m on facets of 1 m miss the extremes of the ripple.
- *Halved* is the tube with twice as many facets both ways (`[26, 24, 3]`), 0.375 x 0.5 m.
- Roughness is the root mean square second difference of the nodal contact pressure along y = 0 over its mean, end nodes
  left out.
- Residuals are over the reference force ([theory](theory.md), section 6): largest components, but for the last four of
  the mesh lines, which are 2-norms. The linear systems are solved no further than a tenth of `solver.tolerance`.

![Driving force over sliding distance](images/friction.png)

![Friction over the distance of the driven rear, with inertia](images/inertia.png)

![Contact pressure along the centre line of the foundation](images/pressure.png)

"""

if __name__ == "__main__":
    main()
