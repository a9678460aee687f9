#!/usr/bin/env python3
"""Whole runs as ratios to the first row of their group: CPU time and peak memory, what a run is charged by the system.

    bench/scenes.py OSCULATE [--repeat N]      the least of N runs counts, 2 unless told
"""
import argparse
import json
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAPER, TUTORIALS = ROOT / "configs/paper", ROOT / "configs/tutorials"
REFINED = ["bodies.lower.mesh.block.divisions=[28, 28, 28]", "bodies.upper.mesh.block.divisions=[22, 22, 22]"]

# group: scene, then rows of name and what is set
GROUPS = [
    ("Half-tube, surfaces", PAPER / "half_tube.yaml",
     [("facets", ["contact.sliding.surface=facets"]), ("rpim", ["contact.sliding.surface=rpim"]), ("blend", []),
      ("facets, mortar", ["contact.sliding.surface=facets", "contact.sliding.discretisation=mortar"])]),
    ("Half-tube, linear solvers", PAPER / "half_tube.yaml",
     [(s, [f"solver.linear_solver={s}"]) for s in ("condensed", "iterative", "multigrid", "direct")]),
    ("Foundation, surfaces", PAPER / "foundation_quad.yaml", [("facets", ["contact.base.surface=facets"]), ("blend", [])]),
    ("Foundation, linear solvers", PAPER / "foundation_quad.yaml",
     [(s, [f"solver.linear_solver={s}"]) for s in ("condensed", "iterative", "multigrid")]),
    ("Two blocks of 105 558 unknowns", ROOT / "bench/scenes/two_blocks.yaml",
     [(s, [*REFINED, f"solver.linear_solver={s}"]) for s in ("multigrid", "iterative")]),
]


def run(program, scene, changes, folder):
    """Summary of one run on one thread."""
    options = [x for change in changes for x in ("--set", change)]
    subprocess.run([program, "run", scene, "-o", folder, "--quiet", "--threads", "1", *options], check=True)
    return json.loads((folder / "summary.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--repeat", type=int, default=2)
    words = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        for title, scene, rows in GROUPS:
            print(f"### {title}\n\n| | CPU | memory | iterations |\n|---|---|---|---|")
            base = None
            for name, changes in rows:
                runs = [run(words.program, scene, changes, Path(scratch) / "run") for _ in range(words.repeat)]
                cpu = min(r["seconds"]["cpu"] for r in runs)
                memory = min(r["peak_memory_bytes"] for r in runs)
                base = base or (cpu, memory)
                print(f"| {name} | {cpu / base[0]:.2f} | {memory / base[1]:.2f} | {runs[0]['iterations']} |", flush=True)
            print()


if __name__ == "__main__":
    main()
