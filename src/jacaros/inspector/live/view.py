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

    mas: the running system.
        mas: the running system.
        address: address of this machine; by default one that only this machine can reach.
        port: port; a free one by default.
        token: token in the path, at least 16 letters and digits; random by default.

    Returns:
        The address of the page.

    Raises:
        UsageError: the address cannot be used, or the token is invalid.
        RunEnded: the system is not running.
    """
    from jacaros.inspector.live.run_view import Place, RunView  # here: only runs with a page need a server

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
