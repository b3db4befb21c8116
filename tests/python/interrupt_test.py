# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C ends a picture with KeyboardInterrupt."""

import signal
import subprocess
import sys
import time

SCRIPT = """
import sys, time
import nearlight
session = nearlight.Session(sys.argv[1])
session.render(width=16, height=16)
print("ready", flush=True)
try:
    # This takes minutes unless it is stopped.
    session.render(width=4096, height=4096, vpl_count=1000)
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
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        # The limit is far below what the picture takes, and far above what a band takes on a busy machine.
        output, errors = process.communicate(timeout=60)
    finally:
        process.kill()
    assert output == "interrupted\nworks\n", errors
