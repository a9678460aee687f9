"""Runs the scenes, draws the pictures of docs/images, stores what it measures as docs/data/figures.json and writes from it
docs/results.md and the README's table (results.py).

    figures.py [--keep] OSCULATE      called by scripts/pages/figures, from the root of the repository
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

import prose
import results
from results import INERTIA, LINES as MESH_LINES, MESHES, METHODS, OPTIONS, THREADS

RUNS = Path("out/figures")
IMAGES = Path("docs/images")
# name of a method: keys of the pair
KEYS = {
    "facets": {"surface": "facets", "discretisation": "node"},
    "facets_h0": {"surface": "{facets: {hysteresis: 0}}", "discretisation": "node"},
    "rpim": {"surface": "rpim", "discretisation": "node"}, "blend": {"surface": "blend", "discretisation": "node"},
    "default": {}, "default_ring3": {"surface": "{blend: {ring: 3}}"},
} | {f"default_{basis}": {"surface": f"{{blend: {{basis: {basis}}}}}"} for basis in ("multiquadric", "r3", "r5")}
LINES = {"facets_h0": 'lw 1.5 lc rgb "#d95f02" title "facets, node"', "rpim": 'lw 1.5 lc rgb "#1f78b4" title "rpim, node"',
         "default": 'lw 2 lc rgb "#111111" title "default"'}
DRAWN = tuple(LINES)
TIMED = ("half_tube", "foundation_quad", "foundation_tri", "foundation_hybrid")
REPETITIONS = 3  # of these; the fastest is kept

HALVED = "bodies.tube.mesh.half_tube.divisions=[26, 24, 3]"
# name of a run: scene, pair, further settings; each runs once per method
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
HEXAHEDRA = "bodies.{}.hex_formulation={}"
SCENES |= {f"half_tube_{f}": ("half_tube", "sliding", [HEXAHEDRA.format(body, f) for body in ("tube", "contactor")])
           for f in ("b_bar", "incompatible_modes")}
SCENES |= {name: (name, "sliding", []) for name in INERTIA}
RUNS_OF_OPTIONS = set(OPTIONS.values()) | {(name, "blend") for name in INERTIA}


def folder(name, method):
    return RUNS / f"{name}_{method}"


def runs():
    alone = {name for name, _ in RUNS_OF_OPTIONS} - {"half_tube"}
    return ([(name, method) for name in SCENES if name not in alone for method in METHODS]
            + sorted(RUNS_OF_OPTIONS - {("half_tube", "default")}))


def run_scenes(osculate, keep):
    # the sparse solvers call small dense kernels, where threads cost more than they give
    environment = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} | os.environ
    for name, method in runs():
        scene, pair, settings = SCENES[name]
        where = folder(name, method)
        done = where / "summary.json"
        if keep and done.is_file() and json.loads(done.read_text())["status"] == "done":
            continue
        keys = [f"contact.{pair}.{key}={value}" for key, value in KEYS[method].items()]
        words = [word for setting in [*keys, *settings]
                 for word in ("--set", setting)]
        least = math.inf
        for _ in range(REPETITIONS if name in TIMED else 1):
            print(f"running {name} with {method} ...", file=sys.stderr, flush=True)
            last = RUNS / "last"
            shutil.rmtree(last, ignore_errors=True)
            ended = subprocess.run([osculate, "run", f"configs/paper/{scene}.yaml", "-o", last, "--quiet",
                                    "--threads", str(THREADS), *words], env=environment)
            # a run that gives up (exit 3) is a result, too
            if ended.returncode not in (0, 3):
                sys.exit(f"figures: {name} with {method} ended with exit code {ended.returncode}")
            total = json.loads((last / "summary.json").read_text())["seconds"]["total"]
            if total < least:
                least = total
                shutil.rmtree(where, ignore_errors=True)
                last.rename(where)


def read_table(path):
    with open(path, newline="") as file:
        return [{key: float(value) if value else None for key, value in row.items()} for row in csv.DictReader(file)]


def summary(name, method):
    return json.loads((folder(name, method) / "summary.json").read_text())


def attempts(name, method):
    with open(folder(name, method) / "steps.csv", newline="") as file:
        return list(csv.DictReader(file))


def mean(values):
    return sum(values) / len(values)


def slides(name, method):
    """Rows of the history after the pressure step."""
    return read_table(folder(name, method) / "history.csv")[1:]


def centre_line(name, method):
    """(x, pressure) of the slave nodes on y = 0 at the end: contact force along the normal over tributary area."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(sorted((folder(name, method) / "frames").glob("base.slave_*.vtp"))[-1]))
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


def iterations(name, method):
    """Of the first step, mean and largest of the others; all attempts of a step count. At last the attempts cut."""
    rows = attempts(name, method)
    steps, sum_ = [], 0
    for row in rows:
        sum_ += int(row["iterations"])
        if row["verdict"] == "accept":
            steps.append(sum_)
            sum_ = 0
    slides = steps[1:]
    return (steps[0] if steps else None, mean(slides) if slides else None, max(slides, default=None),
            len(rows) - len(steps))


def late_forces(name, method):
    """Normal and driving force of the half-tube over the distances of the paper's sliding steps 5 to 30."""
    rows = slides(name, method)
    rows = rows[len(rows) // 6 - 1:]  # 30 steps or 120: from 0.5 m on
    return [row["pair.sliding.normal"] for row in rows], [abs(row["set.rear.reaction_y"]) for row in rows]


def driven(name):
    """Distance of the driven rear, m, and row of the history after every step of a slide with inertia."""
    rows = slides(name, "blend")
    begin, duration = rows[0]["time"] - rows[0]["dt"], INERTIA[name]
    parts = [(row["time"] - begin) / duration for row in rows]
    return [(3 * (s - math.sin(2 * math.pi * s) / (2 * math.pi)), row) for s, row in zip(parts, rows)]


def of_half_tube(name, method):
    N, D = late_forces(name, method)
    return {"normal": mean(N), "driving": mean(D), "ripple": 100 * (max(D) - min(D)) / mean(D)}


def of_inertia(name):
    steps = driven(name)
    last = steps[-1][1]
    energy = last["energy.friction"] + last["energy.kinetic"] + last["energy.strain"]
    return {"friction": mean([row["pair.sliding.friction"] for y, row in steps if 0.5 <= y <= 2.9]),
            "kinetic": max(row["energy.kinetic"] for _, row in steps),
            "friction_work": last["energy.friction"], "algorithmic": last["energy.algorithmic"],
            "unbalance": max(abs(row["energy.balance"]) for _, row in steps) / energy}


def of_foundation(name, method):
    return {"roughness": roughness([value for _, value in centre_line(name, method)]),
            "normal": read_table(folder(name, method) / "history.csv")[-1]["pair.base.normal"]}


def of_mesh_line(name, method):
    first = [row for row in read_table(folder(name, method) / "iterations.csv") if row["attempt"] == 1]
    return {"status_changes": [int(row["status_changes"]) for row in first],
            "residuals": [row["residual"] for row in first[-4:]]}


def measured(name, method):
    """Everything that tables are made of, as the run gives it."""
    run, rows = summary(name, method), attempts(name, method)
    figures = {"status": run["status"], "seconds": run["seconds"], "factorisations": run["factorisations"],
               "attempts": int(rows[-1]["attempt"]), "iterations": iterations(name, method),
               "first_residual": float(rows[0]["value"]), "last_residual": float(rows[-1]["value"])}
    if name in INERTIA:
        return figures | of_inertia(name)
    if name in MESH_LINES:
        return figures | of_mesh_line(name, method)
    if name.startswith("foundation"):
        return figures if name.endswith("_tight") else figures | of_foundation(name, method)
    return figures | of_half_tube(name, method)


def short(figures):
    """Nine digits are more than any table shows."""
    if isinstance(figures, dict):
        return {key: short(value) for key, value in figures.items()}
    if isinstance(figures, (list, tuple)):
        return [short(value) for value in figures]
    return float(f"{figures:.9g}") if isinstance(figures, float) else figures


def store():
    of = {}
    for name, method in sorted(set(runs())):
        of.setdefault(name, {})[method] = short(measured(name, method))
    results.DATA.parent.mkdir(parents=True, exist_ok=True)
    lines = [f'"{name}": {{\n' + ",\n".join(f'  "{method}": {json.dumps(run)}' for method, run in methods.items()) + "\n}"
             for name, methods in of.items()]
    results.DATA.write_text("{\n" + ",\n".join(lines) + "\n}\n")


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
    curves = {method: [(0.025 * k, row["set.rear.reaction_y"] / 1e6)
                       for k, row in enumerate(slides("half_tube_fine_steps", method), 1)] for method in DRAWN}
    gnuplot(f"""
set terminal pngcairo size 900,380 font "sans,12" background "white"
set output "{IMAGES}/friction.png"
{STYLE}
set xlabel "sliding distance, m"; set ylabel "driving force, MN"
set xrange [0:3.05]; set yrange [1.64:1.80]; set ytics 0.04; set format y "%.2f"
set key bottom right
plot {", ".join(f"${method} with lines {LINES[method]}" for method in DRAWN)}
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
    curves = {f"{method}_{mesh}": [(x, p / 1e6) for x, p in centre_line(f"foundation_{mesh}", method)]
              for method in DRAWN for mesh in MESHES}
    panels = "".join(f"""
set title "{title}"
set ylabel "{'contact pressure, MPa' if mesh == 'quad' else ''}"
{'unset key' if mesh != 'hybrid' else 'set key top center'}
plot {", ".join(f"${method}_{mesh} with linespoints pt 7 ps 0.35 {LINES[method]}" for method in DRAWN)}
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
                    Path(__file__).with_name("half_tube.py"), folder("half_tube", "default"),
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
    store()
    for path, text in results.pages().items():
        path.write_text(text)
    print(results.RESULTS.read_text(), end="")
    for fault in prose.faults(json.loads(results.DATA.read_text())):
        print(f"figures: {fault}", file=sys.stderr)


if __name__ == "__main__":
    main()
