"""Docstrings mark code as reStructuredText does, with a double colon, which Markdown does not know."""

import re
from typing import Any

import griffe


class LiteralBlocks(griffe.Extension):
    """Replaces the double colon before a block of code by a single one, and a double colon alone by nothing."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Adapt the docstring of a module, class, function or attribute."""
        if obj.docstring is not None:
            text = re.sub(r"^ *::$", "", obj.docstring.value, flags=re.MULTILINE)
            obj.docstring.value = re.sub(r"(?<=\S)::$", ":", text, flags=re.MULTILINE)
