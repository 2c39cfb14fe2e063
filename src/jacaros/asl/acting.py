"""Internal actions that act or wait, so that nothing can be asked of them."""

from typing import Final

NOT_IN_CONDITIONS: Final = frozenset(
    {
        ".send",
        ".broadcast",
        ".wait",
        ".stopMAS",
        ".suspend",
        ".fork",
        ".join",
        ".foreach",
        ".loop",
        ".if_then_else",
    }
)
"""Those of the language that contexts refuse; in a rule they never hold."""
