"""``jacaros view RUN.jsonl``."""

import asyncio
from pathlib import Path

import click

from jacaros.cli.files import read_recording
from jacaros.cli.outputs import check_output, check_view
from jacaros.cli.usage import examples, usage_error
from jacaros.cli.view_options import place_options


@click.command(
    "view",
    short_help="Show a recorded run on a page in the browser.",
    epilog=examples("jacaros view run.jsonl", "jacaros view run.jsonl --output run.html"),
)
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
    """Show RUN, a recording (`jacaros run FILE --record RUN`), on the same page as a live run, until you press Ctrl+C.

    The address of the page is printed to the standard error output.
    """  # fmt: skip
    if output is not None:
        check_output(output, "replay page")
    else:
        check_view(view_address, view_token)
    recording = read_recording(run)
    if output is not None:
        from jacaros.inspector.page import write_replay

        try:
            write_replay(recording, output)
        except OSError as error:
            raise usage_error(f"cannot write `{output}`: {error.strerror}", "name another file") from error
        click.echo(f"wrote {output}")
        return
    from jacaros.cli.pages import log_address, open_page
    from jacaros.inspector.live.access import Access
    from jacaros.inspector.live.live_view import LiveView
    from jacaros.inspector.live.server import LiveServer, bound_socket

    source = LiveView.of_recording(recording)
    access = Access(view_address, view_token)
    server = LiveServer(bound_socket(view_address, view_port), access, source)

    async def serve() -> None:
        await server.start()
        log_address(server.address, view_address, lambda text, _: click.echo(text, err=True))
        click.echo("press Ctrl+C to stop", err=True)
        open_page(server.address)
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            await server.close()

    try:
        asyncio.run(serve())
    except KeyboardInterrupt:
        click.echo(err=True)
