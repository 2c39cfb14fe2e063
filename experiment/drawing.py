"""Parts of SVG pictures: they suit light and dark pages, need no other files, and are identical for identical numbers."""

import html
from collections.abc import Iterable
from typing import Final

_STYLE: Final = """
  .page{fill:#fff} text{fill:#23282e;font:12px system-ui,sans-serif} .title{font-weight:600;font-size:14px}
  .small{fill:#6b675d;font-size:11px} .grid{stroke:#e4e1d9} .axis{stroke:#8a867b} .in{fill:#fff}
  .agents{fill:#1f6f8b;stroke:#1f6f8b;stroke-width:1.5} .baseline{fill:#b4572e;stroke:#b4572e;stroke-width:1.5}
  .open{fill:#fff} .curve{fill:none}
  .done{fill:#1f6f8b} .told{fill:#dcae55} .silent{fill:#9c3b34} .dark{fill:#23282e}
  @media (prefers-color-scheme: dark) {
    .page{fill:#16191d} text{fill:#e7e9ec} .small{fill:#9aa3ad} .grid{stroke:#2c323a} .axis{stroke:#7d8791} .in{fill:#fff}
    .agents{fill:#5fb0cc;stroke:#5fb0cc} .baseline{fill:#e08d64;stroke:#e08d64} .open{fill:#16191d} .curve{fill:none}
    .done{fill:#2b7e9c} .silent{fill:#b34a42} .dark{fill:#23282e}
  }
"""


def picture(about: str, width: int, height: int, parts: Iterable[str]) -> str:
    """Return a picture as SVG; *about* is read to those who cannot see it."""
    said = html.escape(about)
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
    page = f'<rect class="page" width="{width}" height="{height}" rx="6"/>'
    return "\n".join(
        [f'{head} role="img" aria-label="{said}">', f"<style>{_STYLE}</style>", page, *parts, "</svg>\n"]
    )


def words(x: float, y: float, content: str, style: str = "", anchor: str = "") -> str:
    """Return a line of text; *anchor* is `middle` or `end`."""
    looks = "".join(
        f' {name}="{value}"' for name, value in (("class", style), ("text-anchor", anchor)) if value
    )
    return f'<text x="{x:.1f}" y="{y:.1f}"{looks}>{html.escape(content)}</text>'


def line(x1: float, y1: float, x2: float, y2: float, style: str) -> str:
    """Return a straight line."""
    return f'<path class="{style}" d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}"/>'


def curve(points: Iterable[tuple[float, float]], style: str) -> str:
    """Return a line through points."""
    path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path class="curve {style}" d="M{path}"/>'


def bar(x: float, y: float, width: float, height: float, style: str, about: str = "") -> str:
    """Return a rectangle; *about* is shown beside the pointer."""
    size = f'x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}"'
    said = f"<title>{html.escape(about)}</title>" if about else ""
    return f'<rect class="{style}" {size}>{said}</rect>'


def dot(x: float, y: float, style: str, about: str) -> str:
    """Return a point; *about* is shown beside the pointer."""
    return f'<circle class="{style}" cx="{x:.1f}" cy="{y:.1f}" r="4"><title>{html.escape(about)}</title></circle>'
