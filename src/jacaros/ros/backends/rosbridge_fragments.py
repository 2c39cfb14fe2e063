"""Frames that are too large for the server: cut into the protocol's fragments, and put together again.

Servers take no frame of more than 10 MB (the parameter ``max_message_size``) and close the connection over one; what is
larger themselves, they send in fragments, each a piece of the operation's text.
"""

import itertools
import json
from collections import OrderedDict
from collections.abc import Iterator
from typing import Any

LONGEST = 4_000_000
"""Characters of a piece.  With each of them escaped it is still below the limit."""
OPEN_AT_ONCE = 20
"""Operations that may be incomplete at the same time; the oldest is given up first."""

_numbers = itertools.count(1)


def frames(operation: dict[str, Any]) -> Iterator[bytes]:
    """Write an operation as one frame or, when it is too long, as several."""
    text = json.dumps(operation, separators=(",", ":"))
    if len(text) <= LONGEST:
        yield text.encode()
        return
    number, total = f"fragment:{next(_numbers)}", -(-len(text) // LONGEST)
    for index in range(total):
        piece = text[index * LONGEST : (index + 1) * LONGEST]
        fragment = {"op": "fragment", "id": number, "data": piece, "num": index, "total": total}
        yield json.dumps(fragment, separators=(",", ":")).encode()


class Fragments:
    """Puts the server's fragments together."""

    def __init__(self) -> None:
        self._open: OrderedDict[str, dict[int, str]] = OrderedDict()

    def add(self, fragment: dict[str, Any]) -> dict[str, Any] | None:
        """Take a fragment; give the operation when it was the last one.

        Raises:
            KeyError, TypeError, ValueError: it is none, or the pieces make no operation.
        """
        number, total, index = str(fragment["id"]), int(fragment["total"]), int(fragment["num"])
        if not isinstance(fragment["data"], str) or not 0 <= index < total:
            raise ValueError("a fragment has a text and a number below the total")
        pieces = self._open.setdefault(number, {})
        pieces[index] = fragment["data"]
        if len(pieces) < total:
            while len(self._open) > OPEN_AT_ONCE:
                self._open.popitem(last=False)
            return None
        del self._open[number]
        operation = json.loads("".join(pieces[each] for each in range(total)))
        if not isinstance(operation, dict):
            raise ValueError("fragments of something that is no operation")
        return operation

    def clear(self) -> None:
        """Forget what is incomplete."""
        self._open.clear()
