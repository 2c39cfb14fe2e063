"""The internal actions ``cartago.*``, and objects as filters."""

from pathlib import Path

import pytest

from jacaros.testing import run_project

SHAPES = """
class Square:
    "A square."

    kind = "flat"

    def __init__(self, side):
        self.side = side

    def area(self):
        return self.side ** 2

    def grow(self, by=1):
        self.side += by

    def corners(self):
        return [(0, 0), (self.side, self.side)]

    @classmethod
    def unit(cls):
        return cls(1)

    @staticmethod
    def leave():
        raise SystemExit(3)


def twice(value):
    return value * 2
"""


def lines(folder: Path, body: str, **files: str) -> list[str]:
    """What an agent prints that does *body*; its failure is printed too."""
    for name, text in {"shapes": SHAPES, **files}.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    program = f"""
!start.
+!start <- {body}.
-!start[error(Error), error_msg(Message)] <- .print(Error, ": ", Message).
"""
    (folder / "a.asl").write_text(program, encoding="utf-8")
    return run_project(folder / "a.asl", until_idle=True).of("a")


def test_an_object_of_the_project_is_made_and_used(tmp_path: Path) -> None:
    body = """cartago.new_obj("shapes.Square", [3], S);
        cartago.invoke_obj(S, area, A); .print(A);
        cartago.invoke_obj(S, grow); cartago.invoke_obj(S, grow(2)); cartago.invoke_obj(S, side, B); .print(B);
        cartago.invoke_obj(S, corners, C); .print(C);
        cartago.invoke_obj(S, grow, Nothing); .print("nothing ", Nothing)"""
    assert lines(tmp_path, body) == ["9", "6", "[[0,0],[6,6]]", "nothing Nothing<no-value>"]


def test_a_class_and_a_function_can_be_called_without_an_object(tmp_path: Path) -> None:
    body = """cartago.invoke_obj("shapes.Square", unit, U); cartago.invoke_obj(U, area, A); .print(A);
        cartago.invoke_obj("shapes.Square", kind, K); .print(K);
        cartago.invoke_obj("shapes", twice("ab"), T); .print(T);
        cartago.invoke_obj("math", sqrt(16), R); .print(R);
        cartago.new_obj("collections.deque", [[1, 2]], D); cartago.invoke_obj(D, popleft, P); .print(P);
        cartago.new_obj(list, [[c, "d", 1.5, true]], L); cartago.array_to_list(L, Items); .print(Items)"""
    assert lines(tmp_path, body) == ["1", "flat", "abab", "4", "1", '[c,"d",1.5,true]']


def test_arrays_have_items_of_their_type(tmp_path: Path) -> None:
    body = """cartago.new_array("int[]", [1, 2], I); cartago.array_to_list(I, A); .print(A);
        cartago.new_array("String[]", ["a", b], S); cartago.invoke_obj(S, "__len__", N); .print(N);
        cartago.new_array("java.lang.Object[]", [1, [x]], O); cartago.array_to_list(O, B); .print(B);
        cartago.new_array("int[]", [0.5], _)"""
    assert lines(tmp_path, body) == [
        "[1,2]",
        "2",
        "[1,[x]]",
        "internal_action: expected items of int[], found 0.5",
    ]


def test_an_agent_lists_its_workspaces(tmp_path: Path) -> None:
    body = """createWorkspace(lab); joinWorkspace(lab, L); cartago.current_wsps(All); .length(All, N);
        .print(N); if (.member(L, All)) { .print("lab is among them") }"""
    assert lines(tmp_path, body) == ["2", "lab is among them"]


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ('cartago.new_obj("shapes.Cube", [], _)', "unknown class `shapes.Cube`: "),
        ('cartago.new_obj("no.such.Thing", [], _)', "unknown class `no.such.Thing`: ModuleNotFoundError"),
        ('cartago.new_obj("java.util.ArrayList", [], _)', "unknown class `java.util.ArrayList`: "),
        ("cartago.new_obj(3, [], _)", "expected the name of a class, found 3"),
        ('cartago.new_obj("shapes.Square", 3, _)', "expected a list of arguments, found 3"),
        ('cartago.new_obj("shapes.Square", [_], _)', "expected ground arguments, found an unbound variable"),
        ('cartago.new_obj("shapes.Square", [], _)', "shapes.Square(...): TypeError"),
        ('cartago.invoke_obj("shapes.Square", fly)', "unknown method `fly` of class shapes.Square"),
        (
            'cartago.invoke_obj("shapes.Square", kind(1))',
            "expected a function as kind of class shapes.Square, found str",
        ),
        ('cartago.invoke_obj("shapes.Square", leave)', "leave of class shapes.Square: SystemExit: 3"),
        ("cartago.invoke_obj(4, bit_length)", "expected an object or the name of a class, found 4"),
        ('cartago.invoke_obj("math", 3)', "expected a call such as append(3), found 3"),
        ("cartago.array_to_list(x, _)", "expected an array, found x"),
        ("cartago.new_array(int, [], _)", 'expected a type such as "int[]", found int'),
        ('cartago.new_obj("broken.Thing", [], _)', "unknown class `broken.Thing`: ModuleUnreadable"),
    ],
)
def test_errors_fail_the_internal_action(tmp_path: Path, body: str, message: str) -> None:
    (line,) = lines(tmp_path, body, broken="1 / 0\n")
    assert line.startswith(f"internal_action: {message}")
