"""Kills runs at random moments; see scripts/checks/survive_kills."""
import argparse
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

# statics with sticking, slipping and two stages; impacts with cut steps, by two threads
RUNS = {
    "slide": ["configs/paper/half_tube.yaml", "--set", "bodies.tube.mesh.half_tube.divisions=[7,6,1]",
              "--set", "bodies.contactor.mesh.contactor.divisions=[5,6,1]", "--set", "stages.slide.steps=24",
              "--set", "output.iterations=true", "--threads", "1"],
    "throw": ["configs/validation/falling_block.yaml", "--set", "bodies.block.mesh.rotate={axis: [1, 2, 0], angle: 0.02}",
              "--set", "bodies.block.mesh.translate=[0, 0, -0.45]", "--set", "contact.floor.friction=0.8",
              "--set", "contact.floor.surface=blend", "--set", "stages.fall.duration=0.13",
              "--set", "stages.fall.steps=65", "--set", "output.iterations=true", "--threads", "2"],
}
SHARED = {
    "blocks": ["bench/scenes/two_blocks.yaml", "--set", "solver.linear_solver=multigrid", "--set", "solver.tolerance=1e-10",
               "--set", "bodies.lower.mesh.block.divisions=[7, 7, 7]", "--set", "bodies.upper.mesh.block.divisions=[5, 5, 5]",
               "--set", "stages.press.steps=12", "--threads", "1"],
}
# root, few processors and containers are no obstacles
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
       "OMPI_MCA_mpi_yield_when_idle": "1"}
PATIENCE = 60  # seconds until all processes have ended after one was killed
MANIFEST = "osculate_manifest.txt"
TABLES = ("history.csv", "steps.csv", "iterations.csv")


def contents(run):
    """Bytes by path of all that a run decides."""
    return {str(path.relative_to(run)): path.read_bytes() for path in sorted(run.rglob("*"))
            if path.is_file() and path.name not in ("summary.json", MANIFEST) and path.suffix != ".part"
            and "checkpoint" not in path.relative_to(run).parts}


def faults(run, whole):
    """What is wrong with the files that a killed run has left, beside the whole run's."""
    found = []
    for path, data in contents(run).items():
        if path in TABLES and not whole[path].startswith(data):
            found.append(f"{path} is not a beginning of the whole one")
        elif path in TABLES and data and not data.endswith(b"\n"):
            found.append(f"{path} ends within a row")
        elif path.startswith("frames/") and data != whole.get(path):
            found.append(f"{path} differs")
    listed = set((run / MANIFEST).read_text().split("\n")[1:]) if (run / MANIFEST).exists() else set()
    for path in run.rglob("*"):
        name = str(path.relative_to(run)).removesuffix(".part")
        if path.is_file() and name not in listed and not name.startswith(MANIFEST):
            found.append(f"{MANIFEST} does not list {name}")
    series = run / "series.pvd"
    if series.exists():
        for entry in xml.parse(series).getroot().iter("DataSet"):
            if not (run / entry.get("file")).exists():
                found.append(f"series.pvd lists {entry.get('file')}, which is missing")
    # the row of a step goes out before its record: nothing completed is missing but the step under way
    if (run / "steps.csv").exists() and (run / "history.csv").exists():
        accepted = (run / "steps.csv").read_bytes().count(b",accept,")
        rows = max(0, (run / "history.csv").read_bytes().count(b"\n") - 1)
        if not accepted - 1 <= rows <= accepted:
            found.append(f"{rows} rows of history for {accepted} accepted steps")
    return found


def one_of(process, chance):
    """The process itself, or one of those that mpirun has started; None where they have ended."""
    if process.args[0] != "mpirun":
        return process.pid
    children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    return int(chance.choice(children)) if children else None


def all_ended(process):
    """Whether those that mpirun has started have ended, whatever mpirun itself waits for."""
    def ended(child):
        try:
            state = pathlib.Path(f"/proc/{child}/stat").read_text().rsplit(")", 1)[1].split()[0]
        except FileNotFoundError:
            return True
        return state == "Z"
    return all(map(ended, pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()))


def killed_after(seconds, command, chance, stuck):
    """True where the command was killed, or one of its processes, False where it ended before. Appends to `stuck` where mpirun alone
    did not end after that: that of Open MPI 4.1.4 may wait for a lock that it holds."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          env={**os.environ, **MPI}) as process:
        try:
            code = process.wait(seconds)
        except subprocess.TimeoutExpired:
            victim = one_of(process, chance)
            if victim is not None:
                os.kill(victim, signal.SIGKILL)
            try:
                code = process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                ended = process.args[0] == "mpirun" and all_ended(process)
                process.terminate()  # mpirun takes those with it that have not ended
                try:
                    process.wait(10)
                except subprocess.TimeoutExpired:
                    process.kill()
                if not ended:
                    raise SystemExit(f"after one was killed, the others did not end: {' '.join(command)}") from None
                stuck.append(command)
                return True
            if code != 0:
                return True
    if code != 0:
        raise SystemExit(f"exit {code} of {' '.join(command)}")
    return False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--processes", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)
    runs, start, end = RUNS, [options.program], []
    if options.processes > 1:
        runs, end = SHARED, ["--distributed"]
        start = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(options.processes), options.program]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="osculate_kills_"))
    wholes, seconds = {}, {}
    for name, words in runs.items():
        begin = time.monotonic()
        subprocess.run([*start, "run", *words, "-o", str(folder / name), "--quiet", *end], check=True, stdin=subprocess.DEVNULL,
                       env={**os.environ, **MPI})
        seconds[name] = time.monotonic() - begin
        wholes[name] = contents(folder / name)
    stuck = []
    kills = bad = resumed = from_start = early = 0
    while kills < options.kills:
        name = chance.choice(list(runs))
        run, whole = folder / "run", wholes[name]
        shutil.rmtree(run, ignore_errors=True)
        first = [*start, "run", *runs[name], "-o", str(run), "--quiet",
                 "--checkpoint-every", str(chance.choice([1, 2, 5])), *end]
        again = [*start, "resume", str(run), "--quiet", "--checkpoint-every", "1",
                 "--threads", str(chance.choice([1, 2]) if not end else 1), *end]
        command = first
        for _ in range(chance.choice([1, 1, 2, 3])):
            if not killed_after(chance.uniform(0, 1.1 * seconds[name]), command, chance, stuck):
                early += 1
                break
            kills += 1
            for fault in faults(run, whole) if run.exists() else []:
                bad += 1
                print(f"kill {kills} of {name}: {fault}")
            command = again if (run / "checkpoint" / "state").exists() else first
        else:
            resumed += command is again
            from_start += command is first
            subprocess.run(command, check=True, stdin=subprocess.DEVNULL, env={**os.environ, **MPI})
            found = contents(run)
            for path in sorted(found.keys() | whole.keys()):
                if found.get(path) != whole.get(path):
                    bad += 1
                    print(f"after kill {kills} of {name}: {path} differs from the whole run's")
    shutil.rmtree(folder)
    if stuck:
        print(f"mpirun itself did not end after {len(stuck)} of the kills, though all that it had started had")
    print(f"{kills} kills, {resumed} runs resumed, {from_start} begun again before their first checkpoint, "
          f"{early} ended before they were killed: {bad} faults")
    return 1 if bad else 0


sys.exit(main())
