"""The arguments of a literal that a condition asks for: how the rows of its predicate are found and read."""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in
from jacaros.bdi.fast.generated.building import as_name, build, constant_value, is_number, is_static, tuple_of
from jacaros.bdi.fast.generated.function import FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, match_all
from jacaros.terms.substitution import is_key


class QueryArguments:
    """The arguments of a queried literal: which are known, which are read from the rows.

    Attributes:
        terms: an expression for each argument, as rules are asked with.
        tests: what has to hold for the known ones to be keys.
        known: places of the known arguments.
        given: places of those of which at least something is known.
        target: what a row is unpacked into.
    """

    def __init__(self, fn: FunctionBuilder, patterns: tuple[nodes.Term, ...]) -> None:
        self.fn = fn
        self.terms: list[str] = []
        self.tests: list[str] = []
        self.known: list[int] = []
        self.given: list[int] = []
        self.parts: list[str] = []
        self.rest: list[tuple[nodes.Node, str]] = []
        for index, pattern in enumerate(patterns):
            self._add(index, pattern)
        self.target = tuple_of(self.parts) if any(p != "_" for p in self.parts) else "_"

    def _add(self, index: int, pattern: nodes.Node) -> None:
        fn = self.fn
        tests = self._key_tests(pattern)
        if isinstance(pattern, nodes.Variable) and pattern.unnamed and pattern.annotations is None:
            self.terms.append("Var()")
            self.parts.append("_")
        elif tests is None:
            part = fn.local("c")
            self.terms.append(self._pattern_term(pattern))
            self.parts.append(part)
            if not isinstance(pattern, nodes.Variable):
                self.given.append(index)
            self.rest.append((pattern, part))
        else:
            value = as_name(fn, build(fn, pattern))
            self.terms.append(value)
            self.parts.append("_")
            self.known.append(index)
            self.given.append(index)
            computed = [f"{value}.__class__ in ATOMIC"] if self._is_computed(pattern, value) else []
            self.tests.extend([*tests, *computed])

    def _pattern_term(self, pattern: nodes.Node) -> str:
        """What rules are asked with: as much of the pattern as is known, so that they do not search for more."""
        if isinstance(pattern, nodes.Variable):
            return "Var()"
        with self.fn.branch():
            return as_name(self.fn, build(self.fn, pattern))

    @staticmethod
    def _is_computed(pattern: nodes.Node, value: str) -> bool:
        """Whether it is known only at run time that the pattern has a value."""
        if isinstance(pattern, nodes.Literal | nodes.ListTerm):
            return False
        return not (is_number(value) or is_static(pattern))

    def _key_tests(self, pattern: nodes.Node) -> list[str] | None:
        """What has to hold for the pattern to be a key, besides that it has a value; None when it cannot be one."""
        if any(name not in self.fn.values for name in names_in(pattern)):
            return None
        if isinstance(pattern, nodes.Variable):
            return None if pattern.unnamed or pattern.annotations is not None else []
        if isinstance(pattern, nodes.Number | nodes.String | nodes.Arithmetic | nodes.FunctionCall):
            return []
        return self._part_tests(pattern)

    def _part_tests(self, pattern: nodes.Node) -> list[str] | None:
        """The tests for a structure or list, or a part of one: annotations and anonymous parts make it no key."""
        if is_static(pattern):
            return [] if is_key(constant_value(pattern)) else None
        if isinstance(pattern, nodes.Variable):
            if pattern.unnamed or pattern.negated or pattern.annotations or pattern.namespace is not None:
                return None
            return [f"{self.fn.values[pattern.name]}.__class__ in ATOMIC"]
        if isinstance(pattern, nodes.Literal) and pattern.annotations is None:
            parts = None if isinstance(pattern.namespace, nodes.Variable) else pattern.arguments
        elif isinstance(pattern, nodes.ListTerm) and pattern.tail is None:
            parts = pattern.items
        else:
            parts = None
        found: list[str] = []
        for part in parts or ():
            tests = self._part_tests(part)
            if tests is None:
                return None
            found.extend(tests)
        return found or None

    def fast_rows(self, table: str) -> str:
        """An expression for the rows of a table that holds only facts."""
        if not self.known:
            return self._lasting(table, f"reversed({table}.rows)")
        keys = [self.terms[i] for i in self.known]
        if len(keys) == len(self.terms):
            return f"{table}.exact({tuple_of(keys)})"
        positions = self.fn.constant(tuple(self.known))
        key = keys[0] if len(keys) == 1 else tuple_of(keys)
        return self._lasting(table, f"{table}.find({positions}, {key})")

    def rows_and_annotations(self, table: str) -> str:
        """An expression for the rows of a table that holds only facts, each with its annotations."""
        if not self.known:
            return f"reversed({table}.rows.items())"
        keys = [self.terms[i] for i in self.known]
        if len(keys) == len(self.terms):
            return f"{table}.exact_item({tuple_of(keys)})"
        positions = self.fn.constant(tuple(self.known))
        return f"{table}.find_items({positions}, {keys[0] if len(keys) == 1 else tuple_of(keys)})"

    def _lasting(self, table: str, rows: str) -> str:
        """Rows that may be read while beliefs change: where answers are taken in between two steps."""
        taken_later = self.fn.trampoline or self.fn.snapshot
        return f"rows_still_held({table}, list({rows}))" if taken_later else rows

    def match_rest(self, then: Then) -> None:
        """Match the read parts with their patterns."""
        mark = None
        plain = all(isinstance(p, nodes.Variable) and p.annotations is None for p, _ in self.rest)
        if self.rest and not plain:
            mark = self.fn.local("n")
            self.fn.line(f"{mark} = len(t)")
        match_all(self.fn, [p for p, _ in self.rest], [v for _, v in self.rest], then)
        if mark is not None:
            self.fn.line(f"if len(t) > {mark}: undo(t, {mark})")
