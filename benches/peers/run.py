#!/usr/bin/env python3
"""Engines side by side on scenes with known answers: run time against error, a row a scene, engine, method and step.

    python run.py --out peers.csv                       # all engines that are installed, all scenes
    python run.py --engines gotai,mujoco --scenes egg   # some
    gotai bench SCENE.yaml --with peers.csv             # beside a bench of one's own

Every row is a process of its own on one core with a time limit, so that a crash or a hang costs one row. Runs are
interleaved engine by engine within a scene and step: what slows the machine slows all of them.
"""

import argparse
import csv
import importlib
import multiprocessing
import os
import platform
import sys
from datetime import date

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(threads, "1")

from scenes import SCENES  # noqa: E402

ENGINES = ["gotai", "mujoco", "pybullet", "drake"]
STEPS = "1/60,1/240,1/1000,1/4000"
COLUMNS = ["scene", "engine", "method", "step_s", "steps", "error", "error_kind", "wall_s"]


def fraction(text):
    above, _, below = text.partition("/")
    return float(above) / float(below or 1)


def alone(to, module, scene, method, step, repeats):
    """In a process of its own: the result, or what went wrong."""
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    try:
        engine = importlib.import_module(module)
        scene = SCENES[scene]
        steps, seconds, states = engine.run(scene, engine.methods(scene)[method], step, repeats)
        to.send((steps, seconds, scene.errors(states)))
    except Exception as error:
        to.send(f"{type(error).__name__}: {error}")


def timed(arguments, limit_s):
    here, there = multiprocessing.Pipe(False)
    process = multiprocessing.Process(target=alone, args=(there, *arguments))
    process.start()
    there.close()
    try:
        return here.recv() if here.poll(limit_s) else "takes too long"
    except EOFError:
        return "has crashed"
    finally:
        process.kill()
        process.join()


def engines(names):
    for name in names:
        module = f"engines.{name}_engine"
        try:
            engine = importlib.import_module(module)
            print(f"# {name} {engine.version()}", file=sys.stderr)
            yield module, engine
        except ImportError as error:
            print(f"# {name} is left out: {error}", file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engines", default=",".join(ENGINES))
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--steps", default=STEPS, help="seconds, fractions allowed")
    parser.add_argument("--repeats", type=int, default=3, help="the best of at least so many")
    parser.add_argument("--limit", type=float, default=60, help="seconds for a row")
    parser.add_argument("--out", default="peers.csv")
    asked = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    print(f"# {date.today()} {platform.processor() or platform.machine()} {platform.system()}", file=sys.stderr)
    there = list(engines(asked.engines.split(",")))
    with open(asked.out, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(COLUMNS)
        for scene in asked.scenes.split(","):
            for step in map(fraction, asked.steps.split(",")):
                for module, engine in there:
                    for method, settings in engine.methods(SCENES[scene]).items():
                        # What finds its own steps is asked once.
                        own = isinstance(settings, list) and None in settings
                        if own and step != fraction(asked.steps.split(",")[0]):
                            continue
                        ended = timed((module, scene, method, step, asked.repeats), asked.limit)
                        if isinstance(ended, str):
                            print(f"{scene}, {engine.NAME} {method}, {step:g} s: {ended}", file=sys.stderr)
                            continue
                        steps, seconds, errors = ended
                        for kind, error in errors.items():
                            given = "" if own else repr(step)
                            out.writerow([scene, engine.NAME, method, given, steps, repr(error), kind, repr(seconds)])
                file.flush()


if __name__ == "__main__":
    main()
