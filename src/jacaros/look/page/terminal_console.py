"""Rich's console with text that cannot command the terminal."""

from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from jacaros.runtime.files.texts import visible


class TerminalConsole(Console):
    """Writes Rich's styles as they are, and escapes control characters in every text that it renders."""

    def render(
        self, renderable: RenderableType, options: ConsoleOptions | None = None, **more: Any
    ) -> Iterable[Segment]:
        """Yield the segments of something that Rich can show."""
        for segment in super().render(renderable, options, **more):
            yield segment if segment.control else Segment(visible(segment.text), segment.style)
