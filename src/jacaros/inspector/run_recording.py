"""Record a system that runs inside a Python program."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from jacaros.inspector.page import write_replay
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.recording import Recording
from jacaros.inspector.watch_of import watch_of
from jacaros.mas.embedding.mas import Mas


@contextmanager
def record(
    mas: Mas, path: str | Path | None = None, replay: str | Path | None = None
) -> Iterator[Recording | None]:
    """Record a run inside a ``with``: the world and its robots, and the output and goals of agents.

    ::

        async with Mas("patrol.jcm", seed=1) as mas:
            with record(mas, "patrol.jsonl", replay="patrol.html"):
                await mas.ended()

    Args:
        mas: the running system.
        path: file for the recording, as for ``jacaros run --record``; None for no file.
        replay: file for a page that shows it in a browser; None for no page.

    Returns:
        The recording, which grows; None if only a file is written.

    Raises:
        OSError: a file cannot be opened, or the page cannot be written. Later errors of the recording are logged.
        RunEnded: the system is not running.
    """
    keep = replay is not None or path is None
    recorder = Recorder(path, keep, lambda text: mas.system.console.log(f"warning: {text}", "warning"))
    watch = watch_of(mas.system, [recorder])
    watch.start()
    end_prints = mas.on_print(watch.text)
    try:
        yield recorder.recording if keep else None
    finally:
        end_prints()
        watch.stop()
        recorder.close()
    if replay is not None:
        write_replay(recorder.recording, replay)
