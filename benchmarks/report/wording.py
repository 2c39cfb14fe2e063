"""Figures as text."""


def figure(value: float) -> str:
    """Return a number with two or three significant digits."""
    if value >= 100:
        digits = len(str(round(value))) - 3
        return f"{round(value, -max(0, digits)):,.0f}"
    return f"{value:.1f}" if value < 9.95 else f"{value:.0f}"


def milliseconds(seconds: float) -> str:
    """A duration."""
    return f"{seconds * 1000:.2f} ms" if seconds < 0.01 else f"{seconds * 1000:.0f} ms"
