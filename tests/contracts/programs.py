"""Programs of tests that need a process of their own."""

import os
import subprocess
import sys


def run_program(code: str, environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    """Run Python code to its end, and return what it printed."""
    return subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
