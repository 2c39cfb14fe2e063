r"""Read the docstrings of actions: usage, parameters, units, and their text as Markdown.

>>> parameters_in("``.send(To, Performative [, Answer])`` sends a message.", 3)
('To', 'Performative', 'Answer')
>>> unit_in("Drive *length* metres straight ahead; wait *pause* seconds.", "pause")
'seconds'
"""

import inspect
import re
from typing import Final

from jacaros.robots.mapping.fields import SYMBOLS

_USAGE: Final = re.compile(r"``([.\w]+\(.*?\)|[.\w]+)``")
_SPACE: Final = r"[\s,]+(?:in\s+)?"
_SHORT: Final = {each.words: symbol for symbol, each in SYMBOLS.items() if symbol} | {"degrees": "°"}
_UNITS: Final = "|".join(sorted(map(re.escape, _SHORT), key=len, reverse=True))


def markdown(doc: str | None) -> str:
    """Return a docstring as Markdown: one backquote for code, and tables and sections as they are written."""
    text = inspect.cleandoc(doc or "").replace("``", "`")
    return re.sub(r"(?m)^(={3,}[ =]*|Raises:|Returns:|Args:)$", r"\n\1", text)


def usages_in(doc: str | None) -> list[str]:
    """Return the calls at the beginnings of paragraphs, such as ``.send(To, Performative, Content)``."""
    paragraphs = re.split(r"\n\s*\n", inspect.cleandoc(doc or ""))
    return [found[1] for each in paragraphs if (found := _USAGE.match(each)) is not None]


def parameters_in(doc: str | None, arity: int) -> tuple[str, ...]:
    """Return the names of that number of parameters, from a usage; empty if none fits."""
    for usage in usages_in(doc):
        inside = re.sub(r"[\[\]]", "", usage.partition("(")[2].rpartition(")")[0])
        names = [re.sub(r"\W", "", each) for each in inside.split(",") if each.strip(" .")]
        if len(names) >= arity and all(names):
            return tuple(names[:arity])
    return ()


def unit_in(doc: str | None, name: str) -> str:
    """Return the unit that a docstring gives a parameter, in words; empty if it gives none."""
    if name in _SHORT:
        return name  # a parameter such as `degrees`
    found = re.search(rf"\*{re.escape(name)}\*{_SPACE}(?P<unit>{_UNITS})\b", doc or "")
    return found["unit"] if found is not None else ""


def short_unit(words: str) -> str:
    """Return the symbol of a unit, such as ``m`` for metres; the words themselves if it has none."""
    return _SHORT.get(words, words)
