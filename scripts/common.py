"""What the Python commands of scripts/ have in common: each puts this folder first on sys.path and takes from here."""
import argparse
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ONE_THREAD = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}  # environment of a run


def program():
    """The program itself: of OSCULATE_BUILD, default build/release; scripts/build makes it."""
    return ROOT / os.environ.get("OSCULATE_BUILD", "build/release") / "osculate"


def parser(about):
    """Of the arguments; -h prints `about`, line by line, below the usage and above what each option means."""
    command = Path(sys.argv[0]).resolve().relative_to(ROOT)
    return argparse.ArgumentParser(prog=str(command), description=about, formatter_class=argparse.RawDescriptionHelpFormatter)
