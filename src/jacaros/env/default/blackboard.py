"""The blackboard: a space of tuples through which agents that do not know each other work together."""

from jacaros.env.artifact import Artifact, Out, operation
from jacaros.env.values import equal, plain, text

Entry = tuple[object, ...]


class Blackboard(Artifact):
    """A tuple space, as in the coordination language Linda.

    A tuple is a name with any number of arguments.  A pattern fits a tuple of the same length when its
    bound arguments are equal; unbound ones are outputs and fit anything (the same variable twice only
    equal values).  The oldest fitting tuple is taken.
    """

    def init(self) -> None:
        """Begin without tuples."""
        self._tuples: list[Entry] = []

    @operation
    def out(self, *entry: object) -> None:
        """Put a tuple; its arguments must be bound."""
        if any(isinstance(item, Out) for item in entry):
            self.fail("a tuple on the blackboard must not contain unbound variables", "unbound_argument")
        self._tuples.append(tuple(map(plain, entry)))

    @operation(name="in", guard="is_there")
    def take(self, *pattern: object) -> None:
        """Take a fitting tuple away; waits until there is one."""
        taken = self._bind(pattern)
        self._tuples = [entry for entry in self._tuples if entry is not taken]

    @operation(guard="is_there")
    def rd(self, *pattern: object) -> None:
        """Read a fitting tuple; waits until there is one."""
        self._bind(pattern)

    @operation
    def inp(self, *pattern: object) -> None:
        """Take a fitting tuple away; fails with reason ``no_match`` when there is none."""
        self._need(pattern)
        self.take(*pattern)

    @operation
    def rdp(self, *pattern: object) -> None:
        """Read a fitting tuple; fails with reason ``no_match`` when there is none."""
        self._need(pattern)
        self._bind(pattern)

    def is_there(self, *pattern: object) -> bool:
        """True when there is a tuple that fits *pattern*."""
        return self._find(pattern) is not None

    def _need(self, pattern: Entry) -> None:
        if not self.is_there(*pattern):
            shown = ",".join("_" if isinstance(item, Out) else text(item, quoted=True) for item in pattern)
            self.fail(f"no tuple on the blackboard fits ({shown})", "no_match")

    def _find(self, pattern: Entry) -> Entry | None:
        return next((entry for entry in self._tuples if _fits(pattern, entry)), None)

    def _bind(self, pattern: Entry) -> Entry:
        entry = self._find(pattern)
        assert entry is not None, "the guard was true"
        for wanted, value in zip(pattern, entry, strict=True):
            if isinstance(wanted, Out):
                wanted.set(value)
        return entry


def _fits(pattern: Entry, entry: Entry) -> bool:
    if len(pattern) != len(entry):
        return False
    bound: dict[int, object] = {}
    for wanted, value in zip(pattern, entry, strict=True):
        if isinstance(wanted, Out):
            wanted = bound.setdefault(id(wanted.variable or wanted), value)
        if not equal(wanted, value):
            return False
    return True
