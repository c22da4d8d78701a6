#!/usr/bin/env python3
"""A table in Markdown of what `run.py` wrote: per scene the least run time of every engine to an error of 1e-2, 1e-4 and
1e-6, and how many times longer than the first engine's the best of the others takes.

    python summary.py peers.csv
"""

import csv
import sys
from collections import defaultdict

LEVELS = [1e-2, 1e-4, 1e-6]


def seconds(x):
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if x >= size:
            return f"{x / size:.3g} {unit}"
    return f"{x * 1e9:.3g} ns"


def main():
    rows = defaultdict(list)
    for row in csv.DictReader(open(sys.argv[1])):
        rows[row["scene"], row["error_kind"]].append((row["engine"], row["method"], float(row["error"]), float(row["wall_s"])))
    print("| scene, error | level | gotai | by | fastest other | ratio |\n|---|---|---|---|---|---|")
    for (scene, kind), found in rows.items():
        for level in LEVELS:
            reached = [row for row in found if row[2] <= level]
            own = min((row for row in reached if row[0] == "gotai"), key=lambda row: row[3], default=None)
            other = min((row for row in reached if row[0] != "gotai"), key=lambda row: row[3], default=None)
            shown = [seconds(own[3]), own[1]] if own else ["nobody", ""]
            shown.append(f"{other[0]} {seconds(other[3])}" if other else "nobody")
            shown.append(f"{other[3] / own[3]:.3g} ×" if own and other else "–")
            print(f"| {scene}, {kind} | {level:g} | {' | '.join(shown)} |")


if __name__ == "__main__":
    main()
