#!/usr/bin/env python3
"""Prints results of Google Benchmark (JSON) as Markdown tables with ratios.

    bench/table.py bench.json

The fastest repetition of each benchmark counts. A ratio is the time per item over that of the first row of its group.
"""
import json
import sys

# group: what its name begins with, what an item is
GROUPS = [
    ("Evaluation, half-tube, values", "evaluate/half_tube/values/", "slave point"),
    ("Evaluation, half-tube, with variation", "evaluate/half_tube/variation/", "slave point"),
    ("Evaluation, flat block 25 x 25, values", "evaluate/block/values/", "slave point"),
    ("Evaluation, flat block 25 x 25, with variation", "evaluate/block/variation/", "slave point"),
    ("Placing the patches of blend in a configuration", "prepare/", "patch"),
    ("Building the patches of the half-tube", "build/half_tube/", "patch"),
    ("Building the patches of the flat block", "build/block/", "patch"),
    ("Fit of one patch, nodes a side", "patch/fit/", "patch"),
    ("Coefficients of a patch, nodes a side", "patch/coefficients/", "patch"),
    ("Weights of a patch, nodes a side", "patch/weights/", "point"),
    ("Projection", "project/", "point"),
    ("Building the search tree, facets a side", "search/build/", "facet"),
    ("Global search, facets a side", "search/global/", "slave point"),
    ("Tracking, facets a side", "search/track/", "slave point"),
    ("Product with and assembly of a block's stiffness, elements along an edge", "block/", "unknown"),
    ("Factors of a block's stiffness, elements along an edge", "factor/", "unknown"),
    ("Solving with them, on the contact nodes alone, or one cycle", "apply/", "unknown"),
    ("Element stiffness", "stiffness/", "element"),
]


def seconds_per_item(path):
    """Best CPU seconds per item by name; the benchmarks are single-threaded."""
    best = {}
    with open(path, encoding="utf-8") as file:
        for run in json.load(file)["benchmarks"]:
            if run["run_type"] == "iteration" and not run.get("error_occurred"):
                name = run["run_name"]
                best[name] = min(best.get(name, float("inf")), 1 / run["items_per_second"])
    return best


def microseconds(seconds):
    return f"{1e6 * seconds:.3g}" if seconds < 1e-3 else f"{1e6 * seconds:.0f}"


def main(path):
    best = seconds_per_item(path)
    for title, prefix, item in GROUPS:
        rows = [(name.removeprefix(prefix), time) for name, time in best.items() if name.startswith(prefix)]
        if not rows:
            continue
        print(f"### {title}\n\n| | us per {item} | per second | ratio |\n|---|---|---|---|")
        for name, time in rows:
            print(f"| {name} | {microseconds(time)} | {1 / time:,.0f} | {time / rows[0][1]:.2f} |")
        print()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
