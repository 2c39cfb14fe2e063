"""Parameters of our node that a launch file or the command line gives: they take the place of declared defaults."""

from collections.abc import Iterator, Mapping

from jacaros.ros.parameter import ParameterValue


class GivenParameters:
    """Values from outside, and which of them somebody has asked for.

    As in other nodes of ROS 2 a value counts when its parameter is declared; one that nobody declares is not there.

    Args:
        values: by the names of the parameters.
    """

    def __init__(self, values: Mapping[str, ParameterValue]) -> None:
        self._values = dict(values)
        self._taken: set[str] = set()

    def value(self, name: str) -> ParameterValue | None:
        """The value for a parameter; None when nobody has given one."""
        return self._values.get(name)

    def take(self, name: str) -> ParameterValue | None:
        """Give the value for a parameter that is being declared; None when nobody has given one."""
        self._taken.add(name)
        return self._values.get(name)

    def items(self) -> Iterator[tuple[str, ParameterValue]]:
        """All of them with their names."""
        yield from self._values.items()

    def untaken(self) -> list[str]:
        """Names of those that nobody has declared so far, sorted."""
        return sorted(set(self._values) - self._taken)

    def known(self) -> list[str]:
        """Names of all parameters that were declared, sorted."""
        return sorted(self._taken)
