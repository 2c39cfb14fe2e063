"""Plain values drawn by Hypothesis, and their comparison."""

from hypothesis import strategies as st

from jacaros.artifacts.env.values import Atom, Structure

NAMES = st.text(min_size=1).filter(lambda name: name not in ("true", "false"))
NUMBERS = st.integers(-(2**53), 2**53) | st.floats(allow_nan=False).map(
    lambda x: int(x) if x.is_integer() else x
)
SCALARS = NUMBERS | st.booleans() | st.text() | st.builds(Atom, NAMES)


def _compound(inner: st.SearchStrategy[object]) -> st.SearchStrategy[object]:
    return (
        st.lists(inner)
        | st.builds(Structure, NAMES, st.lists(inner, min_size=1).map(tuple))
        | st.dictionaries(st.text() | NUMBERS, inner)
    )


VALUES = st.recursive(SCALARS, _compound, max_leaves=10)


def same(left: object, right: object) -> bool:
    """Equal, and of the same classes all the way down."""
    if type(left) is not type(right):
        return False
    if isinstance(left, list):
        return len(left) == len(right) and all(map(same, left, right))
    if isinstance(left, dict):
        return left.keys() == right.keys() and all(same(item, right[key]) for key, item in left.items())
    if isinstance(left, Structure):
        return left.functor == right.functor and same(list(left.arguments), list(right.arguments))
    return left == right
