"""What the Python commands of scripts/ have in common: each puts this folder first on sys.path and takes from here."""
import argparse
import datetime
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ONE_THREAD = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # environment of a run


def program():
    """The program itself: of OSCULATE_BUILD, default build/release; scripts/build makes it."""
    return ROOT / os.environ.get("OSCULATE_BUILD", "build/release") / "osculate"


STAMP = re.compile(r"\n\*Osculate (\d+\.\d+\.\d+), (\d{4}-\d\d-\d\d)\.\*\n$")


def stamp(page):
    """Says in the last line of a page that was written by which version, and when."""
    version = subprocess.run([program(), "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
    page.write_text(page.read_text() + f"\n*Osculate {version}, {datetime.date.today().isoformat()}.*\n")


def parser(about):
    """Of the arguments; -h prints `about`, line by line, below the usage and above what each option means."""
    command = Path(sys.argv[0]).resolve().relative_to(ROOT)
    return argparse.ArgumentParser(prog=str(command), description=about, formatter_class=argparse.RawDescriptionHelpFormatter)


def scenes(names=(), failures=False):
    """Paths of all shipped scenes, or of those with these names; with those of the tests that fail on purpose."""
    found = [path for folder in ("tutorials", "extreme", "validation", "paper") for path in sorted((ROOT / "configs" / folder).glob("*.yaml"))]
    if failures:
        found += sorted((ROOT / "tests/scenes/failures").glob("*.yaml"))
    if unknown := set(names) - {path.stem for path in found}:
        sys.exit("no scene " + ", ".join(sorted(unknown)))
    return [path for path in found if not names or path.stem in names]
