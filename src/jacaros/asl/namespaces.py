"""Namespaces as a file sees them."""

from dataclasses import dataclass, field
from typing import Final

KEYWORDS: Final = frozenset(
    {"true", "false", "default", "source", "self", "percept", "atomic", "breakpoint", "all_unifs"}
    | {
        "tell",
        "untell",
        "achieve",
        "unachieve",
        "askOne",
        "askAll",
        "askHow",
        "tellHow",
        "untellHow",
        "signal",
    }
)
"""Names that stay in the default namespace wherever they are written."""


@dataclass
class Namespaces:
    """The namespace in force (None: the default one) and the private names of local namespaces.

    Attributes:
        in_term: what is read is the argument of something; its literals, also those of plans in braces, stay in the
            default namespace.
    """

    current: str | None = None
    local: dict[str, str] = field(default_factory=dict)
    in_term: bool = False

    def resolve(self, written: str) -> str | None:
        """The namespace that *written* means here (``default`` and ``this_ns`` have their meaning)."""
        if written == "default":
            return None
        if written == "this_ns":
            return self.current
        return self.local.get(written, written)

    def of_literal(self, functor: str) -> str | None:
        """The namespace of a belief, goal or condition that is written without one."""
        return None if self.in_term or functor in KEYWORDS else self.current
