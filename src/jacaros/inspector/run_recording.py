"""Recording a system that runs inside a Python program."""

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
    """Record what happens inside a ``with``: the world and its robots, what agents print and pursue.

    ::

        async with Mas("patrol.jcm", seed=1) as mas:
            with record(mas, "patrol.jsonl", replay="patrol.html"):
                await mas.ended()

    Args:
        mas: the running system.
        path: file for the recording, as ``jacaros run --record`` writes it; None for none.
        replay: file for a page that shows it in a browser; None for none.

    Returns:
        The recording, which grows; None when only a file is written.

    Raises:
        OSError: a file cannot be opened, or the page not written.  Later trouble with the recording is logged.
        RunEnded: the system does not run.
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
