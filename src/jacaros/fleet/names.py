"""Names of fleets and members, which become parts of key expressions, paths and certificates, and words of members."""

import re

from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line, printable

AUTHORITY, ROUTER = "authority", "router"
"""Names that no member can have: the authority of a fleet, and its routers."""
OPERATOR = "operator"
"""The member that commands such as `jacaros fleet list` are."""
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,47}")
"""At most 48 characters: the path of a Unix socket has at most 103, the name in a certificate 64."""


def check_name(what: str, name: str) -> None:
    """Check the name of a fleet or member.

    Args:
        what: ``fleet`` or ``member``, for the message.
        name: the name.

    Raises:
        UsageError: the name is invalid, or reserved.
    """
    if not _NAME.fullmatch(name):
        help = "use up to 48 letters, digits, `_` and `-`, beginning with a letter or digit"
        raise UsageError(f"error: invalid name of a {what}: `{printable(name)}`\n{help_line(help)}")
    if what == "member" and name in (AUTHORITY, ROUTER):
        raise UsageError(
            f"error: `{name}` cannot be the name of a member: a folder of keys has that name\n"
            f"{help_line(f'call it {name}1')}"
        )


def one_line(text: str) -> str:
    """Return a text with words of another member as one line that a terminal shows as it is."""
    return printable(" ".join(text.split()))
