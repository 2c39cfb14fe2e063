"""The belief base against a simple model, and its indexes."""

from hypothesis import given
from hypothesis import strategies as st

from jacaros.bdi.belief_base import Table
from jacaros.terms.values import BY_SELF, atom, functor

OPERATIONS = st.lists(
    st.tuples(st.sampled_from(["add", "last", "remove"]), st.integers(0, 4), st.integers(0, 2)), max_size=40
)


class Model:
    """Rows in the order in which they answer: a plain list."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float]] = []

    def apply(self, operation: str, row: tuple[float, float]) -> None:
        if operation == "remove":
            if row in self.rows:
                self.rows.remove(row)
        elif row not in self.rows:
            self.rows.insert(0 if operation == "add" else len(self.rows), row)


@given(OPERATIONS)
def test_a_table_answers_like_a_list_whatever_is_added_and_removed(
    operations: list[tuple[str, int, int]],
) -> None:
    table, model = Table(functor("p", 2)), Model()
    table.find((0,), 0.0)
    table.find((0, 1), (0.0, 0.0))
    for operation, a, b in operations:
        row = (float(a), float(b))
        model.apply(operation, row)
        if operation == "remove":
            if table.get(row) is not None:
                table.remove(row)
        elif table.get(row) is None:
            table.add(row, BY_SELF, last=operation == "last")
    assert [entry for entry, _ in table.entries()] == model.rows
    if table.plain:
        for a in range(5):
            assert list(table.find((0,), float(a))) == [r for r in model.rows if r[0] == a]
            assert list(table.find((0, 1), (float(a), 1.0))) == [r for r in model.rows if r == (a, 1.0)]


def test_a_table_that_held_a_rule_is_plain_again_when_it_is_gone() -> None:
    table = Table(atom("p"))
    rule = object()
    table.add((), BY_SELF)
    table.add(rule, ())
    assert not table.plain
    table.remove(rule)
    assert table.plain
