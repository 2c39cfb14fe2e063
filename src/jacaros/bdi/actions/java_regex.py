"""Regular expressions of Java: what programs use of them, in terms of Python's.

The two languages agree on most of the syntax.  Translated are named groups, quoting with ``\\Q…\\E``, the
classes ``\\p{Alpha}`` and so on, ``\\z`` and ``\\Z``, and the replacement text with ``$1`` and ``${name}``.
The classes ``\\d \\w \\s`` are ASCII, as in Java.  Classes inside classes and ``&&`` are refused.
"""

import re
import warnings
from functools import lru_cache

_CLASSES = {
    "Lower": "a-z",
    "Upper": "A-Z",
    "Alpha": "a-zA-Z",
    "Digit": "0-9",
    "Alnum": "a-zA-Z0-9",
    "Punct": r"!-/:-@\[-`{-~",
    "Space": r"\s",
    "Blank": r" \t",
    "XDigit": "0-9a-fA-F",
    "ASCII": r"\x00-\x7F",
}
_DIFFERENT = re.compile(
    r"\\Q(?P<quoted>.*?)(?:\\E|$)|\\(?P<sign>[pP])\{(?P<class>\w+)\}|(?P<end>\\[zZ])|(?P<escape>\\.)"
    r"|(?P<open>\[\^?\]?)|(?P<close>\])|(?P<group>\(\?<(?![=!]))",
    re.DOTALL,
)
_REFERENCE = re.compile(r"\\(.)|\$\{(\w+)\}|\$(\d+)|(\$|\\$)", re.DOTALL)


def replace_all(text: str, pattern: str, by: str) -> str:
    """*text* with every match of *pattern* replaced.

    Raises:
        ValueError: for a pattern or replacement that is wrong or beyond what is translated.
    """
    compiled = _compile(pattern)
    return compiled.sub(lambda match: _expand(by, match), text)


def matches_whole(pattern: str, text: str) -> bool:
    """Whether *pattern* matches all of *text*.

    Raises:
        ValueError: for a pattern that is wrong or beyond what is translated.
    """
    return _compile(pattern).fullmatch(text) is not None


@lru_cache(maxsize=64)
def _compile(pattern: str) -> re.Pattern[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("error", FutureWarning)
        try:
            return re.compile(_translate(pattern), re.ASCII)
        except (re.error, FutureWarning) as error:
            raise ValueError(
                f"'{pattern}' is no regular expression that is understood here: {error}"
            ) from None


def _translate(pattern: str) -> str:
    inside = False
    result: list[str] = []
    position = 0
    for match in _DIFFERENT.finditer(pattern):
        result.append(pattern[position : match.start()])
        position = match.end()
        kind = match.lastgroup
        found = match.group()
        if kind == "open":
            if inside:
                raise ValueError(f"'{pattern}' has a class inside a class, which is not understood here")
            inside = True
            result.append(found)
        elif kind == "close":
            inside = False
            result.append(found)
        elif kind == "quoted":
            result.append(re.escape(match["quoted"]))
        elif kind == "class":
            result.append(_posix_class(match["class"], match["sign"] == "P", inside, pattern))
        elif kind == "end":
            result.append(r"\Z" if found == r"\z" else r"(?=\n?\Z)")
        else:
            result.append("(?P<" if kind == "group" and not inside else found)
    result.append(pattern[position:])
    return "".join(result)


def _posix_class(name: str, negated: bool, inside: bool, pattern: str) -> str:
    characters = _CLASSES.get(name)
    if characters is None or (negated and inside):
        raise ValueError(f"'{pattern}' uses the class {name}, which is not understood here")
    return characters if inside else f"[{'^' if negated else ''}{characters}]"


def _expand(replacement: str, match: re.Match[str]) -> str:
    """The replacement for one match, with its references filled in."""
    result: list[str] = []
    position = 0
    for reference in _REFERENCE.finditer(replacement):
        result.append(replacement[position : reference.start()])
        position = reference.end()
        escaped, name, digits, stray = reference.groups()
        if stray is not None:
            raise ValueError(f"'{replacement}' has a lone {stray}")
        if escaped is not None:
            result.append(escaped)
        elif name is not None:
            result.append(_group(match, name, replacement))
        else:
            used = _known_group(digits, match)
            result.append(_group(match, int(used), replacement) + digits[len(used) :])
    result.append(replacement[position:])
    return "".join(result)


def _known_group(digits: str, match: re.Match[str]) -> str:
    """As many of the digits as name a group, at least one."""
    used = digits[0]
    for digit in digits[1:]:
        if int(used + digit) > match.re.groups:
            break
        used += digit
    return used


def _group(match: re.Match[str], which: int | str, replacement: str) -> str:
    try:
        return match.group(which) or ""
    except IndexError:
        raise ValueError(
            f"'{replacement}' names the group {which}, which the pattern does not have"
        ) from None
