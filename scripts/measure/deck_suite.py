"""Imports the mechanical decks of CalculiX's test package, runs those that lose nothing, and compares with CalculiX.

    deck_suite.py OSCULATE [DECK...]      called by scripts/measure/deck_suite, from the root of the repository
    deck_suite.py OSCULATE --sample       the test decks.sample: some decks, each of which has to agree; exit 77 without CalculiX
"""
import gzip
import os
import re
import resource
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

try:
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
except ImportError:
    if "--sample" not in sys.argv:
        raise
    print("Python's VTK is not installed")
    sys.exit(77)

DECKS = Path("/usr/share/doc/calculix-ccx-test/examples/test")
OUT = Path("out/deck_suite")
PAGE = Path("docs/data/deck_suite.md")
SECONDS = 120  # of a processor, for each run
# Of each kind of element, load, law and link one that agrees to 1 %; a second of CalculiX in all.
SAMPLE = ["achtelp", "axial", "beamf2", "beamnld", "beamnlmpc", "beamp1rotate", "beampis", "beamptied5", "beamt", "changefric", "contact2",
          "cubef2f2", "cubespring", "disk2", "fricloop", "friction1", "planestrain2", "planestress", "plate", "ring2", "segmentf"]
LARGEST = 10   # decks whose times are compared
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
# Why decks differ by more than 1 %, where it is known.
REASONS = {
    "bolt": "a plate lies 1.5 mm inside the bolt where no pair has its surface: the audit of geometry refuses the first step",
    "contact1": "a single slave node has a quarter of each outer face around it there, also of its sides; here only of what faces the master",
    "beamimpdy1nodirect": "its steps are coarse, and integrators differ: with a tenth of them 1e-6",
    "beamimpdy2": "its steps are coarse, and integrators differ: with a tenth of them 1e-3",
    "beamnldyp": "its steps are coarse, and integrators differ: with a tenth of them 6e-5",
    "beampiso": "stretched by 5 %, a bar of this metal has the stress of its law and true strain here, 0.4 % more there: 3 % of a beam near its limit load",
    "beampisof": "as beampiso",
    "beamnh": "the volumetric part of the law differs",
    "beamnldy": "the first trial turns an element inside out, so that its one step becomes two",
    "beamnldynodirect": "as beamnldy",
    "contact4": "of one element a side: the force on a face with midside nodes goes by linear pieces here, by its own functions there",
    "beamcontact": "the master ends in the middle of a slave face of one element: contact reaches to the next node here; "
                   "a mesh four times as fine is within 5 % of CalculiX on this one",
    "cubef2f3": "nodes of the slave follow points of the master there, which no patch test passes",
    "metalforming": "CalculiX's two decks of this part differ by 17 %; here both with `surface: facets` are within 1 % of its mortar",
    "metalformingmortar": "the tools are coarse polygons, smooth here; with `surface: facets` 1 %",
    "ring1": "at finite strain a temperature is a stretch here, and taken off Green's strain there",
    "scheibe2n2f": "nothing but the facets holds the inner disc against turning; CalculiX's two kinds of contact differ by 1.5 % too",
    "segment2": "centrifugal forces are integrated in full here, with eight points there",
}
# What no mechanical deck of solid bodies has.
OTHER = r"\*(HEAT TRANSFER|CFD|ELECTROMAGNETICS|COUPLED TEMPERATURE|UNCOUPLED TEMPERATURE|NETWORK|FLUID)|TYPE *= *(F3D|D[A-Z]|U\d)"


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def run(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    p = subprocess.run(command, cwd=folder, capture_output=True, text=True, errors="replace", env=ONE_THREAD,
                       preexec_fn=limited)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    p.cpu = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return p


def text_of(path):
    return (gzip.open(path).read() if path.suffix == ".gz" else path.read_bytes()).decode(errors="replace")


def decks():
    """Name and text of mechanical decks, those with contact or ties first."""
    found = {}
    for path in sorted(DECKS.glob("*.inp*")):
        name = path.name.removesuffix(".gz").removesuffix(".inp")
        text = text_of(path)
        plain = "\n".join(line for line in text.splitlines() if not line.startswith("**")).upper()
        if not re.search(r"^\*(STATIC|DYNAMIC)", plain, re.M) or re.search(OTHER, plain):
            continue
        found[name] = (text, bool(re.search(r"^\*(CONTACT *PAIR|TIE)", plain, re.M)))
    return found


def by_calculix(name, folder):
    """Positions and displacements of the nodes at the end, by their numbers."""
    positions, displacements, block = {}, {}, None
    p = run(["ccx", name], folder)
    result = folder / f"{name}.frd"
    if p.returncode or not result.exists():
        return None, None, p.cpu
    for line in result.open(errors="replace"):
        if line.startswith("    2C"):
            block = positions
        elif line.startswith(" -4"):
            block = None
            if "DISP" in line:
                block = displacements = {}
        elif line.startswith(" -3"):
            block = None
        elif line.startswith(" -1") and block is not None:
            block[int(line[3:13])] = [float(line[13 + 12 * k:25 + 12 * k]) for k in range(3)]
    return positions, displacements, p.cpu


def by_osculate(folder):
    """Positions and displacements of the nodes of all bodies at the end."""
    steps = [(float(e.get("timestep")), e.get("file")) for e in xml.parse(folder / "run/series.pvd").iter("DataSet")]
    last = max(time for time, _ in steps)
    X, u = [], []
    for time, file in steps:
        if time != last or not file.endswith(".vtu"):
            continue
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(folder / "run" / file))
        reader.Update()
        grid = reader.GetOutput()
        X.append(vtk_to_numpy(grid.GetPoints().GetData()))
        u.append(vtk_to_numpy(grid.GetPointData().GetArray("displacement")))
    return numpy.vstack(X), numpy.vstack(u)


def difference(positions, displacements, X, u, plane):
    """Largest difference, of the largest displacement; of nodes in one place the nearest counts."""
    components = 2 if plane else 3
    ours = {}
    size = max(numpy.abs(X).max(), 1e-300)
    for k, x in enumerate(numpy.round(X[:, :components] / size, 5)):
        ours.setdefault(tuple(x + 0.0), []).append(k)
    worst, largest, matched = 0.0, 0.0, 0
    for node, value in displacements.items():
        value = numpy.array(value[:components])
        largest = max(largest, numpy.linalg.norm(value))
        here = ours.get(tuple(numpy.round(numpy.array(positions[node][:components]) / size, 5) + 0.0))
        if here is None:
            continue
        matched += 1
        worst = max(worst, min(numpy.linalg.norm(u[k, :components] - value) for k in here))
    return worst / largest if largest > 0 and matched else None


def one(program, name, text):
    """What became of a deck."""
    folder = OUT / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    # displacements of all nodes, whatever else the deck asks for; eigenmodes would take their place
    text = re.sub(r"(?ims)^\*step.*?^\*end *step[^\n]*\n?", lambda s: "" if re.search(r"(?im)^\*frequency", s[0]) else s[0], text)
    (folder / f"{name}.inp").write_text(re.sub(r"(?im)^\*end *step", "*NODE FILE\nU\n*END STEP", text))
    row = {"name": name, "import": "lost", "nodes": 0}
    imported = run([program, "import", f"{name}.inp"], folder)
    if imported.returncode == 2:
        row["import"] = "refused"
    if imported.returncode:
        return row
    row["import"] = "all"
    (folder / "scene.yaml").write_text(imported.stdout)
    p = run([program, "run", "scene.yaml", "-o", "run", "--threads", "1", "--quiet"], folder)
    row["end"] = {0: "done", 2: "refused", 3: "gave up"}.get(p.returncode, f"exit {p.returncode}")
    positions, displacements, row["ccx"] = by_calculix(name, folder)
    row["cpu"] = p.cpu
    if row["end"] == "done" and displacements:
        X, u = by_osculate(folder)
        row["nodes"] = len(X)
        row["difference"] = difference(positions, displacements, X, u, "slice:" in imported.stdout)
    return row


def counts(rows):
    clean = [r for r in rows if r["import"] == "all"]
    within = [sum(1 for r in clean if r.get("difference") is not None and r["difference"] <= bound)
              for bound in (0.01, 0.005, 0.001)]
    done = sum(1 for r in clean if r["end"] == "done")
    return f"| {len(rows)} | {len(clean)} | {done} | {within[0]} | {within[1]} | {within[2]} |"


def table(rows):
    lines = ["| deck | nodes | end | difference | reason |", "|---" * 5 + "|"]
    for r in rows:
        if r["import"] == "all":
            d = r.get("difference")
            far = r["end"] != "done" or (d is not None and d > 0.01)
            reason = REASONS.get(r["name"], "not found") if far else "no node in the same place" if d is None else ""
            lines.append(f"| {r['name']} | {r['nodes'] or ''} | {r['end']} | {'' if d is None else f'{d:.1e}'} | {reason} |")
    return lines


def page(contact, others):
    lines = ["# CalculiX's own decks", "",
             "Generated by `scripts/measure/deck_suite` from the decks of Debian's calculix-ccx-test: those with a *STATIC or *DYNAMIC step, "
             "and neither heat nor flow. Each is imported as it is; what would lose a load, a contact or a law is not run. The "
             "difference is the largest of all nodes at the end of the last step, of the largest displacement; in the plane for "
             "plane decks. Of nodes in one place the nearest counts.", "",
             "| | decks | without loss | to the end | within 1 % | 0.5 % | 0.1 % |", "|---" * 7 + "|",
             "| contact and ties " + counts(contact), "| others " + counts(others), ""]
    largest = sorted((r for r in contact + others if r.get("nodes") and r["ccx"] > 0), key=lambda r: -r["nodes"])
    lines += [f"## The {LARGEST} largest that both run", "",
              "Processor seconds with one thread, start included. CalculiX takes one increment where Osculate may take more.", "",
              "| deck | nodes | Osculate, s | CalculiX, s |", "|---" * 4 + "|"]
    lines += [f"| {r['name']} | {r['nodes']} | {r['cpu']:.2f} | {r['ccx']:.2f} |" for r in largest[:LARGEST]]
    lines += ["", "## Contact and ties", "", *table(contact), "", "## Others", "", *table(others), ""]
    PAGE.write_text("\n".join(lines))


def sample(program):
    known = decks() if DECKS.is_dir() else {}
    if shutil.which("ccx") is None or not known:
        print("CalculiX or its decks are not installed")
        return 77
    failed = 0
    for name in SAMPLE:
        row = one(program, name, known[name][0])
        agrees = row.get("difference") is not None and row["difference"] <= 0.01
        print(name, row["import"], row.get("end", ""), row.get("difference", ""), "" if agrees else "FAILED", flush=True)
        failed += not agrees
    return 1 if failed else 0


def main(program, wanted):
    if wanted == ["--sample"]:
        return sample(program)
    rows = {True: [], False: []}
    for name, (text, contact) in decks().items():
        if wanted and name not in wanted:
            continue
        row = one(program, name, text)
        rows[contact].append(row)
        if row["import"] == "all" or wanted:
            print(name, row["import"], row.get("end", ""), row.get("difference", ""), flush=True)
    if not wanted:
        page(rows[True], rows[False])
    return 1 if any(r.get("end", "done") not in ("done", "refused", "gave up") for r in rows[True] + rows[False]) else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1]), sys.argv[2:]))
