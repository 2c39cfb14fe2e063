"""Doors of a run for callers outside: ``jacaros run --serve``."""

import re
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from jacaros.runtime.cli.options import PATH, option, with_options
from jacaros.runtime.cli.outputs import LOOPBACK
from jacaros.runtime.cli.usage import usage_error
from jacaros.runtime.mas.system import System

if TYPE_CHECKING:
    from jacaros.serving.shell.console import Console

_ADDRESS = re.compile(r"(?:(?P<host>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+):)?(?P<port>\d{1,5})")


class ServeAddress(click.ParamType[tuple[str, int]]):
    """``[ADDRESS:]PORT``; becomes host and port."""

    name = "[ADDRESS:]PORT"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, int]:
        found = _ADDRESS.fullmatch(str(value))
        if found is None or int(found["port"]) > 65535:
            self.fail(f"expected [ADDRESS:]PORT with a port of at most 65535, found `{value}`", param, ctx)
        return (found["host"] or LOOPBACK).strip("[]"), int(found["port"])


serve_options = with_options(
    option(
        "--serve [ADDRESS:]PORT",
        "Serve what the agents offer over HTTP (default address: 127.0.0.1; port 0: a free one).",
        ServeAddress(),
    ),
    option(
        "--tokens FILE",
        "Tokens of callers with their roles, YAML (default: one random token of an operator).",
        PATH,
    ),
    option("--tls-cert FILE", "Certificate for HTTPS, PEM with the whole chain.", PATH),
    option("--tls-key FILE", "Private key of the certificate, PEM.", PATH),
    option("--console", "Read goals and questions from the standard input (`jacaros console`).", hidden=True),
)
"""Add the options that say where to serve callers, and whom."""


@dataclass(frozen=True, slots=True)
class RequestedService:
    """The service requested on the command line, by the names of the options."""

    serve: tuple[str, int] | None = None
    tokens: Path | None = None
    tls_cert: Path | None = None
    tls_key: Path | None = None
    console: bool = False

    @classmethod
    def taken_from(cls, options: dict[str, Any]) -> "RequestedService":
        """Take the service out of the options of a command."""
        return cls(**{each.name: options.pop(each.name) for each in fields(cls)})

    def check(self) -> None:
        """Check that the options fit together, and that the extra is installed.

        Raises:
            UsageError: they do not, or it is not.
        """
        if self.serve is None:
            if given := [
                each for each in ("tokens", "tls_cert", "tls_key") if getattr(self, each) is not None
            ]:
                name = given[0].replace("_", "-")
                raise usage_error(f"--{name} needs --serve", "add --serve 8000")
            return
        if (self.tls_cert is None) != (self.tls_key is None):
            raise usage_error("HTTPS needs a certificate and its key", "add --tls-cert FILE --tls-key FILE")
        if not all(map(find_spec, ("starlette", "uvicorn"))):
            raise usage_error("--serve needs starlette and uvicorn", 'pip install "jacaros[serve]"')

    def own_console(self) -> "Console | None":
        """Return the console of this process, if one is wanted."""
        if not self.console:
            return None
        from jacaros.serving.shell.console import Console  # here: few runs have a console

        return Console()

    def begin(self, mas: System, log: Callable[[str, str], object], console: "Console | None" = None) -> None:
        """Serve a run until it ends.

        Raises:
            UsageError: the address, the tokens or the certificate cannot be used.
        """
        if self.serve is None:
            return
        # Imported here: few runs serve callers.
        from jacaros.editors.dap.door import DebugDoor
        from jacaros.editors.dap.relay import PATH as DEBUG
        from jacaros.serving.access import Hosts
        from jacaros.serving.http.door import Address, HttpDoor, MountedApp
        from jacaros.serving.tokens import read_tokens

        host, port = self.serve
        tokens = None if self.tokens is None else read_tokens(self.tokens)
        mounts: dict[str, MountedApp] = {DEBUG: partial(DebugDoor, mas)}
        if find_spec("mcp") is not None:
            from jacaros.serving.mcp.http import PATH, McpOverHttp

            mounts[PATH] = partial(McpOverHttp, mas)
        door = HttpDoor(mas, Address(host, port, self.tls_cert, self.tls_key), tokens, mounts)
        log(f"serve: {door.url}", "info")
        if console is not None:
            console.begin(mas, door.url, door.token, self.tls_cert)
        elif tokens is None:
            log(f"serve: the token of an operator is {door.token}", "info")
        if Hosts(host).exposed and self.tls_cert is None:
            log(
                f"warning: the connection is not encrypted: others who read the traffic to {host} can use its tokens\n"
                "  = help: add --tls-cert FILE --tls-key FILE",
                "warning",
            )
