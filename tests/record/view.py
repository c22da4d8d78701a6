"""Opens a recording in a headless Rerun Viewer and writes what it shows; a test runs it, and so may anybody.

    pip install rerun-sdk==0.36.3
    python tests/record/view.py FILE.rrd PICTURE.png [SECONDS] [WIDTHxHEIGHT]

The viewer is steered by `rerun viewer-mcp`, which comes with it; RERUN names another program than `rerun`.
"""

import json
import os
import signal
import socket
import subprocess
import sys
import time

RERUN = os.environ.get("RERUN", "rerun")


class Steered:
    """A headless viewer, and the server that steers it."""

    def __init__(self, files, size):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
        options = ["--headless", "--port", str(self.port), "--bind", "127.0.0.1", "--window-size", size]
        self.viewer = subprocess.Popen([RERUN, *options, *files], **quiet)
        self.server = subprocess.Popen(
            [RERUN, "viewer-mcp"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            start_new_session=True,
        )
        self.asked = 0
        about = {"protocolVersion": "2024-11-05", "capabilities": {}, "clientInfo": {"name": "gotai", "version": "0"}}
        self.ask("initialize", about)
        self.send({"jsonrpc": "2.0", "method": "notifications/initialized"})

    def send(self, message):
        self.server.stdin.write(json.dumps(message) + "\n")
        self.server.stdin.flush()

    def ask(self, method, params):
        self.asked += 1
        self.send({"jsonrpc": "2.0", "id": self.asked, "method": method, "params": params})
        for line in self.server.stdout:
            answer = json.loads(line)
            if answer.get("id") == self.asked:
                return answer
        raise SystemExit("the server of the viewer has ended")

    def call(self, name, **arguments):
        answer = self.ask("tools/call", {"name": name, "arguments": arguments})
        result = answer.get("result", {"isError": True, "content": answer.get("error")})
        return not result.get("isError"), json.dumps(result.get("content"))

    def until(self, name, good, seconds=40.0, **arguments):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            is_fine, text = self.call(name, **arguments)
            if is_fine and good(text):
                return
            time.sleep(0.2)
        raise SystemExit(f"the viewer did not come to {name}: {text}")

    def close(self):
        # `rerun` starts the viewer as a child: its whole group is ended.
        for process in (self.viewer, self.server):
            try:
                os.killpg(process.pid, signal.SIGTERM)
            except ProcessLookupError:
                pass
            process.wait()


def main():
    file, picture = sys.argv[1:3]
    seconds = float(sys.argv[3]) if len(sys.argv) > 3 else None
    size = sys.argv[4] if len(sys.argv) > 4 else "1280x800"
    steered = Steered([file], size)
    try:
        steered.until("connect", lambda _: True, endpoint=f"http://127.0.0.1:{steered.port}")
        steered.until("viewer_state", lambda text: "gotai" in text)
        steered.call("wait_for", min_steps=20)
        if seconds is not None:
            steered.call("set_time", time=round(seconds * 1e9))
            steered.call("wait_for", min_steps=15)
        is_fine, text = steered.call("screenshot", save_path=picture, pixels_per_point=1)
        if not is_fine:
            raise SystemExit(text)
    finally:
        steered.close()


if __name__ == "__main__":
    main()
