"""Puts the scenes of one page of invariance into another, in place of the rows that it has of them; without PART, only the column of
processes, the worst of a row of docs/data/ranks.md.

    python3 scripts/pages/merge_invariance.py PAGE [PART]
"""
import re
import sys
from pathlib import Path

SAME = 1e-7  # as in the test
PROCESSES = "1 to 4 processes"
RANKS = Path(__file__).resolve().parents[2] / "docs/data/ranks.md"
EXPLAINS = """The last column is from [data/ranks.md](data/ranks.md): the worst of the same scene, whole and on the mesh of its file, shared by one to four
processes, against one process, histories / displacements."""


def is_row(line):
    return re.match(r"(\| |- )(paper|tutorials|extreme)/", line) is not None


def scene(line):
    return re.match(r"(?:\| |- )([^ :|]+)", line)[1]


def sections(text):
    """Lines by headings; the head of the page has none."""
    found = {"": []}
    for line in text.splitlines():
        if line.startswith("## "):
            found[line] = []
        found[list(found)[-1]].append(line)
    return found


def merged(old, new, replaced):
    rows = {scene(line): line for line in old if is_row(line)}
    if new:
        rows = {name: line for name, line in rows.items() if name not in replaced}
        rows |= {scene(line): line for line in new if is_row(line)}
    lines, done = [], False
    for line in old:
        if not is_row(line):
            lines.append(line)
        elif not done:
            done = True
            lines += [rows[name] for name in sorted(rows)]
    return lines


def without_processes(lines):
    """The table as the test writes it."""
    return [line[:line.rstrip(" |").rindex("|") + 1] if place in (0, 1) and PROCESSES in lines[at] else line
            for line, (at, place) in zip(lines, heads(lines))]


def heads(lines):
    """(line of the table's head, 0 for it and the scenes, 1 for what separates them, else -1) of every line."""
    at, found = 0, []
    for number, line in enumerate(lines):
        if line.startswith("| scene |"):
            at = number
        found.append((at, 1 if line.startswith("|---") else 0 if is_row(line) and line.startswith("|") or line.startswith("| scene |") else -1))
    return found


def worst(cells):
    """Of cells "a / b", with the ! of any, and what others say in words."""
    pairs = [[float(x) for x in re.sub("!", "", cell).split("/")] for cell in cells if "/" in cell]
    words = dict.fromkeys(cell for cell in cells if cell and "/" not in cell)
    if not pairs:
        return ", ".join(words) or "not run"
    numbers = " / ".join(f"{max(column):.0e}".replace("e-0", "e-").replace("e+00", "") for column in zip(*pairs)) + (
        " !" if any("!" in cell for cell in cells) else "")
    return ", ".join([numbers, *words])


def with_processes(lines, ranks):
    """Adds the column to the first table of the page."""
    cells = {scene(line): worst([c.strip() for c in line.split("|")[3:-1]]) for line in ranks.splitlines() if is_row(line)}
    ends = {0: lambda line: f" {PROCESSES} |" if line.startswith("| scene |") else f" {cells.get(scene(line), 'not run')} |",
            1: lambda line: "---|", -1: lambda line: ""}
    return [line + ends[place](line) for line, (_, place) in zip(lines, heads(lines))]


def counted(lines):
    cells = [c.strip() for line in lines if is_row(line) for c in line.split("|")[3:-1]]
    fine = sum(all(float(x) < SAME for x in c.split(" / ")) for c in cells if not c.endswith("!"))
    scenes = sum(map(is_row, lines))
    text = f"{fine} of {len(cells)} cells are below 1e-7 with the same steps. {scenes} of the {scenes} scenes are listed."
    return [text if " cells are below " in line else line for line in lines]


def main():
    page = Path(sys.argv[1])
    old = sections(re.sub(r"\n\*Osculate [^\n]*\*\n$", "", page.read_text()))
    head = [line for line in without_processes(old[""]) if line not in EXPLAINS.splitlines()]
    if len(sys.argv) > 2:
        new = sections(Path(sys.argv[2]).read_text())
        replaced = {scene(line) for line in new[""] if is_row(line)}
        head = counted(merged(head, new.get("", []), replaced))
        old |= {heading: merged(body, new.get(heading, []), replaced) for heading, body in old.items()
                if heading not in ("", "## Left out")}
    table = next(i for i, line in enumerate(head) if line.startswith("| scene |"))
    explained = [*head[:table], *EXPLAINS.splitlines(), "", *head[table:]]
    if explained[table - 1] == "" and head[table - 2] == "":
        del explained[table - 1]
    old[""] = with_processes(explained, RANKS.read_text())
    page.write_text("\n".join(line for body in old.values() for line in body) + "\n")


if __name__ == "__main__":
    main()
