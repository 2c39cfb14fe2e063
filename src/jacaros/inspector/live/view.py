"""Live pages of a system that runs inside a Python program."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from jacaros.inspector.watch_of import watch_of
from jacaros.mas.embedding.mas import Mas


@asynccontextmanager
async def view(
    mas: Mas, *, address: str = "127.0.0.1", port: int = 0, token: str | None = None
) -> AsyncIterator[str]:
    """Serve live pages of a running system inside an ``async with``.

    ::

        async with Mas("patrol.jcm") as mas, view(mas) as page:
            print(page)
            await mas.ended()

    Args:
        mas: the running system.
        address: of this machine; the default can be reached from this machine alone.
        port: a free one by default.
        token: of the path, at least 16 letters and digits; random by default.

    Returns:
        The address of the page.

    Raises:
        UsageError: the address cannot be served, or the token is invalid.
        RunEnded: the system does not run.
    """
    from jacaros.inspector.live.run_view import Place, RunView  # here: the server is for those who want one

    shown = RunView(mas.system, Place(address, port, token))
    watch = watch_of(mas.system, [shown.watcher], live=True)
    watch.start()
    end_prints = mas.on_print(watch.text)
    shown.begin(watch)
    try:
        yield shown.address
    finally:
        end_prints()
        watch.stop()
        await shown.close()
