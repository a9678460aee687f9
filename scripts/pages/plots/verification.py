"""Writes docs/verification from the tables of studies; called by scripts/pages/verification, from the root of the repository.

    verification.py --from DIR [NAME ...]   takes DIR/NAME/study.csv and plots into docs/verification, writes all pages
    verification.py --check                 exit 1 where a page is not what docs/verification/data makes it

Pages follow from docs/verification/data/*.csv and configs/studies/*.yaml alone.
"""
import csv
import math
import re
import shutil
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
import scoreboard
import study_file
from common import STAMP
from markdown import number, seconds, table

DOCS = Path("docs/verification")
DATA = DOCS / "data"
IMAGES = DOCS / "images"
# columns of study.csv that no page has a use for
DROPPED = re.compile(r"run|wall_seconds|same_bits|peak_memory_bytes|seconds\..*")
DIGITS = 12

# plots on the pages: quantities of a study, surfaces of a study of surfaces
PLOTS = {
    "cattaneo_mindlin": ["stick_half_width"],
    "falling_block": [],
    "foundation": ["inner_roughness"],
    "half_tube_ripple": ["ripple"],
    "hertz_cylinder": ["profile"],
    "hertz_elements": ["peak_pressure", "profile", "contact_radius"],
    "hertz_impact": [],
    "hertz_sphere": ["profile"],
    "incline": [],
    "metal_bar": [],
    "nested_tubes": ["pressure"],
    "rod_impact": ["displacement"],
    "surface_convergence": ["sphere", "torus", "saddle"],
    "surface_options": ["torus"],
    "table1": ["sphere", "saddle"],
    "taylor_patch": ["worst_pressure"],
    "time_integrators": ["momentum"],
    "two_bars": ["stress"],
}
# studies of surfaces: their files have no texts but the title
PAPER = "Qian et al., J. Comput. Appl. Math. 257 (2014)"
SURFACE_TEXTS = {
    "table1": {
        "problem": "Surfaces through the nodes of small hybrid meshes on a sphere and a saddle, as in Table 1 of the paper. "
                   "Its mesh is not\npublished; the meshes here have its errors of position and normal with plain facets. "
                   "`height_1` is the paper's form, the\nheight x3(x1, x2) on the 1-ring of each facet; `rpim_k` and "
                   "`blend_k` are those of Osculate, on k rings. `blend` is what contact uses by "
                   "default: 2 rings, with r^5 or r^3\npatch by patch.",
        "source": f"the exact surfaces; {PAPER}, Table 1, for the ratio of `height_1` to facets",
        "defects": "On the saddle the facets (0.9 m) are larger than the radius of curvature at its centre (0.47 m): no "
                   "surface on turned\nreference planes resolves it there. `height_1` has an advantage: it knows in which direction "
                   "the surface is a height. On one of the\neight meshes, where patches fold, positions are wrong by twice those of "
                   "facets; without it `blend` is as good as they are.",
    },
    "surface_convergence": {
        "problem": "How fast position, normal and mean curvature of surfaces through the nodes converge on irregular hybrid "
                   "meshes.",
        "source": "the exact surfaces",
        "defects": "On the torus and the saddle the orders of `blend` stay below those of the sphere, most of all in "
                   "curvature.",
    },
    "surface_options": {
        "problem": "Which rings and which radial basis for the blended surface: errors on irregular hybrid meshes. `blend_k` "
                   "is the k-ring with\nthe multiquadric R = 1.42, q = 1.03; `_r3` and `_r5` are polyharmonic, R = 0, q = 1.5 "
                   "and 2.5.\n`blend` takes r^5 or r^3 patch by patch, which is the default of contact.",
        "source": "the exact surfaces",
        "defects": "None of the options is better everywhere.",
    },
}
KINDS = {"position": "m", "normal": "rad", "curvature": "1/m"}


def unique(values):
    return list(dict.fromkeys(values))


def is_of_surfaces(study):
    return "surfaces" in study


def rows_of(name):
    with open(DATA / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def value(row, column):
    """A number of a row; NaN where there is none."""
    text = row.get(column) or ""
    return float(text) if text else math.nan


def slope(points):
    """Least squares of logarithms, as study::fit_power_law."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len(logs) < 2 or max(logs)[0] - min(logs)[0] < 1e-9:
        return math.nan
    n, x, y = len(logs), sum(a for a, _ in logs), sum(b for _, b in logs)
    return (n * sum(a * b for a, b in logs) - x * y) / (n * sum(a * a for a, _ in logs) - x * x)


def front(rows, quantity):
    """On the Pareto front of error and CPU seconds, as study::pareto_front."""
    known = [row for row in rows if value(row, f"{quantity}.error") >= 0]
    best = []
    for row in sorted(known, key=lambda r: (value(r, "cpu_seconds"), value(r, f"{quantity}.error"))):
        if not best or value(row, f"{quantity}.error") < value(best[-1], f"{quantity}.error"):
            best.append(row)
    return best


class Known(dict):
    def __missing__(self, _):  # constants scale the abscissa, which slopes do not see
        return 1.0


def abscissa(study, row):
    names = Known({key.removeprefix("parameter."): value(row, key) for key in row if key.startswith("parameter.")})
    names |= {"dofs": value(row, "dofs"), "pi": math.pi}
    default = "h" if "parameter.h" in row else "dofs"
    return eval(study.get("abscissa", default).replace("^", "**"), {"__builtins__": {}}, names)


def head(name, study, rows):
    texts = study | SURFACE_TEXTS.get(name, {})
    command = f"osculate study configs/studies/{name}.yaml"
    lines = [f"# {texts['title']}", "", texts["problem"], "", f"- Reference: {texts['source']}",
             f"- Command: `scripts/pages/verification --only {name}`, or for the study alone `{command}`"]
    if is_of_surfaces(study):
        lines.append(f"- Data: [data/{name}.csv](data/{name}.csv)")
    else:
        given_up = [row for row in rows if row["status"] != "done"]
        ended = f", {len(given_up)} of them without a result (below)" if given_up else ""
        cpu = sum(value(row, "cpu_seconds") for row in rows if row["cpu_seconds"])
        dofs = [int(row["dofs"]) for row in rows if row["dofs"]]
        most = f"{min(dofs)} to {max(dofs)}" if min(dofs) < max(dofs) else str(max(dofs))
        lines.append(f"- Runs: {len(rows)}{ended}, of {most} degrees of freedom, {seconds(cpu)} CPU seconds in all; every "
                     f"figure is in [data/{name}.csv](data/{name}.csv)")
    lines += ["", "## Known defects", "", texts.get("defects", "None that this study shows.")]
    return "\n".join(lines)


def series_of(study, axes, rows):
    """Runs that differ along `refine` alone, by the values of the other axes."""
    series = {}
    for row in rows:
        series.setdefault(tuple(row[axis] for axis in axes if axis != study["refine"]), []).append(row)
    return series


def series_table(study, axes, rows, cell, more=()):
    """A row per series, a column per value of `refine`; more: (head, cell of the series' rows)."""
    refine = study["refine"]
    values = unique(row[refine] for row in rows)
    others = [axis for axis in axes if axis != refine]
    lines = []
    for key, runs in series_of(study, axes, rows).items():
        by_value = {row[refine]: row for row in runs}
        cells = [cell(by_value[v]) if v in by_value else "" for v in values]
        lines.append([*key, *cells, *(of(runs) for _, of in more)])
    columns = [v if re.search(r"[A-Za-z]", v) and not re.fullmatch(r"[\d.]+e-?\d+", v) else f"{refine} {v}" for v in values]
    return table([*others, *columns, *(title for title, _ in more)], lines)


def quantity_section(name, study, axes, rows, quantity):
    of = study["quantities"][quantity]
    label, unit = of.get("label", quantity), of.get("unit", "")
    in_unit = f", {unit}" if unit else ""
    text = f"## {label[0].upper()}{label[1:]}\n\n"
    has_value, has_error = "exact" not in of, "exact" in of or "reference" in of
    last = lambda column, form: lambda runs: form(value(runs[-1], column))
    if not has_error:
        return text + series_table(study, axes, rows, lambda row: number(value(row, f"{quantity}.value"), 5)) + "\n"
    references = unique(row.get(f"{quantity}.reference", "") for row in rows if row["status"] == "done")
    relative = of.get("error") != "absolute" and any(float(r) for r in references if r)
    if not has_value:
        text += "Errors" + (f" over {of['scale']}" if "scale" in of else in_unit)
    else:
        text += "Relative errors" if relative else f"Errors{in_unit}"
        if of["reference"] == "finest":
            text += "; the reference is the finest run"
        elif len(references) == 1:
            reference = float(references[0])
            text += f"; the reference is {number(reference, 6)}" + (f" {unit}" if unit and reference else "")
    text += ". *Last* columns are those of the last run of a row.\n\n"
    slopes = [(f"slope over {study.get('abscissa_label', study.get('abscissa', 'h'))}",
               lambda runs: number(slope([(abscissa(study, r), value(r, f"{quantity}.error")) for r in runs]), 2, "f")),
              ("slope over CPU s",
               lambda runs: number(slope([(value(r, "cpu_seconds"), value(r, f"{quantity}.error")) for r in runs]), 2, "f"))]
    more = []
    if has_value:
        more.append((f"last value{in_unit}", last(f"{quantity}.value", lambda v: number(v, 6))))
        if len(references) > 1 and of["reference"] != "finest":
            more.append(("last reference", last(f"{quantity}.reference", lambda v: number(v, 6))))
    more.append(("last CPU s", last("cpu_seconds", seconds)))
    text += series_table(study, axes, rows, lambda row: number(value(row, f"{quantity}.error")), slopes + more)
    text += "\n" + fronts(study, axes, rows, quantity)
    for kind, what in (("work", "error over CPU seconds"), ("convergence", "convergence")):
        if quantity in PLOTS[name]:
            text += f"\n![{label}: {what}](images/{name}_{quantity}_{kind}.png)\n"
    return text


def fronts(study, axes, rows, quantity):
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[axis] for axis in study["problems"]), []).append(row)
    lines = []
    for key, runs in groups.items():
        entries = [f"{' '.join(r[a] for a in axes if a not in study['problems'])} "
                   f"({number(value(r, f'{quantity}.error'))}, {seconds(value(r, 'cpu_seconds'))} s)"
                   for r in front(runs, quantity)]
        if entries:
            lines.append(f"On the Pareto front of error and CPU seconds{''.join(f', {k}' for k in key)}: "
                         + "; ".join(entries) + ".\n")
    return "\n".join(lines)


def page(name):
    study, rows = study_file.read(name), rows_of(name)
    if is_of_surfaces(study):
        return surface_page(name, study, rows)
    axes = list(study["axes"])
    parts = [head(name, study, rows)]
    parts += [quantity_section(name, study, axes, rows, q).rstrip("\n") for q in study["quantities"]]
    times = series_table(study, axes, rows, lambda row: seconds(value(row, "cpu_seconds")))
    parts.append("## CPU seconds\n\n" + times.rstrip("\n"))
    failed = [[*(row[a] for a in axes), row["status"].replace("_", " "), row["reason"]]
              for row in rows if row["status"] != "done"]
    if failed:
        parts.append("## Runs without a result\n\n" + table([*axes, "status", "reason"], failed).rstrip("\n"))
    return "\n\n".join(parts) + "\n"


def surface_page(name, study, rows):
    orders = "refined" in study["meshes"]
    parts = [head(name, study, rows)]
    methods = unique(row["method"] for row in rows)
    for surface in unique(row["surface"] for row in rows):
        for kind, unit in KINDS.items():
            published = re.search(kind + r": ([\d.]+)", study["surfaces"][surface].get("published", ""))
            lines, fits = [], []
            of = lambda mesh, method: next(r for r in rows
                                           if (r["surface"], r["mesh"], r["method"]) == (surface, mesh, method))
            meshes = unique(row["mesh"] for row in rows if row["surface"] == surface)
            mean = lambda mesh, method: value(of(mesh, method), f"{kind}.mean")
            for mesh in meshes:
                first = of(mesh, methods[0])
                lines.append([f"{first['facets']}, {number(value(first, 'size'))} m",
                              *(number(mean(mesh, method)) for method in methods)])
            for method in methods:
                fits.append(slope([(value(of(m, method), "size"), mean(m, method)) for m in meshes]) if orders else
                            math.exp(sum(math.log(mean(m, method) / mean(m, methods[0])) for m in meshes) / len(meshes)))
            lines.append(["order" if orders else "ratio to facets, geometric mean",
                          *(number(f, 2 if orders else 3, "f") for f in fits)])
            if published:
                lines.append(["published ratio", *(published[1] if m == "height_1" else "" for m in methods)])
            parts.append(f"## {surface.capitalize()}: {kind}, {unit}\n\nMean errors over the area.\n\n"
                         + table(["facets, size", *methods], lines).rstrip("\n"))
        if "cpu_seconds" in rows[0]:
            lines = [[first["facets"], *(seconds(value(of(mesh, method), "cpu_seconds")) for method in methods)]
                     for mesh in meshes for first in [of(mesh, methods[0])]]
            parts.append(f"## {surface.capitalize()}: CPU seconds\n\n" + table(["facets", *methods], lines).rstrip("\n"))
        if surface in PLOTS[name]:
            parts.append(f"![{surface}: errors](images/{name}_study_{surface}.png)")
    lost = [f"- {r['method']} on mesh {r['mesh']} of the {r['surface']}: {r['missing']} of {r['points']}" for r in rows
            if int(r["missing"])]
    if lost:
        parts.append("## Samples without a point\n\nMeans leave them out.\n\n" + "\n".join(lost))
    return "\n\n".join(parts) + "\n"


def shortened(text):
    try:
        return f"{float(text):.{DIGITS}g}" if not re.fullmatch(r"-?\d+", text) else text
    except ValueError:
        return re.sub(r"(^|\s)/\S*/", r"\1", text)  # files are named without their folders


def take(folder, name):
    """The table and the plots of a study that is finished."""
    with open(folder / "study.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    study = study_file.read(name)
    axes = list(study.get("axes", ()))
    needed = [*axes, *(f"{quantity}.value" for quantity in study.get("quantities", ()))]
    plots = {folder / plot.name.removeprefix(f"{name}_"): plot for plot in images(name)}
    why = ("is not finished" if any(row.get("status") == "waiting" for row in rows) else
           "was run from another study file" if any(column not in rows[0] for column in needed) else
           "has no plots; gnuplot draws them" if not all(plot.is_file() for plot in plots) else "")
    if why:
        print(f"verification: {folder} {why}; left out", file=sys.stderr)
        return
    columns = [c for c in rows[0] if not DROPPED.fullmatch(c) and any(row[c] for row in rows)]
    columns += [c for c in ("reason",) if c in rows[0] and c not in columns]
    with open(DATA / f"{name}.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([row[c] if c in axes else shortened(row[c]) for c in columns] for row in rows)
    for drawn, plot in plots.items():
        shutil.copyfile(drawn, plot)


def images(name):
    if is_of_surfaces(study_file.read(name)):
        return [IMAGES / f"{name}_study_{surface}.png" for surface in PLOTS[name]]
    return [IMAGES / f"{name}_{q}_{kind}.png" for q in PLOTS[name] for kind in ("work", "convergence")]


def pages():
    """Of the studies there are data of: path -> text."""
    known = [name for name in study_file.names() if (DATA / f"{name}.csv").is_file()]
    texts = {DOCS / f"{name}.md": page(name) for name in known}
    texts[DOCS / "README.md"] = scoreboard.page({name: (study_file.read(name) | SURFACE_TEXTS.get(name, {}), rows_of(name))
                                                 for name in known})
    return texts


def check():
    texts = pages()
    wrong = [f"{path} is not what {DATA} makes it" for path, text in texts.items()
             if not path.is_file() or STAMP.sub("", path.read_text()) != text]
    wrong += [f"{name} has no data" for name in study_file.names() if DOCS / f"{name}.md" not in texts]
    wrong += [f"{path} belongs to no study" for path in sorted(DOCS.glob("*.md")) if path not in texts]
    drawn = {plot for name in study_file.names() for plot in images(name)}
    wrong += [f"{path} is on no page" for path in sorted(IMAGES.glob("*")) if path not in drawn]
    for path, text in texts.items():
        wrong += [f"{path}: {link} is missing" for link in re.findall(r"\]\(([^)#:]+)\)", text)
                  if not (DOCS / link).exists()]
    for line in wrong:
        print(line)
    return not wrong


def main():
    arguments = sys.argv[1:]
    if arguments == ["--check"]:
        sys.exit(0 if check() else 1)
    if len(arguments) < 2 or arguments[0] != "--from":
        sys.exit(__doc__)
    for folder in (DATA, IMAGES):
        folder.mkdir(parents=True, exist_ok=True)
    runs = Path(arguments[1])
    for name in arguments[2:] or study_file.names():
        if (runs / name / "study.csv").is_file():
            take(runs / name, name)
        else:
            print(f"verification: no {runs / name}/study.csv; left out", file=sys.stderr)
    for path, text in pages().items():
        path.write_text(text)


if __name__ == "__main__":
    main()
