"""gotai, by its example `peer` (`cargo build --release --locked --example peer`), or any other program that keeps to the
same lines: PROGRAM SCENE_FILE REPEATS STEP [key=value ...] prints `RESULT step steps seconds n` and 13 numbers a body."""

import os
import subprocess
import tempfile
from pathlib import Path

NAME = "gotai"
PROGRAM = os.environ.get("GOTAI_PEER", str(Path(__file__).parents[3] / "target/release/examples/peer"))


def version():
    if not Path(PROGRAM).is_file():
        raise ImportError(f"no {PROGRAM}; build it, or name it in GOTAI_PEER")
    return "this"


def methods(scene):
    by_step = {
        "time-stepping": [],
        "time-stepping pgs": ["solver=pgs"],
        "time-stepping newton": ["solver=newton"],
        "time-stepping newton moreau": ["solver=newton", "scheme=moreau"],
    }
    by_tolerance = {f"event-driven {t}": ["method=event-driven", f"tolerance={t}", None] for t in ("1e-6", "1e-9")}
    return {**by_step, **by_tolerance}


def run(scene, settings, step, repeats):
    with tempfile.NamedTemporaryFile("w", suffix=".scene") as file:
        file.write(scene.text())
        file.flush()
        asked = [PROGRAM, file.name, str(repeats), repr(step), *(word for word in settings if word)]
        done = subprocess.run(asked, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    words = done.stdout.split()
    numbers = [float(x) for x in words[5:]]
    states = [numbers[i : i + 13] for i in range(0, len(numbers), 13)]
    return int(words[2]), float(words[3]), states
