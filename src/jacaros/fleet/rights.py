"""What other members may do here."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from jacaros.fleet.names import OPERATOR
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.texts import help_line

SEND, SEE, OPERATE, TELL_HOW, STOP = "send", "see", "operate", "tell_how", "stop"
RIGHTS = (SEND, SEE, OPERATE, TELL_HOW, STOP)
"""Send messages to agents; observe artifacts; use, create and dispose them; change programs of agents; end the system."""
USUAL = frozenset({SEND, SEE, OPERATE})
"""What a member may do that nothing is said of."""
ALL = "*"


class Rights:
    """The rights of the other members.

    Args:
        of: rights by name of the member; ``*`` for all others. Default: `USUAL`; the operator may also stop this member.
    """

    def __init__(self, of: Mapping[str, frozenset[str]] = MappingProxyType({})) -> None:
        self._of = of

    def of(self, member: str) -> frozenset[str]:
        """Return what a member may do."""
        usual = self._of.get(ALL, USUAL)
        return self._of.get(member, usual | {STOP} if member == OPERATOR else usual)


def read_rights(written: Sequence[str]) -> Rights:
    """Return the rights that texts such as ``lab=send,see`` give.

    Raises:
        UsageError: a text is malformed, or names no right.
    """
    found: dict[str, frozenset[str]] = {}
    for text in written:
        member, equals, names = text.partition("=")
        rights = frozenset(names.split(",")) - {""}
        unknown = sorted(rights.difference(RIGHTS))
        if not member or not equals or unknown:
            why = f"unknown right `{unknown[0]}`" if unknown else f"expected MEMBER=RIGHT,..., found `{text}`"
            raise UsageError(f"invalid --fleet-allow: {why}\n{help_line('rights are ' + ', '.join(RIGHTS))}")
        found[member] = rights
    return Rights(found)
