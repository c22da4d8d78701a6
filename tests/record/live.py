"""Runs a program that shows its run in a viewer while it goes on; a test runs this.

    python tests/record/live.py SECONDS PROGRAM [ARGUMENT]...

PORT in an argument stands for the viewer's port. The viewer is closed after SECONDS if the program has not ended by then.
Prints, as JSON, the program's exit code, what it said on stderr, and what the viewer knew when it was last asked.
"""

import json
import subprocess
import sys
import time

from view import Steered


def main():
    seconds = float(sys.argv[1])
    steered = Steered([], "1280x800")
    known = ""
    try:
        steered.until("connect", lambda _: True, endpoint=f"http://127.0.0.1:{steered.port}")
        arguments = [argument.replace("PORT", str(steered.port)) for argument in sys.argv[2:]]
        program = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + seconds
        while program.poll() is None and time.monotonic() < end:
            time.sleep(0.1)
        steered.call("wait_for", min_steps=15)
        known = steered.call("viewer_state")[1]
    finally:
        steered.close()
    _, said = program.communicate(timeout=120)
    print(json.dumps({"code": program.returncode, "said": said, "known": known}))


main()
