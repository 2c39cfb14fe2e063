"""Reasoning cycles a second for small programs: the best of three runs of each, start-up not counted."""

import tempfile
import time
from pathlib import Path

from jacaros.testing import run_project

PROGRAMS = {
    "count by goals": "!c(100000). +!c(0) <- .stopMAS. +!c(N) : N > 0 <- !c(N-1).",
    "count in a loop": "x(0). !s. +!s <- while (x(N) & N < 50000) { -+x(N+1) }; .stopMAS.",
    "beliefs as events": "n(0). !s. +!s <- for (.range(I, 1, 30000)) { +b(I) }; .stopMAS. +b(I) : I > 0 <- true.",
    "failures handled": "!s. +!s <- for (.range(I, 1, 20000)) { !g(I) }; .stopMAS. +!g(I) <- .fail. -!g(_).",
    "1000 intentions": "!s. +!s <- for (.range(I, 1, 1000)) { !!c(30) }; .wait(10); .stopMAS. +!c(0). +!c(N) <- !c(N-1).",
}


def main() -> None:
    """Run them, and print cycles a second; first what the machine can do at this moment."""
    print(f"mind     {'(an empty Python loop)':24} {empty_loop() / 1e6:6.2f} million turns a second")
    for name, program in PROGRAMS.items():
        speeds = [speed(program) for _ in range(3)]
        print(f"mind     {name:24} {max(speeds) / 1e6:6.2f} million cycles a second")


def empty_loop() -> float:
    """Turns a second of a loop that counts."""
    began = time.process_time()
    for _ in range(5_000_000):
        pass
    return 5_000_000 / (time.process_time() - began)


def speed(program: str) -> float:
    """Cycles a second of processor time of one run."""
    minds = []
    began = []

    def started(mas: object) -> None:
        minds.extend(host.mind for host in mas.directory)  # type: ignore[attr-defined]
        began.append(time.process_time())

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "program.asl"
        file.write_text(program, encoding="utf-8")
        result = run_project(file, when_started=started)
    seconds = time.process_time() - began[0]
    if result.exit_code != 0 or result.errors:
        raise SystemExit(f"the program did not end well: {result.errors}")
    return minds[0].cycles / seconds


if __name__ == "__main__":
    main()
