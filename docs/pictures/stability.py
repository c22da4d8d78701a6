"""Draws the lecture's stability map from the table that a sweep leaves: share of diverged runs by mesh and time step.

    gotai sweep configs/lecture/stability.yaml
    python3 docs/pictures/stability.py recordings/lecture/stability/rows.csv docs/pictures/stability.png

Needs matplotlib. This is no part of gotai: it reads `rows.csv` alone.
"""

import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MESH, STEP = "scene.bodies.body", "time.step_s"


def main(rows_csv, picture):
    runs, diverged = defaultdict(int), defaultdict(int)
    with open(rows_csv, newline="") as file:
        for row in csv.DictReader(file):
            cell = row[MESH], float(row[STEP])
            runs[cell] += 1
            diverged[cell] += row["outcome"] == "diverged"
    meshes = list(dict.fromkeys(mesh for mesh, _ in runs))
    steps = sorted({step for _, step in runs})
    share = [[diverged[mesh, step] / runs[mesh, step] for step in steps] for mesh in meshes]

    figure, axes = plt.subplots(figsize=(6.4, 4.6), dpi=100)
    image = axes.imshow(share, cmap="OrRd", vmin=0, vmax=1, aspect="auto")
    axes.set_xticks(range(len(steps)), [f"{1000 * step:g}" for step in steps])
    axes.set_yticks(range(len(meshes)), [f"{mesh.replace('ico', 'sphere')} nodes" for mesh in meshes])
    axes.set_xlabel("time step [ms]")
    axes.set_title("The lecture's method: share of runs that diverge within 4 s", fontsize=11)
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    # A line between cubes and spheres.
    spheres = next(i for i, mesh in enumerate(meshes) if mesh.startswith("ico"))
    axes.axhline(spheres - 0.5, color="white", linewidth=4)
    for y, mesh in enumerate(meshes):
        for x, step in enumerate(steps):
            colour = "white" if share[y][x] > 0.6 else "black"
            axes.text(x, y, f"{100 * share[y][x]:.0f} %", ha="center", va="center", color=colour, fontsize=10)
    bar = figure.colorbar(image, ax=axes, ticks=[0, 0.5, 1])
    bar.ax.set_yticklabels(["0 %", "50 %", "100 %"])
    bar.outline.set_visible(False)
    figure.tight_layout()
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
