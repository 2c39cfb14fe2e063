"""Convert the objects of a mind to a flat table of data for JSON, and back.

An entry is a kind of object (`jacaros.bdi.object_kinds`), plain data, and the parts: values, or the numbers of other
entries. So shared objects are shared again, and nothing is nested too deeply. An immutable object comes after its parts;
a mutable one is made empty, and filled when all others exist.
"""

from collections.abc import Iterable

from jacaros.bdi.mind import Mind
from jacaros.bdi.object_kinds import KINDS, Data, ProgramParts, Value, fill_dict, kind_of
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.rule import Rule
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.order import number_of
from jacaros.terms.substitution import ATOMIC
from jacaros.terms.values import Reference, String, Var
from jacaros.trace import Cause

Entry = tuple[str, Data, Data]
"""Kind, plain data, and parts; a list when it comes from JSON."""
_INLINE = frozenset({bool, float, int, str, String})
_SHARED = ATOMIC | {Cause, Plan, Reference, Rule, Trigger}
_INFINITY = float("inf")


class Writer:
    """Write objects into a table.

    Args:
        shared: the table is for another mind of the same program in this process. Plans, rules, Python objects in terms,
            and beliefs without variables and collections are not copied.

    Attributes:
        table: the entries.
    """

    def __init__(self, mind: Mind, shared: bool = False) -> None:
        self.table: list[Entry] = []
        self._program = ProgramParts(mind)
        self._shared = shared
        self._numbers: dict[int, int] = {}
        self._written: list[Value] = []  # keeps the objects alive, so that no other object gets the same id
        self._open: list[tuple[int, Data]] = []

    def write(self, value: Value) -> Value:
        """Write a value with everything it refers to; return its reference in the table."""
        self._enter(value)
        while self._open:
            number, parts = self._open.pop()
            for part in parts:
                self._enter(part)
            self.table[number][2].extend(map(self._inline, parts))
        return self._inline(value)

    def _enter(self, value: Value) -> None:
        """Number a value, after the values that it cannot be made without."""
        todo = [value]
        forms: dict[int, Entry] = {}
        while todo:
            each = todo[-1]
            if self._is_known(each):
                todo.pop()
                continue
            form = forms.get(id(each)) or forms.setdefault(id(each), self._form(each))
            missing = [] if KINDS[form[0]].fill else [part for part in form[2] if not self._is_known(part)]
            if missing:
                todo += missing
            else:
                todo.pop()
                self._put(each, form)

    def _form(self, value: Value) -> Entry:
        kind = kind_of(self._program, value)
        data, parts = KINDS[kind].write(self._program, value)
        return kind, data, list(parts)

    def _put(self, value: Value, form: Entry) -> None:
        kind, data, parts = form
        number = self._numbers[id(value)] = len(self.table)
        self._written.append((value, parts))
        if KINDS[kind].fill:
            self._open.append((number, parts))
            parts = []
        self.table.append((kind, data, [*map(self._inline, parts)]))

    def _is_known(self, value: Value) -> bool:
        return self._is_inline(value) or id(value) in self._numbers

    def _is_inline(self, value: Value) -> bool:
        if value is None or value.__class__ in _INLINE or value.__class__ is Cause:
            return True
        return self._shared and (
            _is_shared(value) or (value.__class__ is tuple and all(map(_is_shared, value)))
        )

    def _inline(self, value: Value) -> Value:
        kind = value.__class__
        if kind is int:
            return {"i": value}
        if kind is str:
            return {"s": value}
        if kind is float and not abs(value) < _INFINITY:
            return {"f": repr(value)}
        if self._is_inline(value):
            return None if kind is Cause and not self._shared else value
        return {"r": self._numbers[id(value)]}


def _is_shared(value: Value, depth: int = 4) -> bool:
    """Return whether two minds may share this object; rows with annotations are at most as deep as
    *depth*.
    """
    if value.__class__ is tuple:
        return depth > 0 and all(each.__class__ in ATOMIC or _is_shared(each, depth - 1) for each in value)
    return value.__class__ in _SHARED or callable(value)


class Reader:
    """Make the objects of a table for a mind.

    Raises:
        ValueError: the program of the mind lacks a plan or belief that is used, or the table contains something that is
            not part of a mind.
    """

    def __init__(self, mind: Mind, table: Iterable[Entry]) -> None:
        program = ProgramParts(mind)
        self._made: list[Value] = []
        open_ones: list[tuple[str, Value, Data]] = []
        for kind, data, parts in table:
            fixed = KINDS[kind].fill is None
            made = KINDS[kind].make(program, data, self._all(parts) if fixed else [])
            self._made.append(made)
            if not fixed:
                open_ones.append((kind, made, parts))
        open_ones.sort(
            key=lambda each: each[0] == "dict"
        )  # sets that are keys must be filled before their dictionaries
        for kind, made, parts in open_ones:
            fill = KINDS[kind].fill
            assert fill is not None
            fill(made, self._all(parts))
        self._fill_nested_sets([(made, parts) for kind, made, parts in open_ones if kind == "dict"])
        self._number_variables([made for kind, made, _ in open_ones if kind == "Var"])

    def _fill_nested_sets(self, filled: list[tuple[Value, Data]]) -> None:
        """Fill dictionaries again in which two keys were equal because the sets in them were still empty."""
        short = [(made, parts) for made, parts in filled if 2 * len(made) < len(parts)]
        for made, parts in short:
            made.clear()
            fill_dict(made, self._all(parts))
        if short:
            self._fill_nested_sets(short)

    @staticmethod
    def _number_variables(variables: list[Var]) -> None:
        """Keep the order of variables that have been compared; their numbers come from another process."""
        compared = [variable for variable in variables if hasattr(variable, "number")]
        for variable in sorted(compared, key=lambda each: each.number):
            del variable.number
            number_of(variable)

    def read(self, value: Value) -> Value:
        """Return the value that an entry represents."""
        if value.__class__ is not dict:
            return String(value) if value.__class__ is str else value
        ((how, inner),) = value.items()
        if how == "r":
            return self._made[inner]
        return float(inner) if how == "f" else inner

    def _all(self, parts: Data) -> Data:
        return [self.read(part) for part in parts]
