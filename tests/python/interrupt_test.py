# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C ends a picture with KeyboardInterrupt."""

import signal
import subprocess
import sys

SCRIPT = """
import sys
import nearlight
session = nearlight.Session(sys.argv[1])
session.render(width=16, height=16)
print("ready", flush=True)
try:
    # This takes minutes unless it is stopped.
    session.render(width=4096, height=4096, vpl_count=1000, progress=lambda fraction: print("at work", flush=True))
except KeyboardInterrupt:
    print("interrupted", flush=True)
assert session.render(width=16, height=16).image.width == 16
print("works", flush=True)
"""


def test_a_picture_ends_soon_after_ctrl_c(floor):
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(floor)], stdout=subprocess.PIPE, text=True, stderr=subprocess.PIPE
    )
    try:
        assert process.stdout.readline() == "ready\n"
        assert process.stdout.readline() == "at work\n"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate()
    finally:
        process.kill()
    lines = [line for line in output.splitlines() if line != "at work"]
    assert lines == ["interrupted", "works"], errors
