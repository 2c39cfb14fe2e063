"""Run a project on Jason and print what it cost, as JSON: seconds by the wall clock between the marks of the program.

    on_jason.py PROJECT

The variable JASON names the command of an installation.  The last time counts: the virtual machine is warm by then.
"""

import json
import os
import re
import resource
import subprocess
import sys
import time

MARK = re.compile(r"\] *(begin|end)\b *(.*?)\s*$")


def main(project: str) -> None:
    """Run it, and take the time when the marks arrive."""
    seconds: list[float] = []
    results: list[str] = []
    began = started = time.monotonic()
    start = None
    with subprocess.Popen(
        [os.environ["JASON"], project, "--no-net"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        cwd=os.path.dirname(project) or ".",
    ) as process:
        assert process.stdout is not None
        told = []
        for line in process.stdout:
            now = time.monotonic()
            told.append(line)
            mark = MARK.search(line)
            if mark is None:
                continue
            if mark[1] == "begin":
                start = start or now - started
                began = now
            else:
                seconds.append(now - began)
                results.append(mark[2].removesuffix(".0"))
    if process.returncode or not seconds:
        sys.exit("".join(told[-10:]) or f"exit code {process.returncode}")
    memory = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    figures = {"seconds": seconds[-1], "first": seconds[0], "times": len(seconds), "results": results}
    print(json.dumps({**figures, "megabytes": memory, "start": start}))


if __name__ == "__main__":
    main(sys.argv[1])
