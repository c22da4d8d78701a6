#!/usr/bin/env python3
"""Bodies go over the seams of flush blocks as over one block: the same motion, by every solver.

usage: seams.py GOTAI COUNT [SEED]

COUNT cases are drawn from shape × layout × yaw × speed × step × friction × method × order of bodies; each is run on one
block and on several. Exact solvers have to agree to 1e-10 m, iterations to 1e-3 of the way. Fails if more than 1 of 200
does not (measured: none of 400).
"""
import itertools
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

METHODS = {
    "newton": "{ time-stepping: { solver: newton } }",
    "moreau": "{ time-stepping: { solver: newton, scheme: moreau } }",
    "pgs": "{ time-stepping: { solver: pgs } }",
    "nncg": "{ time-stepping: { solver: nncg } }",
}
HEXAGON = [(0.2 * math.cos(k * math.pi / 3), 0.2 * math.sin(k * math.pi / 3)) for k in range(6)]
PRISM = [[round(x, 12), y, round(z, 12)] for y in (-0.1, 0.1) for x, z in HEXAGON]
# Shape, radius of what rolls, half of its extent.
SHAPES = {
    "crate": ("{ box: { size_m: [0.3, 0.2, 0.3] } }", None, 0.15),
    "can": ("{ cylinder: { radius_m: 0.15, height_m: 0.2 } }", None, 0.15),
    "hull": (f"{{ convex: {{ vertices_m: {PRISM} }} }}", None, 0.2),
    "roller": ("{ cylinder: { radius_m: 0.1, height_m: 0.3 } }", 0.1, 0.1),
    "capsule": ("{ capsule: { radius_m: 0.1, height_m: 0.2 } }", 0.1, 0.1),
    "ball": ("{ sphere: { radius_m: 0.1 } }", 0.1, 0.1),
}
FIXED = "mass_kg: 1, fixed: true"
LAYOUTS = {
    "one": f"- {{ name: floor, shape: {{ box: {{ size_m: [80, 1, 80] }} }}, {FIXED}, position_m: [0, -0.5, 0] }}",
    "two": f"- {{ name: floor, shape: {{ box: {{ size_m: [40, 1, 80] }} }}, {FIXED}, position_m: [-20, -0.5, 0], "
    "copies: { count: 2, step_m: [40, 0, 0] } }",
    "four": f"- {{ name: floor, shape: {{ box: {{ size_m: [40, 1, 40] }} }}, {FIXED}, position_m: [-20, -0.5, -20], "
    "copies: { grid: [2, 1, 2], step_m: [40, 0, 40] } }",
    "tiles": f"- {{ name: floor, shape: {{ box: {{ size_m: [0.4, 0.4, 0.4] }} }}, {FIXED}, "
    "position_m: [-1.8, -0.2, -1.8], copies: { grid: [10, 1, 10], step_m: [0.4, 0, 0.4] } }",
}
EXACT_M = 1e-10
OF_THE_WAY = 1e-3


def scene(layout, case):
    shape, _, yaw_deg, speed, step_s, friction, method, body_first = case
    geometry, radius_m, half_m = SHAPES[shape]
    steps = max(2, round(min(max(0.6 / speed, 4 * step_s), 1.5) / step_s))
    c, s = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))
    start_m = -0.5 * speed * steps * step_s
    if speed < 0.05:
        start_m = -0.003 if radius_m else 0.0005 - half_m
    body = f"name: body, shape: {geometry}, mass_kg: 2"
    body += f", position_m: [{start_m * c + 0.013 * s}, 0.1, {0.013 * c - start_m * s}]"
    if shape in ("roller", "capsule"):
        body += f", orientation: {{ axis: [{c}, 0, {-s}], angle_deg: 90 }}"
    elif not radius_m and yaw_deg:
        body += f", orientation: {{ axis: [0, 1, 0], angle_deg: {1.7 * yaw_deg + 5} }}"
    body += f", velocity_m_s: [{speed * c}, 0, {-speed * s}]"
    if radius_m:
        body += f", angular_velocity_rad_s: [{-speed * s / radius_m}, 0, {-speed * c / radius_m}]"
    bodies = [LAYOUTS[layout], f"- {{ {body} }}"]
    bodies = "\n    ".join(reversed(bodies) if body_first else bodies)
    return f"""scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  bodies:
    {bodies}
method: {METHODS[method]}
time: {{ step_s: {step_s}, end_s: {steps * step_s} }}
measure: [state]
"""


def row(gotai, text, folder):
    config = folder / "case.yaml"
    config.write_text(text)
    command = [gotai, "run", config, "--record", "none", "--json", "--out", folder / "out"]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    printed = json.loads(ran.stdout)
    return printed.get("row", printed)


def main():
    gotai, count = sys.argv[1], int(sys.argv[2])
    random.seed(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    yaws_deg, speeds, steps_s = [0, 7, 30, 45, 90], [0.01, 0.3, 2, 20], [1e-4, 1e-3, 5e-3, 1.6e-2]
    layouts = [layout for layout in LAYOUTS if layout != "one"]
    cases = list(itertools.product(SHAPES, layouts, yaws_deg, speeds, steps_s, [0, 0.3], METHODS, [False, True]))
    random.shuffle(cases)
    wrong, worst = 0, {}
    with tempfile.TemporaryDirectory() as folder:
        for case in cases[:count]:
            one, several = (row(gotai, scene(layout, case), Path(folder)) for layout in ("one", case[1]))
            apart_m = max(abs(one[f"body.position_m.{k}"] - several[f"body.position_m.{k}"]) for k in "xyz")
            way_m = case[3] * several["end_time_s"]
            is_exact = case[6] in ("newton", "moreau")
            worst[case[6]] = max(worst.get(case[6], 0), apart_m if is_exact else apart_m / way_m)
            if apart_m > (EXACT_M if is_exact else OF_THE_WAY * way_m) or several["ghost_impulse_max_rel"] > 0:
                wrong += 1
                print(case, f"apart {apart_m:.3g} m, ghost {several['ghost_impulse_max_rel']:.3g}", flush=True)
    print(f"{wrong} of {len(cases[:count])} wrong; worst (m, or part of the way): {worst}")
    sys.exit(wrong > 0.005 * count)


main()
