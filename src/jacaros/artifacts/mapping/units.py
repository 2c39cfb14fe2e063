"""Units of values: those of messages (REP 103), and those that agents want."""

from dataclasses import dataclass

_DEGREE = 3.141592653589793 / 180.0


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit: its factor to the usual unit of its kind, and its zero."""

    kind: str
    size: float
    zero: float = 0.0


UNITS: dict[str, Unit] = {
    "radians": Unit("angle", 1.0),
    "degrees": Unit("angle", _DEGREE),
    "metres": Unit("length", 1.0),
    "centimetres": Unit("length", 0.01),
    "millimetres": Unit("length", 0.001),
    "metres_per_second": Unit("speed", 1.0),
    "kilometres_per_hour": Unit("speed", 1.0 / 3.6),
    "seconds": Unit("time", 1.0),
    "milliseconds": Unit("time", 0.001),
    "minutes": Unit("time", 60.0),
    "celsius": Unit("temperature", 1.0),
    "kelvin": Unit("temperature", 1.0, -273.15),
    "share": Unit("share", 1.0),
    "percent": Unit("share", 0.01),
}
"""All units by name; the first of a kind is the usual one in messages."""


@dataclass(frozen=True, slots=True)
class Line:
    """``factor * value + shift``, from the message's number to the agent's."""

    factor: float = 1.0
    shift: float = 0.0

    def there(self, value: float) -> float:
        """Convert to the agent's number."""
        return self.factor * value + self.shift

    def back(self, value: float) -> float:
        """Convert to the message's number."""
        return (value - self.shift) / self.factor

    def then(self, other: "Line") -> "Line":
        """Return this conversion followed by *other*."""
        return Line(self.factor * other.factor, self.shift * other.factor + other.shift)


def usual(unit: str) -> str:
    """Return the usual unit of messages for the kind of *unit*."""
    kind = UNITS[unit].kind
    return next(name for name, each in UNITS.items() if each.kind == kind)


def conversion(of_message: str, of_agent: str) -> Line:
    """Return the conversion from one unit to another of the same kind."""
    here, there = UNITS[of_message], UNITS[of_agent]
    return Line(here.size / there.size, (here.zero - there.zero) / there.size)
