"""Bearer tokens of callers, and their roles."""

import hashlib
import secrets
import stat
import sys
from collections.abc import Mapping
from pathlib import Path

from jacaros.agents.language.offers import OPERATOR
from jacaros.runtime.errors import UsageError
from jacaros.runtime.files.yaml import Problem, YamlFileError, YamlNode, read_document, read_text
from jacaros.serving.access import SHORTEST_TOKEN, is_token
from jacaros.serving.callers import Caller

_EXAMPLE = "anna: {token: …, roles: [user]}"


class Tokens:
    """Who may call.

    Args:
        known: name and roles by token.
    """

    def __init__(self, known: Mapping[str, tuple[str, frozenset[str]]]) -> None:
        # Looking up digests takes the same time for every wrong token.
        self._known = {_digest(token): who for token, who in known.items()}

    def caller(self, token: str, door: str) -> Caller | None:
        """Return who has a token; None for an unknown one."""
        found = self._known.get(_digest(token))
        return None if found is None else Caller(found[0], door, found[1])

    def new(self, name: str, role: str = OPERATOR) -> str:
        """Add a random token. Return it."""
        token = secrets.token_urlsafe(24)
        self._known[_digest(token)] = name, frozenset({role})
        return token


def _digest(token: str) -> bytes:
    return hashlib.sha256(token.encode("utf-8", "replace")).digest()


def read_tokens(path: Path) -> Tokens:
    """Return the tokens in a YAML file: a mapping of names to ``token`` and ``roles``.

    Raises:
        YamlFileError: all errors in the file.
        UsageError: it cannot be read, or other users can read it.
    """
    try:
        if sys.platform != "win32" and stat.S_IMODE(path.stat().st_mode) & 0o077:
            raise UsageError(f"error: other users can read the tokens in {path}\n  = help: chmod 600 {path}")
        text, problem = read_text(path)
    except OSError as error:
        help = f"write a file with lines such as `{_EXAMPLE}`"
        raise UsageError(f"error: cannot read {path}: {error.strerror}\n  = help: {help}") from None
    problems: list[Problem] = [] if problem is None else [problem]
    document = read_document(text, problems, "a file of tokens")
    known: dict[str, tuple[str, frozenset[str]]] = {}
    for name, entry in document.entries():
        token, roles = _entry(entry)
        if token in known:
            entry.wrong(
                f"`{name.value}` has the token of `{known[token][0]}`", "give each caller a token of its own"
            )
        known[token] = str(name.value), roles
    if not known and not problems:
        document.wrong("the file has no tokens", f"write lines such as `{_EXAMPLE}`")
    if problems:
        raise YamlFileError(str(path), "", problems)  # without excerpts, which would show tokens
    return Tokens(known)


def _entry(entry: YamlNode) -> tuple[str, frozenset[str]]:
    keys = entry.mapping("token", "roles", required=("token", "roles"))
    if "token" not in keys or "roles" not in keys:
        return "", frozenset()
    token = keys["token"].text()
    if not is_token(token):
        help = f"use at least {SHORTEST_TOKEN} letters, digits or any of `-._~`, such as {secrets.token_urlsafe(24)}"
        keys["token"].wrong("a token is too short, or has other characters", help)
    roles = frozenset(each.text() for each in keys["roles"].sequence())
    if not roles:
        keys["roles"].wrong(
            "no role", "write `roles: [user]`, or observer, operator, or a role of your offers"
        )
    return token, roles
