"""Runs the scenes, draws the pictures of docs/images and prints the figures quoted in README.md and docs.

    figures.py [--keep] OSCULATE      called by scripts/figures, from the root of the repository
"""
import csv
import json
import math
import subprocess
import sys
from pathlib import Path

import vtk

RUNS = Path("out/figures")
IMAGES = Path("docs/images")
MASTERS = ("facets", "rpim", "blend")
LINES = {"facets": 'lw 1.5 lc rgb "#d95f02" title "facets"', "rpim": 'lw 1.5 lc rgb "#1f78b4" title "rpim"',
         "blend": 'lw 2 lc rgb "#111111" title "blend"'}
MU = 0.1  # friction of every scene below

# name of a run: (scene, pair); each runs once per master
SCENES = {
    "half_tube": ("half_tube", "sliding"),
    "foundation_quad": ("foundation_quad", "base"),
    "foundation_tri": ("foundation_tri", "base"),
    "foundation_hybrid": ("foundation_hybrid", "base"),
    "half_tube_line": ("half_tube_line", "sliding"),
    "half_tube_line_axial": ("half_tube_line_axial", "sliding"),
}


def folder(name, master):
    return RUNS / f"{name}_{master}"


def run_scenes(osculate, keep):
    for name, (scene, pair) in SCENES.items():
        for master in MASTERS:
            where = folder(name, master)
            summary = where / "summary.json"
            if keep and summary.is_file() and json.loads(summary.read_text())["status"] == "done":
                continue
            print(f"running {name} with {master} ...", file=sys.stderr, flush=True)
            # a run that gives up (exit 3) is a result, too
            done = subprocess.run([osculate, "run", f"configs/paper/{scene}.yaml", "-o", where, "--quiet",
                                   "--set", f"contact.{pair}.surface={master}"])
            if done.returncode not in (0, 3):
                sys.exit(f"figures: {name} with {master} ended with exit code {done.returncode}")


def table(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


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
    """Of the first step, and the mean of the others; all attempts of a step count."""
    rows = attempts(name, master)
    steps, sum_ = [], 0
    for row in rows:
        sum_ += int(row["iterations"])
        if row["verdict"] == "accept":
            steps.append(sum_)
            sum_ = 0
    return steps[0] if steps else None, mean(steps[1:]) if steps[1:] else None, len(rows) - len(steps)


def table_of(header, rows):
    lines = ["| " + " | ".join(header) + " |", "|---" * len(header) + "|"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def markdown(title, header, rows):
    return f"## {title}\n{table_of(header, rows)}"


def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}"


def late_forces(master):
    """Normal and driving force of the half-tube at sliding steps 5 to 30."""
    rows = slides("half_tube", master)[4:30]
    return [row["pair.sliding.normal"] for row in rows], [row["set.rear.reaction_y"] for row in rows]


def ripple(D):
    return 100 * (max(D) - min(D)) / mean(D)


def half_tube_table():
    rows = []
    for master in MASTERS:
        N, D = late_forces(master)
        press, slide, cuts = iterations("half_tube", master)
        rows.append([master, number(mean(N) / 1e6, 3), number(mean(D) / 1e6, 4), number(mean(D) / (MU * mean(N)), 4),
                     number(ripple(D), 2), press, number(slide, 2), cuts,
                     f"{float(attempts('half_tube', master)[0]['value']):.0e}",
                     number(summary("half_tube", master)["seconds"]["total"], 1)])
    return markdown("Half-tube: pressed, then slid by 3 m",
                    ["master", "N, MN", "D, MN", "D/(mu N)", "peak-to-peak of D over its mean, %",
                     "iterations: press", "mean of the slides", "cut steps", "last residual of the press", "seconds"], rows)


def foundation_table():
    rows = []
    for mesh in ("quad", "tri", "hybrid"):
        for master in MASTERS:
            name = f"foundation_{mesh}"
            pressures = [value for _, value in centre_line(name, master)]
            last = table(folder(name, master) / "history.csv")[-1]
            whole = summary(name, master)["seconds"]
            contact = whole["search"] + whole["patches"] + whole["contact"]
            rows.append([mesh, master, number(roughness(pressures), 4), number(last["pair.base.normal"] / 1e6, 3),
                         iterations(name, master)[0], number(whole["total"], 1),
                         number(100 * contact / whole["total"], 1),
                         number(100 * whole["factor"] / whole["total"], 0)])
    return markdown("Foundation: pressed on soil, three divisions of the soil's surface",
                    ["soil surface", "master", "roughness", "N, MN", "iterations", "seconds",
                     "of them search, patches, contact, %", "factorisation, %"], rows)


def line_table():
    rows = []
    for name, what in (("half_tube_line", "along the tube"), ("half_tube_line_axial", "around the tube")):
        for master in MASTERS:
            press, slide, cuts = iterations(name, master)
            lines = table(folder(name, master) / "iterations.csv")
            changes = [int(row["status_changes"]) for row in lines if row["attempt"] == 1]
            rows.append([what, master, summary(name, master)["status"], press, number(slide, 2), cuts,
                         " ".join(map(str, changes))])
    return markdown("Half-tube, a mesh line of the contactor on one of the tube",
                    ["mesh line", "master", "ended", "iterations: press", "mean of 10 slides", "cut steps",
                     "status changes at the iterates of the pressure step"], rows)


def readme_table():
    rows = []
    for master in MASTERS:
        N, D = late_forces(master)
        press, slide, _ = iterations("half_tube", master)
        pressures = [value for _, value in centre_line("foundation_quad", master)]
        rows.append([f"`{master}`", number(mean(N) / 1e6, 2), number(mean(D) / (MU * mean(N)), 4),
                     number(ripple(D), 2), f"{press}, {number(slide, 1)}", number(roughness(pressures), 3)])
    return table_of(["half-tube, mu = 0.1", "N, MN", "D/(mu N)",
                     "peak-to-peak of D over its mean, %",
                     "iterations: press, mean of the slides", "foundation: roughness"], rows)


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
    curves = {master: [(0.1 * k, row["set.rear.reaction_y"] / 1e6)
                       for k, row in enumerate(slides("half_tube", master), 1)] for master in MASTERS}
    gnuplot(f"""
set terminal pngcairo size 900,380 font "sans,12" background "white"
set output "{IMAGES}/friction.png"
{STYLE}
set xlabel "sliding distance, m"; set ylabel "driving force, MN"
set xrange [0:3.05]; set yrange [1.64:1.80]; set ytics 0.04; set format y "%.2f"
set key bottom right
plot {", ".join(f"${master} with linespoints pt 7 ps 0.4 {LINES[master]}" for master in MASTERS)}
""", **curves)


def draw_pressure():
    curves = {f"{master}_{mesh}": [(x, p / 1e6) for x, p in centre_line(f"foundation_{mesh}", master)]
              for master in MASTERS for mesh in ("quad", "tri", "hybrid")}
    panels = "".join(f"""
set title "{title}"
set ylabel "{'contact pressure, MPa' if mesh == 'quad' else ''}"
{'unset key' if mesh != 'hybrid' else 'set key top center'}
plot {", ".join(f"${master}_{mesh} with linespoints pt 7 ps 0.35 {LINES[master]}" for master in MASTERS)}
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
                    Path(__file__).with_name("half_tube.py"), folder("half_tube", "rpim"),
                    IMAGES / "half_tube.png"], check=True)


def main():
    arguments = sys.argv[1:]
    keep = "--keep" in arguments
    osculate = [a for a in arguments if a != "--keep"][0]
    run_scenes(osculate, keep)
    IMAGES.mkdir(parents=True, exist_ok=True)
    draw_friction()
    draw_pressure()
    draw_half_tube()
    text = "\n\n".join([half_tube_table(), foundation_table(), line_table()]) + "\n"
    Path("docs/results.md").write_text(RESULTS_HEAD + text)
    update_readme()
    print(text, end="")


RESULTS_HEAD = """# Results

Written by `scripts/figures`, which runs the scenes of `configs/paper`; edit nothing here. Seconds are those of the
machine it ran on last. N is the sum of the nodal normal forces, D the force that drives the contactor, both means over
sliding steps 5 to 30; steps of 0.1 m on facets of 1 m miss the extremes of its ripple, most of all those of the facets.
Roughness is the root mean square second difference of the nodal contact pressure along y = 0
over its mean, end nodes left out. `rpim` has its defaults: 2 rings, R = 1.42, q = 1.03, m = 6.

![Driving force over sliding distance](images/friction.png)

![Contact pressure along the centre line of the foundation](images/pressure.png)

"""

if __name__ == "__main__":
    main()
