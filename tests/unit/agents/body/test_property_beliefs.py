"""Programs whose agents believe in properties that are not plain numbers and strings, and that meddle with such beliefs."""

from collections.abc import Callable
from pathlib import Path

import pytest

from jacaros.testing import run_project

ARTIFACTS = '''
from jacaros.artifacts import Artifact, Out, operation


class Rude:
    """Cannot be asked anything."""

    def __eq__(self, other):
        raise RuntimeError("no")

    def __hash__(self):
        raise RuntimeError("no")

    def __repr__(self):
        raise RuntimeError("no")


class Box(Artifact):
    """Shows the given values."""

    def init(self, what: str):
        self.define_property("shown", self._made(what))

    def _made(self, what):
        if what == "rude":
            self.rude = Rude()
            return self.rude
        return eval(what)

    @operation
    def show(self, what: str):
        self.update_property("shown", self._made(what))

    @operation
    def claim(self):
        self.update_property("shown", self.caller)

    @operation(name="isIt")
    def is_it(self, thing: object, yes: Out):
        yes.set(thing is self.rude)
'''


Lines = Callable[..., list[str]]


@pytest.fixture
def lines(tmp_path: Path) -> Lines:
    """What the agents of a project print; programs are given by name."""

    def run(**programs: str) -> list[str]:
        (tmp_path / "artifacts.py").write_text(ARTIFACTS)
        for name, program in programs.items():
            (tmp_path / f"{name}.asl").write_text(program)
        agents = "".join(f"{name};" for name in programs)
        (tmp_path / "boxes.mas2j").write_text(
            f"MAS boxes {{ environment: jaca.CartagoEnvironment agents: {agents} }}"
        )
        result = run_project(tmp_path / "boxes.mas2j", seconds=10)
        assert not result.errors
        return result.lines

    return run


@pytest.mark.parametrize(
    ("first", "second"),
    [("list(range(1000))", "list(range(2000))"), ("[[]]*400", "{'a': 1}"), ("{'a': [1]}", "{'a': [2]}")],
)
@pytest.mark.parametrize("namespace", ["", "ns::"])
def test_long_lists_and_maps_come_and_go_as_other_values_do(lines, namespace, first, second):
    program = f"""
        !go.
        +!go
          <- makeArtifact("b", "Box", ["{first}"], Id); {namespace}focus(Id); !tell;
             show("{second}"); !tell;
             show("3"); !tell;
             show("{first}"); {namespace}stopFocus(Id); !tell; .stopMAS.
        +!tell <- .count({namespace}shown(_), N); .print(N).
    """
    assert lines(main=program) == [f"[main] {n}" for n in (1, 1, 1, 0)]


def test_a_list_of_a_million_numbers_can_be_perceived(lines):
    program = """
        !go.
        +!go <- makeArtifact("b", "Box", ["list(range(300000))"], Id); focus(Id);
                ?shown(L); .length(L, N); .print(N); stopFocus(Id); .count(shown(_), C); .print(C); .stopMAS.
    """
    assert lines(main=program) == ["[main] 300000", "[main] 0"]


def test_every_agent_has_its_own_copy_of_a_map(lines):
    one = """
        !go.
        +!go <- makeArtifact("b", "Box", ["{'a': 1}"], Id); focus(Id); .send(two, achieve, look(Id)); .wait(10);
                ?shown(M); .map.put(M, "b", 2); ?shown(M2); .print(M2); .wait(100); .stopMAS.
    """
    two = "+!look(Id) <- focus(Id); .wait(50); ?shown(M); .print(M)."
    assert lines(one=one, two=two) == ['[one] {"a"->1,"b"->2}', '[two] {"a"->1}']


def test_a_reference_survives_beliefs_and_messages_whatever_the_object_does(lines):
    one = """
        !go.
        +!go <- makeArtifact("b", "Box", ["rude"], Id); focus(Id);
                ?shown(R); +mine(R); ?mine(Mine); isIt(Mine, Yes); .print(Yes);
                .findall(X, mine(X), [Found]); if (Found == R) { .print(same) };
                .concat("", R, A); .concat("", Found, B); if (A == B) { .print("written the same") };
                .send(two, tell, got(Mine, Id)); .wait(50); -mine(R); .count(mine(_), N); .print(N); .stopMAS.
    """
    two = "+got(R, Id) <- isIt(R, Yes)[artifact_id(Id)]; .print(Yes)."
    assert lines(one=one, two=two) == [
        "[one] true", "[one] same", "[one] written the same", "[two] true", "[one] 0"
    ]  # fmt: skip


def test_a_property_is_taken_away_by_a_pattern_but_not_by_its_literal(lines):
    program = """
        !go.
        +!go <- makeArtifact("b", "Box", ["1"], Id); focus(Id);
                -shown(1)[source(percept)]; !tell;
                ?shown(X); -shown(X)[source(percept)]; !tell;
                -shown(_); !tell;
                -shown(_)[source(percept)]; !tell;
                show("2"); !tell;
                .abolish(shown(_)); !tell; .stopMAS.
        +!tell <- .findall(X, shown(X), L); .print(L).
    """
    assert lines(main=program) == [f"[main] {x}" for x in ("[1]", "[1]", "[1]", "[]", "[2]", "[]")]


def test_beliefs_go_before_the_belief_that_the_artifact_is_focused(lines):
    program = """
        !go.
        +!go <- makeArtifact("b", "Box", ["1"], Id); focus(Id); .wait(10); stopFocus(Id); .wait(10); .stopMAS.
        +shown(_) <- .print("+shown").
        -shown(_) <- .print("-shown").
        +focusing(_, B, _, _, _, _) <- .print("+focusing ", B).
        -focusing(_, B, _, _, _, _) <- .print("-focusing ", B).
    """
    expected = ["+shown", "+focusing b", "-shown", "-focusing b"]
    assert lines(main=program) == [f"[main] {each}" for each in expected]


TWO_BOXES = """
!start.
+!start
  <- makeArtifact(left, "Box", ["1"], L);
     makeArtifact(right, "Box", ["1"], R);
     focus(L); focus(R);
     !go.
"""


def test_two_artifacts_with_equal_values_are_two_beliefs_with_their_own_annotations(lines):
    program = """
of(Box) :- shown(1)[artifact_name(Box)].
+!go : .count(shown(_), 2) & .findall(B, shown(1)[artifact_name(B)], Bs) & .findall(B, of(B), Same)
  <- .print(Bs); .print(Same);
     for (shown(1)[artifact_name(Box)]) { show("2")[artifact_name(Box)] };
     .wait(1);
     .findall(V, shown(V), Vs);
     .print(Vs).
"""
    assert lines(one=TWO_BOXES + program) == ["[one] [right,left]", "[one] [right,left]", "[one] [2,2]"]


def test_a_belief_in_one_of_two_equal_properties_goes_alone(lines):
    program = """
+!go
  <- show("2")[artifact_name(left)];
     .wait(1);
     .findall(b(V, Box), shown(V)[artifact_name(Box)], First);
     show("1")[artifact_name(left)];
     .wait(1);
     .findall(b(V, Box), shown(V)[artifact_name(Box)], Again);
     lookupArtifact(right, R);
     disposeArtifact(R);
     .wait(1);
     .findall(b(V, Box), shown(V)[artifact_name(Box)], Last);
     .print(First, " ", Again, " ", Last).
"""
    assert lines(one=TWO_BOXES + program) == [
        "[one] [b(2,left),b(1,right)] [b(1,left),b(1,right)] [b(1,left)]"
    ]


def test_a_clone_believes_in_two_equal_properties(lines):
    program = """
+!go <- .clone(two); .send(two, achieve, tell).
+!tell : .count(shown(1), N) <- .print(N).
"""
    assert lines(one=TWO_BOXES + program) == ["[two] 2"]


def test_the_name_of_a_caller_is_the_atom_that_agents_know(lines):
    program = """
!go.
+!go <- makeArtifact("b", "Box", ["0"], Id); focus(Id); claim.
+shown(W) : .my_name(W) <- .print("mine").
"""
    assert lines(one=program) == ["[one] mine"]
