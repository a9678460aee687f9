"""Writes the page of failures; see scripts/pages/failures.

    failures.py PROGRAM PAGE
"""
import json
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXTREME = ["bar_on_table_edge", "bars_crossed_between_nodes", "ring_through_itself"]
SECONDS = 300  # of one run
GAVE_UP = 3  # exit code
HEAD = """# Failures

`scripts/pages/failures` writes this page; do not edit it. It shows small scenes that cannot be run, on purpose, and what the
program says about each: first the sentence of the failure, then the post-mortem, which `osculate diary DIR` repeats. The
post-mortem is also in `post_mortem.json`, and the last iterate is a frame in the folder `failed`. A table below each scene
shows the effect of the advice: overrides are run on the scene as they are printed; advice in words alone is not tried. Tests
expect that some override helps, or do what the words say and expect the run to end well, or find that no remedy is known.
"""


def run(program, scene, folder, overrides=()):
    """Exit code and what was said."""
    command = [program, "run", scene, "-o", folder, "--quiet"]
    for change in overrides:
        command += ["--set", change]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=SECONDS)
    return done.returncode, done.stderr


def outcome(program, scene, overrides, failed):
    """What comes of a run with overrides, after one that failed without them."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            code, said = run(program, scene, folder, overrides)
        except subprocess.TimeoutExpired:
            return f"not done after {SECONDS} s"
        if code == 0:
            steps = json.loads((pathlib.Path(folder) / "summary.json").read_text())["steps"]["accepted"]
            return f"completes in {steps} steps"
        if code != GAVE_UP:
            sys.exit(f"{scene} with {overrides}: exit code {code}\n{said}")
        now = json.loads((pathlib.Path(folder) / "post_mortem.json").read_text())
        past = ", past where it failed" if now["last_time"] > failed["time"] else ""
        return f"fails at {now['time']:.4g} s{past}: {now['cause']}"


def section(program, scene):
    with tempfile.TemporaryDirectory() as folder:
        code, said = run(program, scene, folder)
        if code != GAVE_UP:
            sys.exit(f"{scene}: exit code {code}, not {GAVE_UP}\n{said}")
        found = json.loads((pathlib.Path(folder) / "post_mortem.json").read_text())
    about = []
    for line in (ROOT / scene).read_text().splitlines():
        if line.startswith("# ") and "yaml-language-server" not in line:
            about.append(line[2:])
        elif not line.startswith("#"):
            break
    name = pathlib.Path(scene).stem
    text = f"\n## {name.replace('_', ' ')}\n{' '.join(about)} ([scene](../{scene}))\n```\n{said}```\n"
    if found["no_remedy"]:
        text += "No remedy is known.\n"
    if found["advice"]:
        text += "\n| Advice | What came of it |\n| --- | --- |\n"
    for one in found["advice"]:
        if one["set"]:
            options = " ".join("--set " + shlex.quote(change) for change in one["set"])
            came = "tried: " + outcome(program, scene, one["set"], found)
            text += f"| `{options}` | {came} |\n"
        else:
            text += f"| `{one['key']}` | not tried: in words |\n"
    return text


def main(program, page):
    scenes = sorted(str(path.relative_to(ROOT)) for path in (ROOT / "tests/scenes/failures").glob("*.yaml"))
    scenes += [f"configs/extreme/{name}.yaml" for name in EXTREME]
    text = HEAD + "".join(section(program, scene) for scene in scenes)
    (ROOT / page).write_text(text)


main(*sys.argv[1:])
