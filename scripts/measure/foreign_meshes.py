"""Reads meshes that ship with Debian's packages, imports contact decks of CalculiX's tests and runs them beside CalculiX, and
measures how long reading takes; writes docs/data/foreign_meshes.md. Files are kept in out/foreign_meshes.

    foreign_meshes.py OSCULATE      called by scripts/measure/foreign_meshes, from the root of the repository
"""
import csv
import gzip
import math
import os
import re
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

import vtk

OUT = Path("out/foreign_meshes")
PAGE = Path("docs/data/foreign_meshes.md")
ONE_THREAD = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
REPETITIONS = 3
STIFFER = 1000  # the decks are soft: contact alone gives by a tenth of all displacement
PETSC = "/usr/share/petsc/3.18/share/petsc/datafiles/meshes/"
SFEPY = "/usr/share/doc/python-sfepy-doc/examples/meshes/"
CCX = "/usr/share/doc/calculix-ccx-test/examples/test/"
MAYAVI = "/usr/lib/python3/dist-packages/mayavi/tests/data/"
# package, file, repairs that it needs
MESHES = (
    ("mayavi2", "/usr/share/doc/mayavi2/examples/mayavi/data/fire_ug.vtu", "inverted"),
    ("python-sfepy-doc", SFEPY + "3d/acoustic_wg.vtk", ""),
    ("python-sfepy-doc", SFEPY + "3d/cylinder.vtk", ""),
    ("python-sfepy-doc", SFEPY + "3d/piezo_mesh_micro.vtk", ""),
    ("python-sfepy-doc", SFEPY + "3d/matrix_fiber_rand.vtk", "inverted"),
    ("mayavi2", MAYAVI + "uGridEx.vtk", "non_manifold"),
    ("mayavi2", MAYAVI + "disk_out_ref.ex2", ""),
    ("libpetsc3.18-dev-examples", PETSC + "blockcylinder-50.exo", ""),
    ("libpetsc3.18-dev-examples", PETSC + "FourBrickTet-large.exo", ""),
    ("libpetsc3.18-dev-examples", PETSC + "hybrid_hexwedge.exo", ""),
    ("libpetsc3.18-dev-examples", PETSC + "hybrid_tetwedge.msh", ""),
    ("libpetsc3.18-dev-examples", PETSC + "mesh-3d-box-innersphere.msh", ""),
    ("libpetsc3.18-dev-examples", PETSC + "mesh-3d-box-innersphere_bin.msh", ""),
    ("libpetsc3.18-dev-examples", PETSC + "gmsh-3d-ascii-64.msh", ""),
    ("libpetsc3.18-dev-examples", PETSC + "gmsh-3d-binary-64.msh", ""),
    ("libdune-grid-dev", "/usr/share/dune-grid/grids/gmsh/telescope2ndorder.msh", ""),
    ("python-sfepy-doc", SFEPY + "various_formats/msh_tetra.msh", ""),
    ("calculix-ccx-test", CCX + "hueeber1.inp.gz", ""),
    ("calculix-ccx-test", CCX + "scheibe2f2f.inp.gz", ""),
    ("calculix-ccx-test", CCX + "c3d6.inp", ""),
)
# package, file, part, tet10
GEOMETRIES = (
    ("gmsh-doc", "/usr/share/doc/gmsh-doc/doc/gmsh/tutorial/t20_data.step.gz", "", False),
    ("gmsh-doc", "/usr/share/doc/gmsh-doc/doc/gmsh/demos/boolean/component8.step.gz", "", True),
)
# deck, what it is
DECKS = (
    ("contactenergy", "two blocks, an element each, nodal forces"),
    ("cubespring", "two cubes, pressure, large strain"),
    ("friction1", "two cubes, pressure, large strain, friction"),
)
FACES = {"S1": (0, 1, 2, 3), "S2": (4, 7, 6, 5), "S3": (0, 4, 5, 1), "S4": (1, 5, 6, 2), "S5": (2, 6, 7, 3), "S6": (3, 7, 4, 0)}


class Failure(Exception):
    """Something did not come out as it should."""


def copied(path):
    """The file in OUT, unpacked."""
    source = Path(path)
    target = OUT / source.name.removesuffix(".gz")
    target.write_bytes(gzip.open(source).read() if source.suffix == ".gz" else source.read_bytes())
    return target


def run(command, folder=None, fail=True):
    started = time.perf_counter()
    p = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=ONE_THREAD)
    if fail and p.returncode:
        raise Failure(f"{' '.join(map(str, command))}: {p.stderr.strip()[:500]}")
    p.seconds = time.perf_counter() - started
    return p


# ---- meshes ----

def read_meshes(program):
    lines = ["| package | file | needs | nodes | elements | parts | surfaces | node sets | seconds |", "|---" * 9 + "|"]
    for package, path, repair in MESHES:
        file = copied(path)
        bare = run([program, "mesh", file], fail=False)
        if (bare.returncode != 0) != bool(repair):
            raise Failure(f"{path}: {bare.stderr[:300]}")
        done = run([program, "mesh", file, *(("--repair", repair) if repair else ())])
        size = re.match(r"(\d+) nodes, \d+ elements: (.*)", done.stdout)
        count = {word: len(re.findall(rf"^{word} ", done.stdout, re.M)) for word in ("part", "surface", "nodes")}
        needs = f"{repair}: {len(bare.stderr.splitlines())} faults named" if repair else "-"
        lines.append(f"| {package} | {file.name} | {needs} | {size[1]} | {size[2]} | {count['part']} | {count['surface']} | "
                     f"{count['nodes']} | {done.seconds:.2f} |")
    return lines


def mesh_geometry(program):
    lines = ["| package | file | part | elements asked for | nodes | elements | seconds | twice the same |", "|---" * 8 + "|"]
    for package, path, part, quadratic in GEOMETRIES:
        file = copied(path)
        scene = OUT / f"{file.stem}{'_10' if quadratic else ''}.yaml"
        scene.write_text("bodies:\n  part:\n    mesh: {cad: {path: " + file.name + (", quadratic: true" if quadratic else "") + (f", part: {part}" if part else "") + "}}\n"
                         "    material: {linear_elastic: {E: 210 GPa, nu: 0.3}}\n"
                         "sets: {held: {body: part, surface: face_1}}\nsupports: {held: {fix: [x, y, z]}}\nstages: {rest: {}}\n")
        frames = []
        for turn in range(2):
            done = run([program, "run", scene, "-o", OUT / f"{scene.stem}_{turn}", "--quiet", "--threads", str(1 + turn)])
            frames.append((OUT / f"{scene.stem}_{turn}" / "frames" / "part_00000.vtu").read_bytes())
        report = run([program, "check", scene]).stdout
        size = re.search(r"(\d+) nodes, (\d+) elements", report)
        lines.append(f"| {package} | {file.name} | {part or 'all'} | {'tet10' if quadratic else 'tet4'} | {size[1]} | {size[2]} | "
                     f"{done.seconds:.1f} | {'yes' if frames[0] == frames[1] else 'NO'} |")
        if frames[0] != frames[1]:
            raise Failure(f"{path}: meshes of two runs differ")
    return lines


# ---- speed ----

def write_block(n):
    """n^3 hexahedra in every format; returns the files."""
    m = n + 1
    points = [(i, j, k) for k in range(m) for j in range(m) for i in range(m)]
    number = lambda i, j, k: (k * m + j) * m + i
    cells = [[number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k), number(i, j, k + 1),
              number(i + 1, j, k + 1), number(i + 1, j + 1, k + 1), number(i, j + 1, k + 1)]
             for k in range(n) for j in range(n) for i in range(n)]
    files = {}
    with open(OUT / "block.inp", "w") as f:
        f.write("*NODE\n" + "".join(f"{p + 1},{x},{y},{z}\n" for p, (x, y, z) in enumerate(points)))
        f.write("*ELEMENT,TYPE=C3D8,ELSET=all\n" + "".join(f"{e + 1}," + ",".join(str(c + 1) for c in cell) + "\n" for e, cell in enumerate(cells)))
        f.write("*SURFACE,NAME=bottom\n" + "".join(f"{e + 1},S1\n" for e in range(n * n)))
    with open(OUT / "block_text.msh", "w") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        f.write("".join(f"{p + 1} {x} {y} {z}\n" for p, (x, y, z) in enumerate(points)) + "$EndNodes\n")
        f.write(f"$Elements\n{len(cells)}\n" + "".join(f"{e + 1} 5 2 1 1 " + " ".join(str(c + 1) for c in cell) + "\n" for e, cell in enumerate(cells)) + "$EndElements\n")
    with open(OUT / "block_binary.msh", "wb") as f:
        f.write(b"$MeshFormat\n4.1 1 8\n" + struct.pack("i", 1) + b"\n$EndMeshFormat\n$Nodes\n")
        f.write(struct.pack("=4Q3iQ", 1, len(points), 1, len(points), 3, 1, 0, len(points)) + struct.pack(f"{len(points)}Q", *range(1, len(points) + 1)))
        f.write(b"".join(struct.pack("3d", *p) for p in points) + b"\n$EndNodes\n$Elements\n")
        f.write(struct.pack("=4Q3iQ", 1, len(cells), 1, len(cells), 3, 1, 5, len(cells)))
        f.write(b"".join(struct.pack("9Q", e + 1, *(c + 1 for c in cell)) for e, cell in enumerate(cells)) + b"\n$EndElements\n")
    grid = vtk.vtkUnstructuredGrid()
    vertices = vtk.vtkPoints()
    for p in points:
        vertices.InsertNextPoint(p)
    grid.SetPoints(vertices)
    for cell in cells:
        grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, cell)
    for name, writer in (("block.vtu", vtk.vtkXMLUnstructuredGridWriter()), ("block.vtk", vtk.vtkUnstructuredGridWriter()),
                         ("block.exo", vtk.vtkExodusIIWriter())):
        writer.SetFileName(str(OUT / name))
        writer.SetInputData(grid)
        writer.Write()
    return ["block.vtu", "block.vtk", "block.exo", "block_text.msh", "block_binary.msh", "block.inp"]


def speed(program):
    lines = ["| file | MB | 125 000 hexahedra, s | 1 000 000, s | power |", "|---" * 5 + "|"]
    seconds = {}
    for n in (50, 100):
        for name in write_block(n):
            started = time.perf_counter()
            child = os.posix_spawn(program, [program, "mesh", str(OUT / name)], ONE_THREAD,
                                   file_actions=[(os.POSIX_SPAWN_OPEN, 1, "/dev/null", os.O_WRONLY, 0)])
            _, status, used = os.wait4(child, 0)
            if status:
                raise Failure(f"{name} with {n}^3 elements cannot be read")
            seconds[name, n] = used.ru_utime + used.ru_stime, (OUT / name).stat().st_size / 1e6
    for name in write_block(1):
        (small, _), (large, size) = seconds[name, 50], seconds[name, 100]
        lines.append(f"| {name} | {size:.0f} | {small:.2f} | {large:.2f} | {math.log(large / small) / math.log(8):.2f} |")
    return lines


# ---- decks ----

def sections(text):
    """[(keyword line, [data lines])]"""
    found = []
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            found.append((line.strip(), []))
        elif found:
            found[-1][1].append(line.strip())
    return found


def keyword(head):
    return head[1:].split(",")[0].strip().upper()


OUTPUTS = {"NODE PRINT", "EL PRINT", "NODE FILE", "EL FILE", "CONTACT FILE", "CONTACT PRINT"}


def variant(text, kind=None, stiffer=1):
    """The deck with contact of a kind and a penalty so many times the deck's, or without: slave nodes held. It prints
    displacements and reactions of all nodes."""
    parts = [part for part in sections(text) if keyword(part[0]) not in OUTPUTS]
    elements, slave = {}, set()
    for head, data in parts:
        if keyword(head) == "ELEMENT":
            for line in data:
                n = [int(w) for w in line.split(",") if w.strip()]
                elements[n[0]] = n[1:]
    lines = []
    name = next(data[0].split(",")[0].strip().upper() for head, data in parts if keyword(head) == "CONTACT PAIR")
    for head, data in parts:
        if keyword(head) == "SURFACE" and re.search(rf"NAME={name}\b", head.upper().replace(" ", "")):
            for line in data:
                element, face = (w.strip() for w in line.split(","))
                slave |= {elements[int(element)][k] for k in FACES[face.upper()]}
    for head, data in parts:
        word = keyword(head)
        if word == "CONTACT PAIR":
            if not kind:
                continue
            head = re.sub(r"TYPE *= *[A-Z ]+", f"TYPE={kind}", head)
        if not kind and word == "STEP":
            lines += ["*BOUNDARY", *(f"{n},1,3" for n in sorted(slave))]
        if word == "SURFACE BEHAVIOR":
            slope, *rest = data[0].split(",")
            data = [",".join([repr(stiffer * float(slope)), *rest])]
        if word == "END STEP":
            lines += ["*NODE PRINT,NSET=Nall", "U,RF"]
        lines += [head, *data]
    return "\n".join(lines) + "\n"


def by_calculix(name, text):
    folder = OUT / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "deck.inp").write_text(text)
    best = min((run(["ccx", "-i", "deck"], folder) for _ in range(REPETITIONS)), key=lambda p: p.seconds)
    if "Job finished" not in best.stdout:
        raise Failure(f"ccx, {name}: see {folder}")
    tables, current = {}, None
    for line in (folder / "deck.dat").read_text().splitlines():
        words = line.split()
        if "displacements" in line or "forces" in line:
            current = tables.setdefault("U" if "displacements" in line else "RF", {})
            current.clear()
        elif len(words) == 4 and current is not None:
            current[int(words[0])] = [float(w) for w in words[1:]]
    return {"seconds": best.seconds, "U": tables["U"], "RF": tables["RF"]}


def nodes_of(text):
    nodes = {}
    for head, data in sections(text):
        if keyword(head) == "NODE":
            for line in data:
                n, *x = line.split(",")
                nodes[int(n)] = tuple(float(w) for w in x)
    return nodes


def by_osculate(program, name, text, changes=()):
    folder = OUT / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "deck.inp").write_text(text)
    imported = run([program, "import", "deck.inp"], folder)
    (folder / "scene.yaml").write_text(imported.stdout)
    run([program, "check", "scene.yaml"], folder)
    options = [w for change in changes for w in ("--set", change)]
    best = min((run([program, "run", "scene.yaml", "-o", "out", "--quiet", "--threads", "1", *options], folder) for _ in range(REPETITIONS)),
               key=lambda p: p.seconds)
    rows = list(csv.DictReader((folder / "out/history.csv").open()))
    at, moved = {}, {}
    for path in sorted((folder / "out/frames").glob(f"*_{len(rows):05d}.vtu")):
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        grid = reader.GetOutput()
        u = grid.GetPointData().GetArray("displacement")
        for p in range(grid.GetNumberOfPoints()):
            at.setdefault(path.name.rsplit("_", 1)[0], []).append((grid.GetPoint(p), u.GetTuple(p)))
    # A point of the deck is the nearest of ours: bodies touch, so their numbers tell those at one place apart.
    nodes = nodes_of(text)
    pieces = pieces_of(text)
    for body, points in zip(sorted(at), pieces, strict=True):
        for n in points:
            x, u = min(at[body], key=lambda entry: sum((a - b) ** 2 for a, b in zip(entry[0], nodes[n])))
            moved[n] = u
    force = sum(float(v) for k, v in rows[-1].items() if k.endswith(".normal"))
    left_out = [line for line in imported.stderr.splitlines() if "chosen under output" not in line]
    return {"seconds": best.seconds, "U": moved, "force": force, "iterations": sum(int(r["iterations"]) for r in rows), "left_out": left_out}


def pieces_of(text):
    """Nodes of every connected piece, in order of its first element."""
    parent = {}
    def root(n):
        while parent.setdefault(n, n) != n:
            n = parent[n]
        return n
    first = {}
    elements = [[int(w) for w in line.split(",") if w.strip()][1:] for head, data in sections(text)
                if keyword(head) == "ELEMENT" for line in data]
    for cell in elements:
        for n in cell:
            parent[root(n)] = root(cell[0])
    order = {}
    for cell in elements:
        order.setdefault(root(cell[0]), []).append(cell)
    return [sorted({n for cell in cells for n in cell}) for cells in order.values()]


def largest(values):
    return max(sum(c * c for c in u) ** 0.5 for u in values)


def difference(a, b):
    """Largest over all nodes, of the largest displacement."""
    return largest([[p - q for p, q in zip(a[n], b[n])] for n in b]) / largest(b.values())


def contact_force(text, result):
    """What the lower body's supports take up: nodes of the first piece."""
    total = [sum(result["RF"][n][d] for n in pieces_of(text)[0]) for d in range(3)]
    return sum(c * c for c in total) ** 0.5


def decks(program):
    lines = ["| deck | program, contact | seconds | contact force | largest displacement | difference of the two, of that |", "|---" * 6 + "|"]
    notes = []
    for name, what in DECKS:
        found = [p for p in (Path(CCX) / f"{name}.inp", Path(CCX) / f"{name}.inp.gz") if p.exists()]
        text = copied(found[0]).read_text()
        held = variant(text)
        same = difference(by_osculate(program, f"{name}_held", held)["U"], by_calculix(f"{name}_held_calculix", held)["U"])
        if same > 1e-4:
            raise Failure(f"{name} without contact: displacements differ by {same:.1e}")
        node, surface = variant(text, "NODE TO SURFACE"), variant(text, "SURFACE TO SURFACE")
        stiff = variant(text, "SURFACE TO SURFACE", STIFFER)
        ours = by_osculate(program, f"{name}_node", node)
        notes += [f"- `{name}`, {what}: without contact and with the slave nodes held, the programs' displacements differ by {same:.0e} of the largest. "
                  f"Not as in the deck: {'; '.join(re.sub('^[^:]*:', 'line ', line) for line in ours['left_out']) or 'nothing'}."]
        for label, deck in (("node-to-surface", node), ("surface-to-surface", surface), (f"the same, {STIFFER} times as stiff", stiff)):
            run_of = ours if deck is node else by_osculate(program, f"{name}_{label[:7].replace(' ', '_')}", deck)
            theirs = by_calculix(f"{name}_calculix_{label[:7].replace(' ', '_')}", deck)
            for who, result, force in (("Osculate", run_of, run_of["force"]), ("CalculiX", theirs, contact_force(text, theirs))):
                apart = f"{difference(theirs['U'], run_of['U']):.1e}" if result is theirs else ""
                lines.append(f"| {name} | {who}, {label} | {result['seconds']:.2f} | {force:.6g} | {largest(result['U'].values()):.6g} | {apart} |")
    return lines, notes


def main(program):
    program = str(Path(program).resolve())
    shutil.rmtree(OUT, ignore_errors=True)
    OUT.mkdir(parents=True)
    meshes = read_meshes(program)
    geometry = mesh_geometry(program)
    table, notes = decks(program)
    times = speed(program)
    page = f"""\
`scripts/measure/foreign_meshes` writes this page. The programs use one thread. Seconds are wall time on a machine that also does other
things; those of the million elements are CPU time.

## Meshes that ship with Debian's packages
Read by `osculate mesh FILE`. A file that needs a repair is refused without it, and every fault is listed with the file's own numbers.

{chr(10).join(meshes)}

## Geometry meshed
Meshed by `mesh: {{cad: {{path: FILE}}}}`, with elements of a tenth of the geometry's diagonal, by two processes each, with one and with two threads.

{chr(10).join(geometry)}

## Contact decks of CalculiX's tests
The decks of `calculix-ccx-test` are imported by `osculate import`, checked and run, and solved by CalculiX with both kinds of
contact, with the same mesh and loads. Numbers are in the deck's units. Osculate's contact force is the sum of normal forces,
CalculiX's is the reaction of the lower body. Differences are those of nodal displacements, divided by the
largest displacement. A deck's laws are imported with it: pressure over closure, and the slope of stick, which in these decks give way by about a
tenth of the displacement. Osculate takes *node-to-surface* as `node` on `blend` and *surface-to-surface* as its default, averaged over facets.
Seconds are the best of {REPETITIONS} runs, and
include starting and writing.

{chr(10).join(notes)}

{chr(10).join(table)}

## A million elements
`osculate mesh` on a block of hexahedra: it reads the file, looks for every fault and finds the surfaces. The table shows CPU seconds and the power with which they grow.

{chr(10).join(times)}
"""
    PAGE.write_text(page)
    print(page)


if __name__ == "__main__":
    try:
        main(sys.argv[1])
    except Failure as failure:
        sys.exit(f"scripts/measure/foreign_meshes: {failure}")
