"""``jacaros lsp``."""

import gc
import os
import sys
from importlib.util import find_spec

import click

from jacaros.runtime.cli.usage import examples, usage_error

_GARBAGE_THRESHOLD = 100_000
"""The syntax tree of a program is many objects without cycles: more frequent collection costs 8 % of a check."""


@click.command(
    "lsp",
    epilog=examples("jacaros lsp", "pip install 'jacaros[lsp]'        what it needs"),
)
def command() -> None:
    """Run the language server for editors, on the standard input and output.

    Your editor starts this command. Python code of the project is read, not run.
    """  # fmt: skip
    if find_spec("pygls") is None:
        raise usage_error("the language server needs the Python package pygls", 'pip install "jacaros[lsp]"')
    from jacaros.editors.lsp.features import new_server  # here: it imports much

    gc.set_threshold(_GARBAGE_THRESHOLD, 20, 100)
    # The output belongs to the protocol: whatever else is printed goes to the standard error output.
    sys.stdout.flush()
    with os.fdopen(os.dup(1), "wb") as output:
        os.dup2(2, 1)
        new_server().start_io(sys.stdin.buffer, output)
