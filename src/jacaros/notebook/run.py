"""A run of a cell: what a notebook shows of it, and what it can be asked."""

import base64
import html
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from jacaros.look.out.series import all_series
from jacaros.look.out.svg_plot import failures, panel_of, plot_svg
from jacaros.look.page.page import replay_html
from jacaros.look.page.picture import picture_svg
from jacaros.look.records.recording import Recording
from jacaros.look.why.past import UNASKED, Happened
from jacaros.look.why.story import story_of, story_text
from jacaros.look.why.why import explain

MAP_WIDTH = 480
"""Pixels."""


class Text(str):
    """Lines that a notebook shows as they are."""

    def __repr__(self) -> str:
        return str(self)


@dataclass(frozen=True)
class Html:
    """HTML that a notebook shows."""

    text: str

    def _repr_html_(self) -> str:
        return self.text


@dataclass(frozen=True)
class Run:
    """A run that has ended. A notebook shows its map, its agents, and how to ask it.

    Attributes:
        file: the recording, which lasts as long as the kernel; all commands for recordings read it.
        tables: its agents at the end, as HTML.
        interrupted: whether the user interrupted it.
    """

    file: Path
    tables: str
    interrupted: bool = False

    @cached_property
    def recording(self) -> Recording:
        """The recording."""
        return Recording.read(self.file)

    @property
    def lines(self) -> list[str]:
        """The output of agents, as ``[agent] text``."""
        return [f"[{agent}] {text}" for _, agent, text in self.recording.texts]

    def why(self, question: str, at: float | None = None, agent: str = "", robot: str = "") -> Text:
        """Answer a question, as ``jacaros why`` does.

        Raises:
            UsageError: the question is not understood; the error lists what can be asked about.
        """
        return Text(explain(self._happened(), question, at, agent, robot).text())

    def story(self) -> Text:
        """Tell the run in at most ten lines."""
        return Text(story_text(story_of(self.recording.events)))

    def plot(self, *names: str) -> Html:
        """Draw numbers over time, as ``jacaros plot`` does: ``run.plot("battery", "odom.x,odom.y")``.

        Raises:
            UsageError: the run has no such numbers; the error lists those that it has.
        """
        known = all_series(self.recording)
        panels = [panel_of(self.recording, known, each.split(",")) for each in names]
        time = (0.0, self.recording.duration)
        return _image(plot_svg(panels, failures(self.recording.events), time, ", ".join(names)), "plot")

    def map(self, width: int = 640) -> Html:
        """Draw the world, and the robots that move in it; the run plays in at most 20 s."""
        return _image(picture_svg(self.recording, width, moving=True), "map")

    def page(self, height: int = 800) -> Html:
        """Show the recording on the same page as ``jacaros view``."""
        page = html.escape(replay_html(self.recording))
        return Html(
            f'<iframe title="recording" sandbox="allow-scripts" width="100%" height="{height}" srcdoc="{page}"></iframe>'
        )

    def _happened(self) -> Iterator[Happened]:
        return Recording().streamed(self.file, UNASKED, is_plain=False)

    def _repr_html_(self) -> str:
        ended = "interrupted" if self.interrupted else "ended"
        drawn = self.map(MAP_WIDTH).text if self.recording.robots else ""
        return (
            f"{drawn}<p>The run {ended} after {self.recording.duration:.1f} s.</p>{self.tables}"
            '<p>Ask it: <code>run = _</code>, then <code>run.story()</code>, <code>run.why("…")</code>, '
            "<code>run.page()</code>.</p>"
        )

    def __repr__(self) -> str:
        return f"<Run of {self.recording.duration:.1f} s, {len(self.recording.texts)} lines>"


def _image(svg: str, name: str) -> Html:
    """Return a picture as an image of its own: its style sheet must not reach the rest of the notebook."""
    data = base64.b64encode(svg.encode()).decode("ascii")
    return Html(f'<img alt="{name}" src="data:image/svg+xml;base64,{data}">')
