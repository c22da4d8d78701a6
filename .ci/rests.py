#!/usr/bin/env python3
"""What stands, stands: stacks, walls and an arch with nothing asleep, what 50 sweeps leave of it, and heavy on light.

usage: rests.py GOTAI [SECONDS]

- With the default, for SECONDS (60) at 16 ms and 5 s at 1 ms: nothing moves by more than 1e-8 m, every step is solved.
- `pgs` and `nncg`, at 4 ms for SECONDS: no body of a stack of 20 or a tower moves by more than a tenth of its length,
  and the row says that it is not solved.
- One on another 1 to 10^6 times as light: at most 1e-9 m; above that what f64 leaves, as many times more, or it is said
  to be not solved.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

AT_REST_M, HEAVY_M, FLAGGED = 1e-8, 1e-9, 1e-6


def box(name, size_m, mass_kg, position_m, **more):
    return {"name": name, "shape": {"box": {"size_m": size_m}}, "mass_kg": mass_kg, "position_m": position_m, **more}


def grid(counts, step_m):
    return {"copies": {"grid": counts, "step_m": step_m}}


def stack(count):
    return [box("s", [1, 1, 1], 1, [0, 0.5, 0], **grid([1, count, 1], [1, 1, 1]))]


def tower():
    """34 layers of three, crosswise."""
    return [
        box("even", [0.04, 0.024, 0.12], 0.1, [-0.04, 0.012, 0], **grid([3, 17, 1], [0.04, 0.048, 0.04])),
        box("odd", [0.12, 0.024, 0.04], 0.1, [0, 0.036, -0.04], **grid([1, 17, 3], [0.04, 0.048, 0.04])),
    ]


def wall():
    """10 courses of 10 bricks, half a brick at either end of every other one."""
    return [
        box("a", [0.2, 0.1, 0.1], 1, [0, 0.05, 0], **grid([10, 5, 1], [0.2, 0.2, 0.1])),
        box("b", [0.2, 0.1, 0.1], 1, [0.1, 0.15, 0], **grid([9, 5, 1], [0.2, 0.2, 0.1])),
        box("half", [0.1, 0.1, 0.1], 0.5, [-0.05, 0.15, 0], **grid([2, 5, 1], [1.9, 0.2, 0.1])),
    ]


def pyramid():
    def row(i):
        return box(f"r{i}", [1, 1, 1], 1, [-0.55 * (11 - i), i + 0.5, 0], **grid([12 - i, 1, 1], [1.1, 1, 1]))

    return [row(i) for i in range(12)]


def arch():
    """Half a circle of nine stones."""
    angles = [math.pi * i / 9 for i in range(10)]

    def corner(angle, radius_m, z_m):
        return [radius_m * math.cos(angle), 0 if math.sin(angle) < 1e-9 else radius_m * math.sin(angle), z_m]

    def stone(i):
        corners = [corner(a, r, z) for a in angles[i : i + 2] for r in (1, 1.35) for z in (-0.25, 0.25)]
        return {"name": f"v{i}", "density_kg_m3": 1000, "shape": {"convex": {"vertices_m": corners}}}

    return [stone(i) for i in range(9)]


def heavy(kind, mass_kg):
    cube, can = {"box": {"size_m": [1, 1, 1]}}, {"cylinder": {"radius_m": 0.5, "height_m": 1}}
    shapes = {
        "cubes": [(cube, 1), (cube, mass_kg)],
        "cylinders": [(can, 1), (can, mass_kg)],
        "a ball on a cube": [(cube, 1), ({"sphere": {"radius_m": 0.5}}, mass_kg)],
        "two on one": [(cube, 1), (cube, 1), (cube, mass_kg)],
        "1 : root : all": [(cube, 1), (cube, mass_kg**0.5), (cube, mass_kg)],
    }[kind]
    return [
        {"name": f"b{i}", "shape": shape, "mass_kg": mass, "position_m": [0, i + 0.5, 0]}
        for i, (shape, mass) in enumerate(shapes)
    ]


KINDS = ["cubes", "cylinders", "a ball on a cube", "two on one", "1 : root : all"]


def row(gotai, bodies, step_s, end_s, friction, method="time-stepping", skips=False):
    made = {"gravity_m_s2": [0, -9.81, 0], "friction": friction, "container": {"plane": {"normal": [0, 1, 0]}}}
    given = {"scene": {**made, "bodies": bodies}, "method": method, "time": {"step_s": step_s, "end_s": end_s}}
    given |= {"exact": "rest"} | ({} if skips else {"plan": {"skip": []}})
    with tempfile.TemporaryDirectory() as name:
        config = Path(name) / "case.yaml"
        config.write_text(json.dumps(given))
        command = [gotai, "run", config, "--record", "none", "--json", "--out", Path(name) / "out"]
        ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode:
        raise SystemExit(ran.stderr)
    printed = json.loads(ran.stdout)
    return printed.get("row", printed)


def main():
    gotai, end_s = sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 60.0
    wrong = 0

    def say(what, found, is_right):
        nonlocal wrong
        wrong += not is_right
        told = f"{found['error_position_m']:.1e} m, {found['work_unsolved']} unsolved, residual {found['residual_max']:.1e}"
        print(f"{'' if is_right else 'WRONG: '}{what}: {told}, {found['wall_s']:.1f} s", flush=True)

    # Measured: at most 3e-14 m.
    for step_s, span_s in [(0.016, end_s), (0.001, 5)]:
        for name, bodies in [("stack of 40", stack(40))] + [(of.__name__, of()) for of in (tower, wall, pyramid, arch)]:
            found = row(gotai, bodies, step_s, span_s, 0.7)
            stands = found["error_position_m"] <= AT_REST_M and found["work_unsolved"] == 0
            say(f"{name} at {step_s} s", found, found["outcome"] == "finished" and stands)
    # Measured by pgs: 5.6e-3 m after 12 s, 4.4e-3 m after 38 s.
    for solver in ["pgs", "nncg"]:
        for name, bodies, size_m in [("stack of 20", stack(20), 1), ("tower", tower(), 0.12)]:
            found = row(gotai, bodies, 0.004, end_s, 0.5, {"time-stepping": {"solver": solver}}, skips=True)
            stands = found["error_position_m"] <= size_m / 10 and found["work_unsolved"] > 0
            say(f"{name} by {solver}", found, found["outcome"] == "finished" and stands)
    # Measured: at most 1.5e-11 m up to 10^6, 1.0e-9 m at 10^7, 1.1e-8 m at 10^8 where it is solved.
    for mass_kg in [1, 1e2, 1e4, 1e5, 1e6, 1e7, 1e8]:
        for kind in KINDS:
            for step_s in [0.005, 0.016]:
                found = row(gotai, heavy(kind, mass_kg), step_s, 2, 0.5)
                is_told = found["work_unsolved"] > 0 or found["residual_max"] > FLAGGED
                is_right = found["error_position_m"] <= HEAVY_M * max(1, mass_kg / 1e6) or (mass_kg > 1e6 and is_told)
                say(f"{kind}, 1 : {mass_kg:g}, at {step_s} s", found, is_right)
    print(f"{wrong} wrong")
    sys.exit(wrong > 0)


main()
