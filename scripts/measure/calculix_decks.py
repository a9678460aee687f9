"""Solves the paper's half-tube and foundation with CalculiX and with Osculate on the same meshes, one thread, and writes
docs/data/calculix.md and docs/images/ripple_calculix.png. Runs are kept in out/calculix.

    calculix_decks.py OSCULATE      called by scripts/measure/calculix, from the root of the repository
"""
import csv
import json
import math
import os
import re
import shutil
import subprocess
import sys
from functools import partial
from pathlib import Path

import vtk
import yaml

OUT = Path("out/calculix")
PAGE = Path("docs/data/calculix.md")
PLOT = Path("docs/images/ripple_calculix.png")
REPETITIONS = 2  # of every run, by turns; the one with the least CPU time is kept
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
# Faces S1 to S6 of a C3D8, whose nodes have the order of VTK's hexahedron.
FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
PENALTIES = (50, 5)  # times E of the softer body over the side of a slave facet
STICK_SLOPE = 0.1    # times the penalty, as CalculiX's manual advises
TENSION = 0.0025     # times the applied pressure: the manual's 0.25 % of the largest stress; node-to-surface alone reads it
MEAN_FROM = 11       # first slide of means and ripples: 11 to 30 are two facets of the tube
HALF_TUBE, HALVED, FOUNDATION = "half_tube", "half_tube_halved", "foundation_quad"
# scene: its file, its pair, further settings, kinds of contact in CalculiX, runs
SCENES = {
    HALF_TUBE: ("half_tube", "sliding", (), ("SURFACE TO SURFACE", "NODE TO SURFACE"), REPETITIONS),
    HALVED: ("half_tube", "sliding", ("bodies.tube.mesh.half_tube.divisions=[26, 24, 3]",), ("SURFACE TO SURFACE",), 1),
    FOUNDATION: ("foundation_quad", "base", (), ("SURFACE TO SURFACE", "NODE TO SURFACE"), REPETITIONS),
}
# name of a method of Osculate: keys of the pair
METHODS = {
    "default": (), "blend, nodes": ("surface=blend", "discretisation=node"),
    "facets, nodes": ("surface={facets: {hysteresis: 0}}", "discretisation=node"),
}
# Known not to be solved at one increment, reported as it ends; everything else has to come to its end.
MAY_FAIL = {(HALF_TUBE, "NODE TO SURFACE", 50), (HALVED, "SURFACE TO SURFACE", 50), (HALVED, "SURFACE TO SURFACE", 5)}
# Measures from a process of its own: a child's peak memory begins with that of who started it.
MEASURE = """
import json, os, sys, time
start = time.time()
child = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ)
_, status, used = os.wait4(child, 0)
print(json.dumps({"exit": os.waitstatus_to_exitcode(status), "cpu": used.ru_utime + used.ru_stime,
                  "wall": time.time() - start, "memory": 1024 * used.ru_maxrss}), file=sys.stderr)
"""


class Failure(Exception):
    """A run that did not come to its end, and how."""


def grid(path):
    reader = vtk.vtkXMLUnstructuredGridReader() if path.suffix == ".vtu" else vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points_of(data):
    return [data.GetPoint(i) for i in range(data.GetNumberOfPoints())]


def cells_of(data):
    return [[data.GetCell(c).GetPointId(i) for i in range(data.GetCell(c).GetNumberOfPoints())]
            for c in range(data.GetNumberOfCells())]


def key(point):
    return tuple(round(x, 9) + 0.0 for x in point)


class Model:
    """The bodies of a scene as Osculate meshes them, in one numbering of nodes and elements, from zero."""

    def __init__(self, run):
        self.scene = yaml.safe_load((run / "scene.yaml").read_text())
        self.points, self.elements, self.body_nodes, self.body_elements = [], [], {}, {}
        for body in self.scene["bodies"]:
            data = grid(run / "frames" / f"{body}_00000.vtu")
            first, before = len(self.points), len(self.elements)
            self.points += points_of(data)
            self.elements += [[first + n for n in cell] for cell in cells_of(data)]
            self.body_nodes[body] = range(first, len(self.points))
            self.body_elements[body] = range(before, len(self.elements))
        assert all(len(cell) == 8 for cell in self.elements), "hexahedra only"
        (self.pair, self.contact), = self.scene["contact"].items()
        self.slave = self.facets(self.body_of(self.contact["slave"]), run / "frames" / f"{self.pair}.slave_00000.vtp")
        self.master = self.facets(self.body_of(self.contact["master"]["set"]),
                                  run / "frames" / f"{self.pair}.master_00000.vtp")

    def body_of(self, name):
        return self.scene["sets"][name]["body"]

    def facets(self, body, path):
        """(element, face) of the facets that Osculate wrote."""
        data = grid(path)
        corners = [key(p) for p in points_of(data)]
        wanted = {frozenset(corners[n] for n in cell) for cell in cells_of(data)}
        found = [(e, f) for e in self.body_elements[body] for f in range(6)
                 if frozenset(key(self.points[n]) for n in self.face(e, f)) in wanted]
        assert len(found) == len(wanted), f"{path}: {len(found)} of {len(wanted)} facets found"
        return found

    def face(self, element, face):
        return [self.elements[element][n] for n in FACES[face]]

    def nodes(self, name):
        """Nodes of a set of the scene, by where they are: the surfaces of the generated meshes are planes but for the
        half-tube's outside."""
        body, surface = self.body_of(name), self.scene["sets"][name]["surface"]
        nodes = self.body_nodes[body]
        if surface == "outer":
            measure, end = (lambda p: math.hypot(p[0], p[2])), max
        else:
            axis, end = {"x_min": (0, min), "x_max": (0, max), "y_min": (1, min), "y_max": (1, max), "z_min": (2, min),
                         "z_max": (2, max), "top": (2, max), "rear": (1, min)}[surface]
            measure = lambda p: p[axis]
        limit = end(measure(self.points[n]) for n in nodes)
        return [n for n in nodes if abs(measure(self.points[n]) - limit) < 1e-9]

    def loads(self, name, pressure):
        """Consistent nodal forces of a dead pressure."""
        on = set(self.nodes(name))
        forces = {}
        g = 1 / math.sqrt(3)
        for e in self.body_elements[self.body_of(name)]:
            for f in range(6):
                face = self.face(e, f)
                if not on.issuperset(face):
                    continue
                x = [self.points[n] for n in face]
                centre = [sum(self.points[n][d] for n in self.elements[e]) / 8 for d in range(3)]
                for s, t in ((-g, -g), (g, -g), (g, g), (-g, g)):
                    shape = [(1 + a * s) * (1 + b * t) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    by_s = [a * (1 + b * t) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    by_t = [b * (1 + a * s) / 4 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                    u, v = ([sum(w * p[d] for w, p in zip(by, x)) for d in range(3)] for by in (by_s, by_t))
                    normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
                    if sum(normal[d] * (x[0][d] - centre[d]) for d in range(3)) < 0:
                        normal = [-c for c in normal]
                    for n, w in zip(face, shape):
                        force = forces.setdefault(n, [0.0, 0.0, 0.0])
                        for d in range(3):
                            force[d] -= pressure * w * normal[d]
        return forces


def side(model):
    """Of a slave facet: the square root of their mean area."""
    area = 0.0
    for facet in model.slave:
        a, b, c, d = (model.points[n] for n in model.face(*facet))
        u, v = ([q[i] - p[i] for i in range(3)] for p, q in ((a, c), (b, d)))
        area += math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
    return math.sqrt(area / len(model.slave))


def deck(model, kind=None, penalty=None):
    """The scene for CalculiX; without a kind of contact only the first stage, the slave surface held."""
    bodies, stages = model.scene["bodies"], list(model.scene["stages"].values())
    elastic = {body: bodies[body]["material"]["linear_elastic"] for body in bodies}
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(model.points, 1)]
    for body in bodies:
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET=E_{body}")
        lines += [", ".join(str(n + 1) for n in (e, *model.elements[e])) for e in model.body_elements[body]]
        lines += [f"*MATERIAL, NAME=M_{body}", "*ELASTIC", f"{elastic[body]['E']!r}, {elastic[body]['nu']!r}",
                  f"*SOLID SECTION, ELSET=E_{body}, MATERIAL=M_{body}"]
    loaded = {name for stage in stages for name in stage.get("pressure", {})}
    held = set(model.scene["supports"]) | {name for stage in stages for name in stage.get("displacement", {})}
    for name in sorted(loaded | held):
        lines.append(f"*NSET, NSET=N_{name}")
        lines += [f"{n + 1}," for n in model.nodes(name)]
    if kind:
        slope = penalty * min(m["E"] for m in elastic.values()) / side(model)
        pressure = max(p for stage in stages for p in stage.get("pressure", {}).values())
        for name, facets in (("SLAVE", model.slave), ("MASTER", model.master)):
            lines.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
            lines += [f"{e + 1}, S{f + 1}" for e, f in facets]
        lines += ["*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
                  f"{slope!r}, {TENSION * pressure!r}", "*FRICTION", f"{model.contact['friction']!r}, {STICK_SLOPE * slope!r}",
                  f"*CONTACT PAIR, INTERACTION=TOUCH, TYPE={kind}", "SLAVE, MASTER"]
    lines.append("*BOUNDARY")
    for name, support in model.scene["supports"].items():
        lines += [f"N_{name}, {'xyz'.index(d) + 1}" for d in support["fix"]]
    if not kind:
        lines += [f"{n + 1}, 1, 3" for n in sorted({n for facet in model.slave for n in model.face(*facet)})]
        del stages[1:]
    for stage in stages:
        # No NLGEOM: the bodies are linear in Osculate too; contact follows the nodes all the same.
        lines += [f"*STEP, INC={stage['steps']}", "*STATIC, DIRECT",
                  f"{stage['duration'] / stage['steps']!r}, {float(stage['duration'])!r}"]
        for name, components in stage.get("displacement", {}).items():
            lines.append("*BOUNDARY")
            lines += [f"N_{name}, {'xyz'.index(d) + 1}, {'xyz'.index(d) + 1}, {float(u)!r}" for d, u in components.items()]
        for name, p in stage.get("pressure", {}).items():
            lines.append("*CLOAD")  # dead, as Osculate's
            lines += [f"{n + 1}, {d + 1}, {c!r}" for n, force in model.loads(name, p).items() for d, c in enumerate(force)
                      if abs(c) > 1e-9]
        for name in sorted(held):
            lines += [f"*NODE PRINT, NSET=N_{name}, TOTALS=ONLY", "RF"]
        for name in stage.get("pressure", {}):
            lines += [f"*NODE PRINT, NSET=N_{name}", "U"]
        lines.append("*END STEP")
    return "\n".join(lines) + "\n"


def measured(command, folder):
    with open(folder / "stdout", "w") as words:
        p = subprocess.run([sys.executable, "-I", "-S", "-c", MEASURE, *command], cwd=folder, stdout=words, stderr=subprocess.PIPE,
                           env={**os.environ, **ONE_THREAD}, text=True)
        words.write(p.stderr)
    last = (p.stderr.splitlines() or [""])[-1]
    if p.returncode or not last.startswith("{"):
        raise Failure(f"{command[0]}: {p.stderr.strip()}")
    return json.loads(last)


def fresh(name):
    folder = OUT / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder.resolve()


def run_osculate(program, scene, name, changes=()):
    folder = fresh(name)
    run = measured([program, "run", str(scene.resolve()), "-o", str(folder), "--force", "--quiet", "--threads", "1",
                    *(word for change in changes for word in ("--set", change))], folder)
    summary = json.loads((folder / "summary.json").read_text()) if (folder / "summary.json").exists() else {}
    if run["exit"] or summary.get("status") != "done":
        raise Failure(f"osculate, {name}: exit {run['exit']}, see {OUT / name / 'stdout'}")
    with open(folder / "history.csv") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    steps = [int(row["iterations"]) for row in rows]
    return run | {"folder": folder, "version": summary["version"], "iterations": steps, "rows": rows,
                  "output": summary["seconds"]["output"] / summary["seconds"]["total"]}


def run_calculix(text, increments, name):
    folder = fresh(name)
    (folder / "deck.inp").write_text(text)
    run = measured(["ccx", "-i", "deck"], folder)
    words = (folder / "stdout").read_text()
    # A row for each attempt: step, increment, attempt (U when it failed), iterations.
    attempts = [line.split() for line in (folder / "deck.sta").read_text().splitlines()[2:]]
    run |= {"folder": folder, "iterations": [int(row[3]) for row in attempts]}
    errors = [line.strip(" *") for line in words.splitlines() if "*ERROR" in line]
    if run["exit"] or errors or "Job finished" not in words or len(attempts) != increments:
        why = errors[0] if errors else f"exit {run['exit']}, {len(attempts)} of {increments} increments"
        failure = Failure(f"ccx, {name}: {why}, see {OUT / name / 'stdout'}")
        failure.run, failure.why = run, why.removeprefix("ERROR: ")
        raise failure
    # A row for each iteration: step, increment, attempt, iteration, contact elements, residual in % of the mean force.
    last = {tuple(row[:2]): float(row[5]) for row in map(str.split, (folder / "deck.cvg").read_text().splitlines()[4:])}
    return run | {"printed": printed(folder / "deck.dat"), "residual": max(last.values(), default=0.0)}


def run_or_failure(text, increments, name):
    try:
        return run_calculix(text, increments, name)
    except Failure as failure:
        if not hasattr(failure, "why"):
            raise
        return failure.run | {"why": failure.why}


def printed(path):
    """{set: [vectors of a block, ...]} of the totals and tables of a .dat file, in order of time."""
    blocks, block = {}, None
    for line in path.read_text().splitlines():
        words = line.split()
        if title := re.match(r" *(total force|displacements) .* for set N_(\w+) and time", line):
            block = blocks.setdefault(title[2].lower(), [])
            block.append([])
        elif words and block is not None:
            block[-1].append([float(w) for w in words[-3:]])
    return blocks


def shown(path, model, name):
    """Displacements of a set in a frame of Osculate's."""
    body = model.body_of(name)
    data = grid(path / "frames" / f"{body}_00001.vtu").GetPointData().GetArray("displacement")
    return [data.GetTuple(n - model.body_nodes[body][0]) for n in model.nodes(name)]


def without_contact(program, scene, model):
    """Largest difference of displacements on the loaded face over the largest displacement, slave surface held."""
    bare = {k: v for k, v in model.scene.items() if k not in ("contact", "output")}
    name, stage = next(iter(model.scene["stages"].items()))
    bare |= {"stages": {name: stage}, "supports": model.scene["supports"] | {model.contact["slave"]: {"fix": ["x", "y", "z"]}}}
    path = OUT / f"{scene}_held.yaml"
    path.write_text(yaml.safe_dump(bare, sort_keys=False))
    loaded, = stage["pressure"]
    ours = shown(run_osculate(program, path, f"{scene}_held")["folder"], model, loaded)
    theirs = run_calculix(deck(model), stage["steps"], f"{scene}_held_calculix")["printed"][loaded.lower()][0]
    worst = max(abs(a - b) for p, q in zip(ours, theirs, strict=True) for a, b in zip(p, q))
    return worst / max(abs(a) for p in ours for a in p)


def figures(scene, model, run):
    """What a run answers, from CalculiX's prints or Osculate's history and first frame."""
    loaded, = next(iter(model.scene["stages"].values()))["pressure"]
    calculix = "printed" in run
    drop = [-u[2] for u in (run["printed"][loaded.lower()][0] if calculix else shown(run["folder"], model, loaded))]
    settled = [f"{1e3 * sum(drop) / len(drop):.2f}", f"{1e3 * max(drop):.2f}"]
    if scene == FOUNDATION:
        up = run["printed"]["bed"][0][0][2] if calculix else run["rows"][0]["set.bed.reaction_z"]
        return [f"{run['iterations'][0]}", f"{up / 1e6:.3f}", *settled]
    drive = [b[0][1] for b in run["printed"]["rear"]] if calculix else [row["set.rear.reaction_y"] for row in run["rows"]]
    late = drive[MEAN_FROM:]
    mean = sum(late) / len(late)
    return [f"{run['iterations'][0]} + {sum(run['iterations'][1:])}", f"{mean / 1e6:.4f}",
            f"{100 * (max(late) - min(late)) / mean:.2f}", *settled]


def table(scene, model, runs):
    cells = (["iterations", "reaction of the bed, MN"] if scene == FOUNDATION
             else ["iterations, press + slides", "D, MN", "ripple, %"])
    head = ["program, contact", "CPU s", "over default", "over blend", "over facets", "wall s", "memory, MB", *cells,
            "mean settlement, mm", "largest, mm"]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    against = [next(run["cpu"] for name, run in runs.items() if name.startswith(f"Osculate, {start}"))
               for start in METHODS]
    for name, run in runs.items():
        row = [name, f"{run['cpu']:.2f}"]
        if "why" in run:
            stop = f"gives up in increment {len(run['iterations'])} after {run['iterations'][-1]} iterations: {run['why']}"
            row += ["-"] * 3 + [f"{run['wall']:.2f}", f"{run['memory'] / 1e6:.0f}", stop] + ["-"] * (len(head) - 8)
        else:
            row += [f"{run['cpu'] / other:.1f}" for other in against]
            row += [f"{run['wall']:.2f}", f"{run['memory'] / 1e6:.0f}", *figures(scene, model, run)]
        lines.append("| " + " | ".join(row) + " |")
    return lines


def draw(models, runs):
    """Ripple over CPU seconds, a line per method from the tube's mesh to that halved."""
    series = {}
    for scene in (HALF_TUBE, HALVED):
        for name, run in runs[scene].items():
            if "why" not in run:
                series.setdefault(name, []).append((run["cpu"], float(figures(scene, models[scene], run)[2])))
    colours = ["#111111", "#1f78b4", "#6a3d9a", "#d95f02", "#e6ab02", "#a6761d", "#e7298a"]
    blocks = "".join(f"$s{k} << EOD\n" + "\n".join(f"{x!r} {y!r}" for x, y in points) + "\nEOD\n"
                     for k, points in enumerate(series.values()))
    curves = ", ".join(f'$s{k} with linespoints pt {7 if name.startswith("Osculate") else 5} lw 1.5 lc rgb "{colours[k % 7]}" '
                       f'title "{name}"' for k, name in enumerate(series))
    subprocess.run(["gnuplot"], text=True, check=True, input=blocks + f"""
set terminal pngcairo size 900,420 font "sans,12" background "white"
set output "{PLOT}"
set border 3 lc rgb "#444444"; set tics nomirror out textcolor rgb "#222222"; set grid lc rgb "#dddddd" lt 1
set logscale xy; set yrange [0.1:10]
set xlabel "CPU seconds"; set ylabel "ripple of the driving force, %"
set key outside right samplen 2 spacing 1.2
plot {curves}
""")


def main(program):
    program = str(Path(program).resolve())
    OUT.mkdir(parents=True, exist_ok=True)
    models, jobs, runs, same = {}, [], {}, {}
    for scene, (file, pair, settings, kinds, _) in SCENES.items():
        path = Path("configs/paper") / f"{file}.yaml"
        # Not counted: the mesh, from a first run.
        models[scene] = model = Model(run_osculate(program, path, f"{scene}_mesh",
                                                   [f"contact.{pair}.surface=facets", *settings])["folder"])
        same[scene] = without_contact(program, scene, model)
        if same[scene] > 1e-5:
            raise Failure(f"{scene} without contact: displacements of the two programs differ by {same[scene]:.1e}")
        for method, keys in METHODS.items():
            changes = [f"contact.{pair}.{change}" for change in keys]
            jobs.append((scene, f"Osculate, {method}", partial(run_osculate, program, path, changes=[*changes, *settings])))
        increments = sum(stage["steps"] for stage in model.scene["stages"].values())
        for kind in kinds:
            for penalty in PENALTIES:
                run = run_or_failure if (scene, kind, penalty) in MAY_FAIL else run_calculix
                jobs.append((scene, f"CalculiX, {kind.lower().replace(' ', '-')}, {penalty} E/h",
                             partial(run, deck(model, kind, penalty), increments)))
    for turn in range(REPETITIONS):
        for scene, name, job in jobs:
            if turn >= SCENES[scene][-1]:
                continue
            run = job(name=re.sub(r"\W+", "_", f"{scene}_{name}_{turn}"))
            print(f"{scene}, {name}: {run['cpu']:.2f} CPU s, {run['wall']:.2f} s", file=sys.stderr)
            best = runs.setdefault(scene, {})
            if name not in best or run["cpu"] < best[name]["cpu"]:
                best[name] = run
    calculix = re.search(r"Version (\S+)", subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout)[1]
    default = {scene: next(iter(runs[scene].values())) for scene in runs}
    residual = max(run["residual"] for best in runs.values() for run in best.values() if "residual" in run)
    tolerance = {scene: model.scene["solver"]["tolerance"] for scene, model in models.items()}
    page = f"""\
Written by `scripts/measure/calculix`: CalculiX {calculix} (`ccx`, Debian's, with its default solver SPOOLES) and Osculate
{default[HALF_TUBE]['version']} on the meshes, loads and supports of `configs/paper`, one thread, one after the other. Each ran {REPETITIONS} times, by turns; the run with the
least CPU time is shown. CPU is user and system time, and memory is the largest resident set. The operating system counts both,
and they include reading and writing. *Over* is CPU time divided by that of the Osculate run of that name.

- Osculate: the scenes as shipped (*default*: smooth, forces averaged as in surface-to-surface), and with
  `contact.<pair>.discretisation=node` on `blend` and on `facets` without hysteresis; *facets, nodes* does the same as
  node-to-surface. Osculate writes the bodies and both surfaces after every step
  ({100 * default[HALF_TUBE]['output']:.0f} % of its time on the half-tube, {100 * default[FOUNDATION]['output']:.0f} % on the foundation).
- CalculiX: C3D8, no NLGEOM, pressures as nodal forces, so they are dead loads; `*STATIC, DIRECT` with the scene's steps as increments.
  `PRESSURE-OVERCLOSURE=LINEAR`, its slope {' and '.join(str(p) for p in PENALTIES)} times E of the softer body over h, the side of a slave facet; stick slope
  {STICK_SLOPE} of that. It prints totals of reactions, and displacements of the loaded face after the press; no fields.
- Osculate's contact is exact, without a penalty. CalculiX converges by its default criteria, which left residuals of up to
  {residual:.2f} % of the mean force; Osculate's are below `solver.tolerance`, {tolerance[HALF_TUBE]:.0e} (half-tube) and {tolerance[FOUNDATION]:.0e} (foundation) of the
  step's reference force.
- Without contact and with the slave surface held, displacements of the loaded face differ by {same[HALF_TUBE]:.0e} (half-tube) and {same[FOUNDATION]:.0e}
  (foundation) of the largest: elements, loads and supports are the same. CalculiX prints seven digits.

## Half-tube: pressed, then slid by 3 m in 30 steps
D is the force that drives the contactor, its mean and peak-to-peak ripple over slides {MEAN_FROM} to 30; settlements are those of
the loaded face after the press. The contactor settles furthest on smooth masters, because facets of the tube lie inside the
cylinder through its nodes, by up to their sagitta of 22 mm.

""" + "\n".join(table(HALF_TUBE, models[HALF_TUBE], runs[HALF_TUBE])) + """

## The same with the tube's mesh halved
The tube has twice as many facets in both directions; one run each.

""" + "\n".join(table(HALVED, models[HALVED], runs[HALVED])) + """

![Ripple over CPU seconds](../images/ripple_calculix.png)

## Foundation: pressed on soil, one step
""" + "\n" + "\n".join(table(FOUNDATION, models[FOUNDATION], runs[FOUNDATION])) + "\n"
    PAGE.write_text(page)
    draw(models, runs)
    print(page)


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except Failure as failure:
        sys.exit(f"scripts/measure/calculix: {failure}")
