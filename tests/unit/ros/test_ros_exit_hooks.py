"""Exit hooks of a whole process, for every way in which a program stops."""

import signal
import subprocess
import sys

import pytest

PROGRAM = """
import asyncio, os, signal, sys, threading
from jacaros.clock import WallClock, run
from jacaros.ros.exit_hooks import ExitHooks

def say(text):
    os.write(1, (text + "\\n").encode())  # threads must not write into each other's lines

threaded = {threaded}
hooks = ExitHooks(say, lambda: say("sent"), threaded)
hooks.add(lambda: say(f"zero {{hooks.admits()}}"))

async def main():
    if threaded:
        hooks.watch_thread()
    {body}

try:
    run(main, WallClock())
finally:
    say("finally")
"""


OWN_HANDLER = """ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, lambda: (hooks.run(), ended.set()))
    os.kill(os.getpid(), signal.SIGTERM)
    await ended.wait()"""


def run_program(body: str, threaded: bool) -> tuple[int, list[str]]:
    code = PROGRAM.format(threaded=threaded, body=body)
    done = subprocess.run(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        timeout=60,
        check=False,
    )
    return done.returncode, done.stdout.decode().splitlines()


@pytest.mark.parametrize("threaded", [False, True])
@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("pass", 0),
        ("raise ValueError", 1),
        ("sys.exit(5)", 5),
        ("os.kill(os.getpid(), signal.SIGTERM); await asyncio.Event().wait()", 143),
        ("os.kill(os.getpid(), signal.SIGHUP); await asyncio.Event().wait()", 129),
        ("os.kill(os.getpid(), signal.SIGINT); await asyncio.Event().wait()", -2),
        ("os.kill(os.getpid(), signal.SIGTERM)\n    while True: pass", 143),
        ("hooks.run(); hooks.stop_watching(); os.kill(os.getpid(), signal.SIGTERM)", -15),
        (OWN_HANDLER, 0),
    ],
)
def test_the_hooks_run_once_however_the_program_stops(body: str, code: int, threaded: bool) -> None:
    exit_code, lines = run_program(body, threaded)
    assert exit_code == code
    assert lines.count("zero True") == 1
    assert lines.count("sent") == 1
    assert lines.index("zero True") < lines.index("sent")


def test_a_thread_that_never_ends_keeps_no_hook_back() -> None:
    body = "threading.Thread(target=threading.Event().wait).start(); say('begin'); raise ValueError"
    code = PROGRAM.format(threaded=True, body=body)
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    assert process.stdout is not None
    lines = [process.stdout.readline().decode().strip() for _ in range(4)]
    assert lines == ["begin", "finally", "zero True", "sent"]
    process.kill()
    process.wait()
    process.stdout.close()


def test_an_ignored_signal_stays_ignored() -> None:
    body = "pass"
    code = "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\n" + PROGRAM.format(
        threaded=False,
        body=body.replace("pass", "say(str(signal.getsignal(signal.SIGHUP) is signal.SIG_IGN))"),
    )
    done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, timeout=60, check=False)
    assert done.stdout.decode().splitlines()[0] == "True"


def test_handlers_are_given_back(monkeypatch: pytest.MonkeyPatch) -> None:
    from jacaros.ros import exit_hooks
    from jacaros.ros.exit_hooks import ExitHooks

    monkeypatch.setattr(exit_hooks, "_process", exit_hooks._Process())  # whatever other tests have left open
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]

    hooks = ExitHooks(print, lambda: None, threaded=False)
    remove = hooks.add(lambda: None)
    assert signal.getsignal(signal.SIGTERM) != before[1]
    remove()
    hooks.run()
    assert [signal.getsignal(n) for n in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)] == before
