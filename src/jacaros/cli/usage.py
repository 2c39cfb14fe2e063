"""Errors of wrong usage, and the examples at the end of help texts."""

import click

from jacaros.errors import UsageError
from jacaros.files.texts import help_line, printable, suggestion


def usage_error(what: str, help: str = "") -> UsageError:
    """Return the error for a wrong command line.

    Args:
        what: what is wrong, with names in backquotes.
        help: what to write instead; empty for no advice.
    """
    lines = [f"error: {printable(what)}"]
    if help:
        lines.append(help_line(help))
    return UsageError("\n".join(lines))


def in_our_form(wrong: click.ClickException) -> UsageError:
    """Return an error of click in the form of all other errors."""
    path = wrong.ctx.command_path if isinstance(wrong, click.UsageError) and wrong.ctx else "jacaros"
    overview = f"`{path} --help` lists the options"
    if isinstance(wrong, click.NoSuchOption):
        known = [opt for each in wrong.ctx.command.params for opt in each.opts] if wrong.ctx else []
        return usage_error(
            f"unknown option: `{wrong.option_name}`", suggestion(wrong.option_name, known, overview, 3)
        )
    if isinstance(wrong, click.MissingParameter) and wrong.param is not None:
        is_option = isinstance(wrong.param, click.Option)
        name = (
            wrong.param.opts[0] if is_option else wrong.param.make_metavar(click.Context(click.Command("")))
        )
        return usage_error(f"missing {'option' if is_option else 'argument'}: `{name}`", overview)
    if isinstance(wrong, click.BadParameter) and wrong.param is not None:
        what = wrong.message[:1].lower() + wrong.message[1:].rstrip(".")
        return usage_error(f"{wrong.param.opts[0]}: {what}", overview)
    text = wrong.format_message()
    return usage_error(text[:1].lower() + text[1:].rstrip("."), overview)


def examples(*commands: str) -> str:
    """Return the end of a help text: commands to copy, one a line."""
    return "\n".join(["\b", "Examples:", *(f"  {command}" for command in commands)])
