"""Puts the scenes of one page of invariance into another, in place of the rows that it has of them.

    python3 scripts/pages/merge_invariance.py PAGE PART
"""
import re
import sys
from pathlib import Path

SAME = 1e-7  # as in the test


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


def counted(lines):
    cells = [c.strip() for line in lines if is_row(line) for c in line.split("|")[3:-1]]
    fine = sum(all(float(x) < SAME for x in c.split(" / ")) for c in cells if not c.endswith("!"))
    scenes = sum(map(is_row, lines))
    text = f"{fine} of {len(cells)} cells are below 1e-7 with the same steps. {scenes} of the {scenes} scenes are listed."
    return [text if " cells are below " in line else line for line in lines]


def main():
    page, part = Path(sys.argv[1]), Path(sys.argv[2])
    old, new = sections(re.sub(r"\n\*Osculate [^\n]*\*\n$", "", page.read_text())), sections(part.read_text())
    replaced = {scene(line) for line in new[""] if is_row(line)}
    lines = []
    for heading, body in old.items():
        own = body if heading == "## Left out" else merged(body, new.get(heading, []), replaced)
        lines += counted(own) if heading == "" else own
    page.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
