"""Solves the paper's half-tube with FrontISTR and with Osculate on the same meshes, one thread, and writes docs/data/frontistr.md.
Runs are kept in out/frontistr.

    frontistr_decks.py FISTR1 OSCULATE      called by scripts/measure/frontistr, from the root of the repository
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import calculix_decks as calculix
from calculix_decks import HALF_TUBE, HALVED, MEAN_FROM, METHODS, SCENES, Failure, Model, measured, run_osculate, side

calculix.OUT = OUT = Path("out/frontistr")
PAGE = Path("docs/data/frontistr.md")
REPETITIONS = 1  # by turns; the run with the least CPU time is kept
# !CONTACT_PARAM: CLEARANCE, CLR_SAME_ELEM, CLR_DIFFLPOS, CLR_CAL_NORM; DISTCLR_INIT, _FREE, _NOCHECK, TENSILE_FORCE, BOX_EXP_RATE.
# None: FrontISTR's own, 1e-2, 5e-3, 1e-2, 1e-4. The others change how far a node may leave its facet's edge, and how far its contact point may
# still move, in natural coordinates, when contact counts as converged.
LAST = (1e-2, -1e-6, 1.0, -1e-2, 1.05)
TOLERANCES = {"loose": ((1e-2, 5e-2, 1e-1, 1e-4), LAST), "default": None, "tight": ((1e-2, 5e-2, 1e-3, 1e-4), LAST)}
CONTACT_ITERATIONS = 50  # at most in a step; FrontISTR's default of 10 is enough where it converges
CONTROL = """\
!MESH, NAME=fstrMSH, TYPE=HECMW-ENTIRE
 deck.msh
!CONTROL, NAME=fstrCNT
 deck.cnt
!RESULT, NAME=fstrRES, IO=OUT
 deck.res
!RESULT, NAME=vis_out, IO=OUT
 deck.vis
"""
SILENT = ("NSTRAIN", "NSTRESS", "NMISES", "ESTRAIN", "ESTRESS", "EMISES", "ISTRAIN", "ISTRESS", "CONTACT_NFORCE", "CONTACT_FRICTION",
          "CONTACT_RELVEL", "CONTACT_STATE", "CONTACT_NTRACTION", "CONTACT_FTRACTION")


def rows(values, length=8):
    values = [str(v) for v in values]
    return [", ".join(values[i:i + length]) for i in range(0, len(values), length)]


def mesh(model):
    bodies, stages = model.scene["bodies"], model.scene["stages"].values()
    lines = ["!HEADER", f" {model.scene['name']}", "!NODE"]
    lines += [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(model.points, 1)]
    for body in bodies:
        lines.append(f"!ELEMENT, TYPE=361, EGRP=E_{body.upper()}")
        lines += [", ".join(str(n + 1) for n in (e, *model.elements[e])) for e in model.body_elements[body]]
    for body, given in bodies.items():
        elastic = given["material"]["linear_elastic"]
        lines += [f"!MATERIAL, NAME=M_{body.upper()}, ITEM=1", "!ITEM=1, SUBITEM=2", f" {elastic['E']!r}, {elastic['nu']!r}",
                  f"!SECTION, TYPE=SOLID, EGRP=E_{body.upper()}, MATERIAL=M_{body.upper()}", " 1.0"]
    for name in sorted({*model.scene["supports"], *(name for stage in stages for name in stage.get("displacement", {}))}):
        lines += [f"!NGROUP, NGRP=N_{name.upper()}", *rows(n + 1 for n in model.nodes(name))]
    slaves = sorted({n for facet in model.slave for n in model.face(*facet)})
    lines += ["!NGROUP, NGRP=SLAVE", *rows(n + 1 for n in slaves)]
    # surfaces 1 to 6 of a 361 have the order of FACES
    lines += ["!SGROUP, SGRP=MASTER", *rows((f"{e + 1}, {f + 1}" for e, f in model.master), 4)]
    return "\n".join([*lines, "!CONTACT PAIR, NAME=CP1, TYPE=NODE-SURF", " SLAVE, MASTER", "!END"]) + "\n"


def analysis(model, nagata, tolerance):
    scene = model.scene
    bodies, stages = scene["bodies"], list(scene["stages"].values())
    component = lambda d: "xyz".index(d) + 1
    lines = ["!VERSION", " 3", "!SOLUTION, TYPE=STATIC", "!CONTACT_ALGO, TYPE=SLAGRANGE", "!WRITE, RESULT, FREQUENCY=1", "!OUTPUT_RES",
             "DISP, ON", "REACTION, ON", *(f"{word}, OFF" for word in SILENT),
             "!SOLVER, METHOD=MUMPS, PRECOND=1, ITERLOG=NO, TIMELOG=NO", " 20000, 1", " 1.0e-10, 1.0, 0.0", "!BOUNDARY, GRPID=1"]
    for name, support in scene["supports"].items():
        lines += [f" N_{name.upper()}, {component(d)}, {component(d)}, 0.0" for d in support["fix"]]
    reached = {}
    for k, stage in enumerate(stages):
        for name, components in stage.get("displacement", {}).items():
            lines.append(f"!BOUNDARY, GRPID={10 + k}")
            for d, u in components.items():  # of the stage alone: FrontISTR adds them up
                lines.append(f" N_{name.upper()}, {component(d)}, {component(d)}, {float(u) - reached.get((name, d), 0.0)!r}")
                reached[name, d] = float(u)
    lines.append("!CLOAD, GRPID=1")
    for name, p in {name: p for stage in stages for name, p in stage.get("pressure", {}).items()}.items():
        lines += [f" {n + 1}, {d + 1}, {c!r}" for n, force in model.loads(name, p).items() for d, c in enumerate(force) if abs(c) > 1e-9]
    if tolerance:
        lines += ["!CONTACT_PARAM, NAME=CPARAM1", *(" " + ", ".join(f"{v:.10e}" for v in row) for row in tolerance)]
    stick = min(b["material"]["linear_elastic"]["E"] for b in bodies.values()) * side(model)  # N/m of a slave node
    lines += ["!CONTACT, INTERACTION=FSLID, GRPID=1" + (", SMOOTHING=NAGATA" if nagata else "")
              + (", CONTACTPARAM=CPARAM1" if tolerance else ""), f" CP1, {model.contact['friction']!r}, {stick:.10e}"]
    for body, given in bodies.items():
        elastic = given["material"]["linear_elastic"]
        lines += [f"!MATERIAL, NAME=M_{body.upper()}", "!ELASTIC", f" {elastic['E']!r}, {elastic['nu']!r}"]
    lines += [f"!SECTION, SECNUM={k + 1}, FORM361=FI" for k in range(len(bodies))]  # its default is incompatible modes
    for k, stage in enumerate(stages):
        duration = float(stage.get("duration", 1.0))
        lines += [f"!STEP, INC_TYPE=FIXED, SUBSTEPS={stage['steps']}, MAXCONTITER={CONTACT_ITERATIONS}",
                  f" {duration / stage['steps']!r}, {duration!r}", "BOUNDARY, 1", f"BOUNDARY, {10 + k}", "LOAD, 1", "CONTACT, 1"]
    return "\n".join([*lines, "!END"]) + "\n"


def nodal_values(path):
    """{node: {label: components}} of a result file."""
    words = iter(path.read_text().split("*data", 1)[1].split())
    nodes, _, parts, _ = (int(next(words)) for _ in range(4))
    widths = [int(next(words)) for _ in range(parts)]
    labels = [next(words) for _ in range(parts)]
    return {int(next(words)): {label: [float(next(words)) for _ in range(width)] for label, width in zip(labels, widths)}
            for _ in range(nodes)}


def run_frontistr(program, model, nagata, tolerance, name):
    """CPU seconds and what came out; `why` if it did not come to its end."""
    folder = calculix.fresh(name)
    (folder / "deck.msh").write_text(mesh(model))
    (folder / "deck.cnt").write_text(analysis(model, nagata, tolerance))
    (folder / "hecmw_ctrl.dat").write_text(CONTROL)
    run = measured([program], folder)
    words = (folder / "stdout").read_text()
    steps = re.split(r"^ sub_step= ", words, flags=re.M)[1:]
    run["iterations"] = [len(re.findall(r"^ - Residual\(", step, flags=re.M)) for step in steps]
    files = sorted((int(path.suffix[1:]), path) for path in folder.glob("deck.res.0.*"))
    results = [nodal_values(path) for number, path in files if number > 0]
    wanted = sum(stage["steps"] for stage in model.scene["stages"].values())
    if "FSTR_SOLVE_NLGEOM FINISHED" not in words or len(results) != wanted:
        return run | {"why": f"contact does not converge in step {len(steps)} of {wanted}"}
    outer, top = model.nodes("tube_outer"), model.nodes("top")
    # the force that drives the contactor is what holds the tube: reactions at `rear` lack the contact of its own slave nodes
    drive = [-sum(result[n + 1]["REACTION_FORCE"][1] for n in outer) for result in results]
    drop = [-results[0][n + 1]["DISPLACEMENT"][2] for n in top]
    return run | {"drive": drive, "drop": drop}


def of_osculate(run, model):
    drop = [-u[2] for u in calculix.shown(run["folder"], model, "top")]
    return run | {"drive": [row["set.rear.reaction_y"] for row in run["rows"]], "drop": drop}


def table(runs):
    lines = ["| program, contact | CPU s | over default | over blend | wall s | memory, MB | iterations, press + slides | D, MN | ripple, % "
             "| mean settlement, mm | largest, mm |", "|---" * 11 + "|"]
    against = [next(run["cpu"] for name, run in runs.items() if name.startswith(f"Osculate, {start}")) for start in ("default", "blend")]
    for name, run in runs.items():
        head = f"| {name} | {run['cpu']:.2f} | "
        ends = f"{run['wall']:.2f} | {run['memory'] / 1e6:.0f} | "
        if "why" in run:
            lines.append(head + "- | - | " + ends + run["why"] + " | - | - | - | - |")
            continue
        late = run["drive"][MEAN_FROM:]
        mean = sum(late) / len(late)
        lines.append(head + " | ".join(f"{run['cpu'] / other:.1f}" for other in against) + " | " + ends
                     + f"{run['iterations'][0]} + {sum(run['iterations'][1:])} | {mean / 1e6:.4f} | {100 * (max(late) - min(late)) / mean:.2f} | "
                     f"{1e3 * sum(run['drop']) / len(run['drop']):.2f} | {1e3 * max(run['drop']):.2f} |")
    return lines


def main(fistr1, osculate):
    OUT.mkdir(parents=True, exist_ok=True)
    runs, path = {}, Path("configs/paper/half_tube.yaml")
    os.environ |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    for scene in (HALF_TUBE, HALVED):
        settings = SCENES[scene][2]
        model = Model(run_osculate(osculate, path, f"{scene}_mesh", ["contact.sliding.surface=facets", *settings])["folder"])
        best = runs.setdefault(scene, {})
        for turn in range(REPETITIONS):
            jobs = {f"Osculate, {method}": lambda keys=keys, name=method: of_osculate(
                run_osculate(osculate, path, f"{scene}_{name}".replace(", ", "_"), [*(f"contact.sliding.{k}" for k in keys), *settings]), model)
                for method, keys in METHODS.items()}
            jobs |= {f"FrontISTR, {'Nagata patches' if nagata else 'facets'}, {name}":
                     lambda nagata=nagata, name=name: run_frontistr(fistr1, model, nagata, TOLERANCES[name], f"{scene}_{nagata}_{name}")
                     for nagata in (False, True) for name in TOLERANCES}
            for name, job in jobs.items():
                run = job()
                print(f"{scene}, {name}: {run['cpu']:.2f} CPU s, {run.get('why', 'done')}", file=sys.stderr)
                if name not in best or run["cpu"] < best[name]["cpu"]:
                    best[name] = run
    said = subprocess.run([fistr1, "-v"], capture_output=True, text=True, cwd=OUT).stdout
    version = re.search(r"VERSION[^\d]*([\d.]+)", said, flags=re.I)
    PAGE.write_text(f"""\
Written by `scripts/measure/frontistr`: FrontISTR {version[1] if version else ''} (`fistr1`, with MUMPS, without MPI and OpenMP) and Osculate on the mesh, loads and
supports of `configs/paper/half_tube.yaml`, one thread, one after the other. {"Each ran once." if REPETITIONS == 1 else f"Each ran {REPETITIONS} times, by turns; the run with the least CPU time is shown."}

- FrontISTR: `FORM361=FI` (full integration, as here), small strain, `SLAGRANGE`, `INTERACTION=FSLID`, node to surface, friction with a stick stiffness of
  E h (h: the side of a slave facet); at most {CONTACT_ITERATIONS} contact iterations a step, its other settings as they are. *Default* are its own tolerances of contact,
  *loose* allows contact points to move by 0.1 in natural coordinates after the last iteration for 0.01, *tight* 0.001; both keep a node on its
  facet up to 0.05 beyond the edge for 0.005. It writes displacements and reactions of every step.
- Osculate: as on the [page of CalculiX](calculix.md). It writes the bodies and both surfaces after every step.
- D is the force that drives the contactor, from what holds the tube; mean and peak-to-peak ripple over slides {MEAN_FROM} to 30. Settlements are those of the
  loaded face after the press. With *loose* and *default* FrontISTR stops before contact points have settled: its D is 1 % higher than the others'.

## Half-tube: pressed, then slid by 3 m in 30 steps

""" + "\n".join(table(runs[HALF_TUBE])) + """

## The same with the tube's mesh halved

""" + "\n".join(table(runs[HALVED])) + "\n")
    (OUT / "runs.json").write_text(json.dumps({scene: {name: {k: v for k, v in run.items() if k in ("cpu", "wall", "why", "iterations")}
                                                       for name, run in best.items()} for scene, best in runs.items()}, indent=1))
    print(PAGE.read_text())


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except Failure as failure:
        sys.exit(f"scripts/measure/frontistr: {failure}")
