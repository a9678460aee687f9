"""Tables and numbers of Markdown pages."""
import math


def number(value, digits=3, kind="g"):
    return "-" if value is None or math.isnan(value) else f"{value:.{digits}{kind}}"


def seconds(value):
    return number(value, 2) if value < 0.1 else number(value, 2 if value < 10 else 1, "f")


def table(header, rows):
    line = lambda cells: "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
    return "\n".join([line(header), "|---" * len(header) + "|", *map(line, rows)]) + "\n"
