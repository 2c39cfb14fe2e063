"""The page docs/benchmarks.md: the parts between its marks are generated from the figures, the rest is written by hand."""

import re
from collections.abc import Mapping

_PART = re.compile(r"(<!-- figures: (\w+) -->\n).*?(<!-- end of figures -->)", re.DOTALL)


def filled(page: str, parts: Mapping[str, str]) -> str:
    """The page with the parts put between their marks.

    Raises:
        ValueError: the page has a mark for something that is not among the parts, or none for one of them.
    """
    marked = [match[2] for match in _PART.finditer(page)]
    if sorted(marked) != sorted(parts):
        raise ValueError(
            f"the page has marks for {', '.join(marked)}; there are figures for {', '.join(parts)}"
        )
    return _PART.sub(lambda match: f"{match[1]}\n{parts[match[2]]}\n\n{match[3]}", page)
