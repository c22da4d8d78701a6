#!/usr/bin/env python3
"""Laws of impact on random scenes: nothing gains energy where the law says so, isolated bodies keep their momenta, and
a scaled scene moves as the scene scaled, bit for bit.

usage: laws.py GOTAI COUNT [SEED]

COUNT random plastic scenes with friction, COUNT elastic ones without (e from 0 to 1, one for all) and COUNT/2 without
gravity and container, by every scheme and law of impact in turn: `energy_rise_max_rel` ≤ 1e-9, momenta of isolated
bodies ≤ 1e-12, nothing unsolved but sequences without end. COUNT/5 scenes with friction and restitution are run again
with lengths × 4^±5 and masses × 2^±30: the same rows but for the units.
"""
import json
import math
import random
import subprocess
import sys
import tempfile
from pathlib import Path

LAWS = ["newton", "poisson", "sequential"]
SCHEMES = ["semi-implicit", "moreau"]
STEPS_S = [1 / 1024, 1 / 512, 1 / 256, 1 / 128]
RISE, MOMENTUM = 1e-9, 1e-12


def number(low, high):
    return random.uniform(low, high)


def shape():
    size = number(0.2, 0.8)
    kind = random.choice(["sphere", "box", "cylinder", "capsule", "ellipsoid"])
    if kind == "sphere":
        return {kind: {"radius_m": size / 2}}, size / 2
    if kind == "box":
        sides = [size * number(0.5, 1) for _ in range(3)]
        return {kind: {"size_m": sides}}, math.hypot(*sides) / 2
    if kind == "cylinder":
        return {kind: {"radius_m": size / 2, "height_m": size}}, size * math.sqrt(0.5)
    if kind == "capsule":
        return {kind: {"radius_m": size / 4, "height_m": size / 2}}, size / 2
    axes = [size / 2 * number(0.5, 1) for _ in range(3)]
    return {kind: {"semi_axes_m": axes}}, max(axes)


def scene(friction, restitution, isolated):
    """Bodies that fly into each other, above a floor or far from everything."""
    bodies, reach, count = [], 0.0, random.randint(2, 4)
    for i in range(count):
        form, radius_m = shape()
        reach += radius_m
        place = [number(-0.1, 0.1), 0.02 + reach, number(-0.1, 0.1)]
        reach += radius_m + 0.02
        turn = [random.gauss(0, 1) for _ in range(4)]
        length = math.sqrt(sum(x * x for x in turn))
        bodies.append(
            {
                "name": f"b{i}",
                "shape": form,
                "mass_kg": 10 ** number(-1, 1),
                "position_m": place,
                "orientation": {"quaternion_xyzw": [x / length for x in turn]},
                "velocity_m_s": [number(-1, 1), number(-2, 2) * (-1) ** i, number(-1, 1)],
                "angular_velocity_rad_s": [number(-4, 4) for _ in range(3)],
            }
        )
    made = {"gravity_m_s2": [0, 0, 0] if isolated else [0, -9.8125, 0], "friction": friction, "restitution": restitution}
    if not isolated:
        made["container"] = {"plane": {"normal": [0, 1, 0]}}
    made["bodies"] = bodies
    return made


def experiment(made, law, scheme, step_s):
    method = {"time-stepping": {"solver": "newton", "impact": law, "scheme": scheme}}
    return {
        "scene": made,
        "method": method,
        "time": {"step_s": step_s, "end_s": 256 * step_s},
        "diverge": {"escape": False},
        "limits": {"wall_s": 60},
        "measure": ["state"],
    }


def scaled(given, length, time, mass):
    """The same experiment in other units: lengths, times and masses times powers of two."""
    units = {"_m_s2": length / time**2, "_m_s": length / time, "_rad_s": 1 / time, "_m": length, "_kg": mass, "_s": time}

    def walk(key, value):
        if isinstance(value, dict):
            return {name: walk(name, inner) for name, inner in value.items()}
        if isinstance(value, list):
            return [walk(key, inner) for inner in value]
        if key == "wall_s" or isinstance(value, (str, bool)):
            return value
        return value * next((by for end, by in units.items() if key.endswith(end)), 1)

    return walk("", given)


def row(gotai, given, folder):
    config = folder / "case.yaml"
    config.write_text(json.dumps(given))
    command = [gotai, "run", config, "--record", "none", "--json", "--out", folder / "out"]
    ran = subprocess.run(command, capture_output=True, text=True)
    if ran.returncode:
        raise SystemExit(f"{ran.stderr}\n{json.dumps(given)}")
    printed = json.loads(ran.stdout)
    return printed.get("row", printed)


def is_right(found, isolated, law):
    kept = not isolated or max(found["linear_momentum_drift_rel"], found["angular_momentum_drift_rel"]) <= MOMENTUM
    fine = found["outcome"] == "finished" and (found["work_unsolved"] == 0 or law == "sequential")
    return fine and kept and found["energy_rise_max_rel"] <= RISE


def units_apart(found, other, length, time):
    """Columns of the end state that are not the same but for their units."""
    by = {"position_m": length, "velocity_m_s": length / time, "angular_velocity_rad_s": 1 / time}
    apart = []
    for name, value in found.items():
        parts = name.split(".")
        if len(parts) == 3 and parts[0].startswith("b"):
            if other[name] != value * by.get(parts[1], 1):
                apart.append(name)
    return apart


def main():
    gotai, count = sys.argv[1], int(sys.argv[2])
    random.seed(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    wrong, worst = 0, {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for i in range(count + count + count // 2):
            kind = "plastic" if i < count else "elastic" if i < 2 * count else "isolated"
            isolated = kind == "isolated"
            friction = number(0.05, 1) if kind == "plastic" else 0
            restitution = 0 if kind == "plastic" else random.choice([0.25, 0.5, 0.8, 1])
            law, scheme = LAWS[i % 3], SCHEMES[i // 3 % 2]
            given = experiment(scene(friction, restitution, isolated), law, scheme, random.choice(STEPS_S))
            found = row(gotai, given, folder)
            rise = found["energy_rise_max_rel"]
            worst[kind, scheme] = max(worst.get((kind, scheme), 0), rise)
            if not is_right(found, isolated, law):
                wrong += 1
                momenta = [found[f"{kind}_momentum_drift_rel"] for kind in ("linear", "angular")]
                print(i, kind, law, scheme, f"rise {rise:.2g}, momenta {momenta}", found["outcome"], end=" ")
                print("unsolved", found["work_unsolved"], "gain", found["contact_gain_max"], flush=True)
                if "--show" in sys.argv:
                    print(json.dumps(given))
        for i in range(count // 5):
            law, scheme = LAWS[i % 3], SCHEMES[i // 3 % 2]
            given = experiment(scene(number(0, 1), random.choice([0, 0.5, 1]), False), law, scheme, random.choice(STEPS_S))
            found = row(gotai, given, folder)
            for length, time, mass in [(4.0**5, 2.0**5, 1), (4.0**-5, 2.0**-5, 1), (1, 1, 2.0**30), (1, 1, 2.0**-30)]:
                apart = units_apart(found, row(gotai, scaled(given, length, time, mass), folder), length, time)
                if apart:
                    wrong += 1
                    print(i, law, scheme, f"lengths × {length}, masses × {mass}: {len(apart)} differ", flush=True)
                    if "--show" in sys.argv:
                        print(json.dumps(given))
    print(f"{wrong} wrong; largest rise: " + ", ".join(f"{' '.join(of)} {rise:.1e}" for of, rise in worst.items()))
    # Measured with 500: 1 of 1,350, with 40: 1 of 108, each a solve that is missed by a hair and said to be; the
    # largest rise is 7.2e-12.
    sys.exit(wrong > 0.03 * 2.5 * count)


main()
