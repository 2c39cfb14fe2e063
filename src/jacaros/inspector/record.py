"""Recording a system that runs inside a Python program."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from jacaros.inspector.cause_news import CauseNews
from jacaros.inspector.goal_news import GoalNews
from jacaros.inspector.recorder import Recorder
from jacaros.inspector.recording import Recording
from jacaros.inspector.replay import write_replay
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
    watch = watch_of(mas.system, [recorder], mas.world)
    watch.start()
    news = GoalNews(partial(watch.event, "goal"))
    causes = CauseNews(mas.system.clock, watch.beginning, watch.event)
    ends = mas.on_print(watch.text), news.listen_to_all(mas.system.directory), causes.listen_to(mas.system)
    try:
        yield recorder.recording if keep else None
    finally:
        for end in ends:
            end()
        watch.stop()
        recorder.close()
    if replay is not None:
        write_replay(recorder.recording, replay)
