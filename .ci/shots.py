#!/usr/bin/env python3
"""Random shots at plates and bodies, up to thousands of widths in a step: nothing passes, and momentum is kept.

usage: shots.py GOTAI COUNT [SEED]

Prints what passed through (column `passed_through`) and where linear momentum was not kept; fails if more than 5 of 1000
shots that hit did: of 300 none may.
"""
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

METHODS = ["{ time-stepping: { solver: newton } }"] * 2 + [
    "{ time-stepping: { solver: pgs } }",
    "{ time-stepping: { solver: newton, scheme: moreau } }",
    "{ time-stepping: { solver: newton, impact: poisson } }",
]


def log_uniform(low, high):
    return math.exp(random.uniform(math.log(low), math.log(high)))


def direction():
    while True:
        v = [random.gauss(0, 1) for _ in range(3)]
        length = math.sqrt(sum(x * x for x in v))
        if length > 1e-3:
            return [x / length for x in v]


def shape(size_m):
    return random.choice(
        [
            f"{{ sphere: {{ radius_m: {size_m} }} }}",
            f"{{ box: {{ size_m: {[size_m * random.uniform(0.5, 2) for _ in range(3)]} }} }}",
            f"{{ box: {{ size_m: [{20 * size_m}, {size_m}, {size_m}] }} }}",
            f"{{ box: {{ size_m: [{10 * size_m}, {size_m * log_uniform(0.01, 0.5)}, {10 * size_m}] }} }}",
            f"{{ capsule: {{ radius_m: {size_m}, height_m: {size_m * random.uniform(0.5, 10)} }} }}",
            f"{{ cylinder: {{ radius_m: {size_m}, height_m: {size_m * random.uniform(0.2, 8)} }} }}",
            f"{{ ellipsoid: {{ semi_axes_m: {[size_m * random.uniform(0.5, 2) for _ in range(3)]} }} }}",
        ]
    )


def scene():
    step_s, speed = random.choice([1e-3, 5e-3, 1e-2, 1.6e-2]), log_uniform(1e-3, 2e3)
    steps, fixed = random.randint(6, 14), random.random() < 0.5
    toward, spin = direction(), random.choice([0, 0, 1, log_uniform(0.1, 500)])
    from_m = speed * step_s * random.uniform(1.5, steps - 2) + 4
    start = [random.uniform(-0.3, 0.3) - x * from_m for x in toward]
    plate = f"{{ box: {{ size_m: [{log_uniform(1e-4, 0.1)}, 2, 2] }} }}"
    target = plate if random.random() < 0.6 else shape(random.uniform(0.1, 0.6))
    target = f"name: target, shape: {target}, mass_kg: {log_uniform(0.1, 10)}, position_m: [0, 0, 0]"
    target += ", fixed: true" if fixed else f", angular_velocity_rad_s: {[x * random.choice([0, 3]) for x in direction()]}"
    shot = f"name: shot, shape: {shape(log_uniform(0.01, 0.1))}, mass_kg: {log_uniform(0.01, 1)}, position_m: {start}"
    shot += f", velocity_m_s: {[speed * x for x in toward]}, angular_velocity_rad_s: {[spin * x for x in direction()]}"
    shot += f", orientation: {{ axis: {direction()}, angle_deg: {random.uniform(0, 180)} }}"
    bodies = [f"- {{ {target} }}", f"- {{ {shot} }}"]
    random.shuffle(bodies)
    bodies = "\n    ".join(bodies)
    return fixed, f"""scene:
  gravity_m_s2: [0, 0, 0]
  friction: {random.choice([0, 0.3, 0.8])}
  restitution: {random.choice([0, 0, 0.5, 1])}
  bodies:
    {bodies}
method: {random.choice(METHODS)}
time: {{ step_s: {step_s}, end_s: {step_s * steps} }}
"""


def main():
    gotai, count = sys.argv[1], int(sys.argv[2])
    random.seed(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    hits, wrong = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "shot.yaml"
        for shot in range(count):
            fixed, text = scene()
            config.write_text(text)
            command = [gotai, "run", config, "--record", "none", "--json", "--out", Path(folder) / "out"]
            ran = subprocess.run(command, capture_output=True, text=True)
            if "expected no overlap" in ran.stderr:
                continue
            row = json.loads(ran.stdout)
            row = row.get("row", row)
            hits += row["work_contact_solves"] > 0
            momentum = 0 if fixed else abs(row["linear_momentum_drift_rel"] or 0)
            if row["passed_through"] > 0 or momentum > 1e-9 or row["outcome"] != "finished":
                wrong += 1
                print(f"shot {shot}: {row['outcome']}, passed {row['passed_through']}, momentum {momentum:.2g}", flush=True)
    print(f"{wrong} wrong of {hits} hits, of {count} shots")
    sys.exit(wrong > 0.005 * hits)


main()
