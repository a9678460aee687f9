"""Writes the table of random heaps; see scripts/pages/heaps.

    heaps.py PROGRAM PAGE COUNT
"""
import csv
import json
import multiprocessing
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile

SECONDS = 300  # of processor time, of one run
GAVE_UP = 3  # exit code
BODIES = 5
HEAD = """# Random heaps

`scripts/pages/heaps` writes this page; do not edit it. Each heap is {bodies} bodies, blocks, balls and cylinders of random size and
turn, that fall on a soft floor for 0.3 s with `contact: {{general: ...}}` and default settings. Young's modulus of the floor is
between 1e5 and 1e11 Pa and that of a body within a factor of 10 of it, friction 0 to 1, speed up to 2 m/s. Energy gained is the
largest excess of kinetic and strain energy over what the heap had and what gravity has done so far, over the largest kinetic
energy.
"""


def heap(seed):
    """A scene, and the words that describe it."""
    r = random.Random(seed)
    stiffness = 10 ** r.uniform(5, 11)
    friction = r.choice([0, 0.1, 0.3, 0.6, 1.0])
    speed = r.uniform(0, 2)

    def material(E):
        return f"    material: {{neo_hookean: {{E: {E:.6g} Pa, nu: 0.3, density: 1000 kg/m^3}}}}"

    lines = ["bodies:", "  floor:",
             "    mesh: {block: {origin: [-1 m, -1 m, -0.2 m], size: [2 m, 2 m, 0.2 m], divisions: [6, 6, 1]}}",
             material(stiffness)]
    height = 0.02
    for k in range(BODIES):
        size = r.uniform(0.15, 0.3)
        mesh = r.choice([
            f"block: {{origin: [{-size / 2:.6g} m, {-size / 2:.6g} m, {-size / 2:.6g} m], "
            f"size: [{size:.6g} m, {size:.6g} m, {size:.6g} m], divisions: [3, 3, 3]}}",
            f"ball: {{radius: {size / 2:.6g} m, divisions: [4, 2, 2]}}",
            f"cylinder: {{radius: {size / 2:.6g} m, length: {size:.6g} m, divisions: [2, 1, 2]}}"])
        axis = ", ".join(f"{r.gauss(0, 1):.6g}" for _ in range(3))
        height += 0.9 * size
        place = f"[{r.uniform(-0.1, 0.1):.6g} m, {r.uniform(-0.1, 0.1):.6g} m, {height:.6g} m]"
        height += 0.9 * size + 0.02
        side = [r.uniform(-speed, speed) / 3 for _ in range(2)]
        lines += [f"  body_{k}:",
                  f"    mesh: {{{mesh}, rotate: {{axis: [{axis}], angle: {r.uniform(0, 90):.6g} deg}}, translate: {place}}}",
                  material(stiffness * 10 ** r.uniform(-1, 1)),
                  f"    initial_velocity: [{side[0]:.6g} m/s, {side[1]:.6g} m/s, {-speed:.6g} m/s]"]
    lines += ["sets:", "  bed: {body: floor, surface: z_min}", "supports:", "  bed: {fix: [x, y, z]}",
              "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]", f"contact: {{general: {{friction: {friction}}}}}", "stages:",
              "  fall: {analysis: dynamic, duration: 0.3 s, steps: 100}", "output: {template: minimal}"]
    return "\n".join(lines) + "\n", [f"{stiffness:.1e}", f"{friction}", f"{speed:.2f}"]


def energy_gained(folder):
    with open(folder / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    own = [float(row["energy.kinetic"]) + float(row["energy.strain"]) - float(row["energy.external"]) for row in rows]
    largest = max(float(row["energy.kinetic"]) for row in rows)
    return max(value - own[0] for value in own) / largest


def limit_time():
    # wall time would depend on what else the machine does
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def row(program, seed):
    text, words = heap(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "heap.yaml").write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([program, "run", folder / "heap.yaml", "-o", folder / "out", "--quiet"],
                              capture_output=True, text=True, preexec_fn=limit_time)
        if done.returncode == -signal.SIGKILL:
            return words + [f"not done after {SECONDS} s", "", "", ""]
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if done.returncode == GAVE_UP:
            found = json.loads((folder / "out/post_mortem.json").read_text())
            outcome = f"gave up at {found['time']:.3f} s: {found['cause']}"
        elif done.returncode == 0:
            outcome = "completes"
        else:
            raise RuntimeError(f"heap {seed}: exit code {done.returncode}\n{done.stderr}")
        steps = json.loads((folder / "out/summary.json").read_text())["steps"]
        return words + [outcome, str(steps["accepted"]), f"{seconds:.1f}", f"{energy_gained(folder / 'out'):.1e}"]


def main():
    program, page, count = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3])
    with multiprocessing.Pool() as pool: # a worker's children are its own: their times do not mix
        rows = pool.starmap(row, [(program, seed) for seed in range(count)], chunksize=1)
    completed = sum(one[3] == "completes" for one in rows)
    text = HEAD.format(bodies=BODIES)
    text += f"\n{completed} of {count} complete.\n\n"
    text += "| heap | E of the floor, Pa | friction | speed, m/s | outcome | steps | CPU s | energy gained |\n"
    text += "|---|---|---|---|---|---|---|---|\n"
    for seed, one in enumerate(rows):
        text += f"| {seed} | " + " | ".join(one) + " |\n"
    page.write_text(text)


if __name__ == "__main__":
    main()
