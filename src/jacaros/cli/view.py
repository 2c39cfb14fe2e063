"""``jacaros view RUN.jsonl``."""

import asyncio
from pathlib import Path

import click

from jacaros.cli.files import read_recording
from jacaros.cli.outputs import check_output, check_view
from jacaros.cli.view_options import place_options


@click.command("view", short_help="Show a recorded run on a page in the browser.")
@click.argument("run", type=click.Path(path_type=Path))
@click.option(
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE.html",
    help="Write the page to a file that needs no server, and exit.",
)
@place_options
def command(
    run: Path, output: Path | None, view_port: int, view_address: str, view_token: str | None
) -> None:
    """Show RUN, a recording (`jacaros run FILE --record RUN`), on the page of live runs, until Ctrl+C.

    The address of the page is printed to the standard error output.
    """  # fmt: skip
    if output is not None:
        check_output(output, "replay page")
    else:
        check_view(view_address, view_token)
    recording = read_recording(run)
    if output is not None:
        from jacaros.inspector.page import write_replay

        write_replay(recording, output)
        click.echo(f"wrote {output}")
        return
    from jacaros.cli.pages import open_page, tell_address
    from jacaros.inspector.live.access import Access
    from jacaros.inspector.live.recorded_view import RecordedView
    from jacaros.inspector.live.server import LiveServer, bound_socket

    source = RecordedView(recording)
    access = Access(view_address, view_token)
    server = LiveServer(bound_socket(view_address, view_port), access, source)

    async def serve() -> None:
        await server.start()
        tell_address(server.address, view_address, lambda text, _: click.echo(text, err=True))
        click.echo("press Ctrl+C to end", err=True)
        open_page(server.address)
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            await server.close()

    try:
        asyncio.run(serve())
    except KeyboardInterrupt:
        click.echo(err=True)
