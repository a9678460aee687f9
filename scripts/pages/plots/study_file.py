"""Reads what the pages need of configs/studies/*.yaml (no yaml module is needed): the subset of YAML those files use."""
import re
from pathlib import Path

FOLDER = Path("configs/studies")


def names():
    """Studies that measure errors: those of values alone are a matrix, their study.md, and have no page."""
    of_errors = re.compile(r"^ *(- )?(reference|exact|surfaces):|[{,] *(reference|exact):", re.MULTILINE)
    return sorted(path.stem for path in FOLDER.glob("*.yaml") if of_errors.search(path.read_text()))


def indent(line):
    return len(line) - len(line.lstrip())


def scalar(text):
    text = text.strip()
    if text[:1] in ('"', "'"):
        return text[1:text.index(text[0], 1)]
    return re.sub(r"(^|\s+)#.*$", "", text).strip()


def mapping(lines):
    """Block mappings become dicts, everything else text; flow values stay as they are written."""
    result = {}
    at = 0
    while at < len(lines):
        line = lines[at]
        at += 1
        found = re.match(r'\s*("?)([\w.\- ]+)\1:(\s+(.*))?$', line)
        if not found or line.lstrip().startswith(("#", "- ")):
            continue
        inner = []
        while at < len(lines) and (not lines[at].strip() or indent(lines[at]) > indent(line)):
            inner.append(lines[at])
            at += 1
        key, text = found[2], scalar(found[4] or "")
        if text == "|":
            depth = indent(inner[0])
            text = "\n".join(part[depth:] for part in inner).strip()
        elif text == ">-":
            text = " ".join(part.strip() for part in inner).strip()
        elif not text:
            text = mapping(inner)
        result[key] = text
    return result


def read(name):
    study = mapping((FOLDER / f"{name}.yaml").read_text().splitlines())
    study["problems"] = re.findall(r"[\w.]+", study.get("problems", ""))
    return study
