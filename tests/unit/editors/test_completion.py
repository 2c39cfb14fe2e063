"""What can be written at a position, in texts that do not parse, too."""

import random
import time

import pytest
from edited import edited, opened

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.editors.symbols.completion import completions
from jacaros.editors.symbols.descriptions import hover
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Position
from jacaros.editors.symbols.navigation import occurrence_at

PROJECT = """battery(80).
far(X) :- at(X) & not near(X, 2).
!start(1).
@go[atomic] +!go(Room) : at(Room) & pose(X, Y, Yaw)
   <- .print("going ", Room); drive(3, 1); +visited(Room); !go(Room).
+!start(N) <- !go(N).
+bump(Side) <- stop.
"""


def proposed(marked: str) -> list[str]:
    """Return the labels for the text after a project's program, the first ones first."""
    found = completions(*edited(PROJECT + marked))
    return [each.label for each in sorted(found, key=lambda each: each.rank)]


@pytest.mark.parametrize(
    ("marked", "some"),
    [
        (
            "+!x : ‸",
            ["battery(_)", "far(X)", "pose(X: m, Y: m, Yaw: °)", "not", ".member(X, C)"],
        ),
        ("+!x(Room) : ba‸", ["battery(_)"]),
        ("y(X) :- v‸", ["visited(Room)"]),
        (
            "+!x <- ‸",
            ["drive(length: m, speed: m/s)", "measure(distance)", "if", "focus(Id)"],
        ),
        ("+!x <- dri‸;\n   stop.", ["drive(length: m, speed: m/s)"]),
        ("+!x <- a;\n   !‸", ["start(N)", "go(Room)"]),
        ("+!x <- !!g‸", ["go(Room)"]),
        ("+!x <- -+v‸", ["visited(Room)"]),
        ("+!x <- ?fa‸", ["far(X)"]),
        ("+!x <- .sen‸", [".send(To, Performative, Content)"]),
        ("+!x <- if (‸", ["battery(_)", "not"]),
        ("+!x <- .findall(R, vis‸", ["visited(Room)"]),
        ("+!x <- .send(‸", ["guard"]),
        ("+!x <- .send(guard, t‸", ["tell", "tellHow"]),
        ("+!x <- .send(guard, achieve, ‸", ["start(N)", "go(Room)"]),
        ("+!x <- .send(guard, tell, vi‸", ["visited(Room)"]),
        ("+!x <- makeArtifact(w, ‸", ['"Wheels"', '"ArtCmdVel"']),
        ("+!x(Place) <- drive(Pl‸", ["Place"]),
        ("+‸", ["bump(Side)", "battery(_)"]),
        ("+!‸", ["start(N)", "go(Room)"]),
        ("-!g‸", ["go(Room)"]),
        ("@l[at‸", ["atomic"]),
        ("+!x <- drive(1, 2)[‸", ['artifact_name("name")', "timeout(1000)"]),
        ("+!x <- !go(1)[‸", ["within(5)", "every(1)"]),
        ("+visited(R)[‸", ["source(percept)", "source(self)"]),
    ],
)
def test_names_that_fit_are_proposed(marked: str, some: list[str]) -> None:
    found = proposed(marked)
    assert [each for each in some if each not in found] == []


@pytest.mark.parametrize(
    ("marked", "never"),
    [
        ("+!x : ‸", "drive(length: m, speed: m/s)"),
        ("+!x : .w‸", "visited(Room)"),
        ("+!x : ‸", ".send(To, Performative, Content)"),
        ("+!x <- !‸", "battery(_)"),
        ("+!x : newname‸", "newname"),
        ("+!x(Other) <- a.\n+!y <- drive(‸", "Other"),
    ],
)
def test_names_that_do_not_fit_are_not_proposed(marked: str, never: str) -> None:
    assert never not in proposed(marked)


@pytest.mark.parametrize(
    "marked", ["// +!‸", "/* +!‸", '+!x <- .print("‸', "/* a\n!‸ */", '+!x <- .print("a‸b").']
)
def test_comments_and_strings_have_no_names(marked: str) -> None:
    assert proposed(marked) == []


def test_a_proposal_is_a_snippet_for_the_name_so_far() -> None:
    index, file, at = edited("+!x <- dri‸")
    (found,) = completions(index, file, at)
    assert found.insert == "drive(${1:length}, ${2:speed})"
    assert found.replaces[1:] == (1, 8, 1, 11)
    assert found.detail == "operation of Wheels"
    assert found.documentation == "Drive *length* metres, at *speed* metres per second."


def test_names_of_other_namespaces_have_their_prefix() -> None:
    index, file, at = edited("{ begin namespace(lab) } open(1). { end }\n+!x : ‸")
    found = {each.label: each.insert for each in completions(index, file, at)}
    assert found["lab::open(_)"] == "lab::open(${1:_})"
    index, file, at = edited("{ begin namespace(lab) } open(1). { end }\n+!x : lab::o‸", index=index)
    assert [each.insert for each in completions(index, file, at)] == ["open(${1:_})"]


def test_hover_says_where_a_belief_comes_from() -> None:
    index, file, at = edited(PROJECT.replace("+visited", "+vis‸ited") + "+visited(R) <- stop.")
    found = hover(index, file, at)
    assert found is not None
    assert found.text.startswith("```\nvisited(Room)\n```")
    assert "- added: robot.asl:5" in found.text
    assert "- handled: robot.asl:8" in found.text
    assert "- source: `self`" in found.text
    told = hover(*edited("+!a <- .send(b, tell, x(1)).\n+!b : ‸x(_)."))
    assert told is not None
    assert "- source: the sender of a message" in told.text


@pytest.mark.parametrize(
    ("marked", "told"),
    [
        (
            "+!x <- dri‸ve(1, 2).",
            ["drive(length, speed)", "operation of `Wheels`", "Drive *length*"],
        ),
        (
            "+!x : po‸se(A, B, C).",
            [
                "pose(X, Y, Yaw)",
                "property of `Wheels`",
                "- `Yaw`: degrees",
                "where it is",
                "source: `percept`",
            ],
        ),
        ("+bu‸mp(S).", ["signal of `Wheels`", "it has hit something"]),
        ("+!x <- .abo‸lish(p).", [".abolish(P)", "internal action, 1 argument", "deletes all beliefs"]),
        ("+!x <- X = math.‸abs(1).", ["math.abs", "arithmetic function, 1 argument"]),
        ("+!x <- foc‸us(a).", ["focus(Id)", "perceive an artifact"]),
        ("+!x <- !‸go(1). +!go(R).", ["!go(R)", "posted: robot.asl:1", "handled: robot.asl:1"]),
        ("+!x <- dri‸ve(1, 2); broken(.", ["operation of `Wheels`"]),
    ],
)
def test_hover_describes(marked: str, told: list[str]) -> None:
    found = hover(*edited(marked))
    assert found is not None
    assert [each for each in told if each not in found.text] == []


def test_hover_of_a_variable_gives_its_unit() -> None:
    found = hover(*edited("+!x : pose(_, _, A‸) <- drive(A, 1).\n+!y(A) <- drive(1, A)."))
    assert found is not None
    assert (
        found.text
        == "- degrees (`Yaw` of `pose(X, Y, Yaw)`)\n- a number in metres (`length` of `drive(length, speed)`)"
    )


def test_hover_shows_the_comment_above_a_plan() -> None:
    found = hover(*edited("+!a <- !g‸o(1).\n\n// Drive to a room.\n// It may fail.\n+!go(R)."))
    assert found is not None
    assert "Drive to a room.\nIt may fail." in found.text


def test_nothing_is_known_of_other_variables_or_blanks() -> None:
    assert hover(*edited("+!x(A‸) <- b(A).")) is None
    assert hover(*edited("+!x  ‸  <- a.")) is None


def test_no_position_of_broken_texts_raises() -> None:
    chance = random.Random(40)
    index = edited("")[0]
    for _ in range(300):
        text = list(PROJECT)
        for _ in range(chance.randrange(1, 6)):
            at = chance.randrange(len(text))
            text[at : at + chance.randrange(4)] = chance.choice(
                ["", "(", ")", ".", '"', "/*", "{", "[", "!", "\n", "é"]
            )
        before = "".join(text[: chance.randrange(len(text) + 1)])
        file, at_end = opened(before + "‸")
        index.put(file.name, read_program(file)[0])
        assert isinstance(completions(index, file, at_end), list)
        occurrence_at(index, file, at_end)


def test_a_program_of_a_thousand_lines_is_fast() -> None:
    text = "".join(PROJECT.replace("go", f"go{number}") for number in range(143))
    file = SourceFile("robot.asl", f"{text}+!x : ba")
    assert text.count("\n") == 1001
    program, _ = read_program(file)
    index = Index()
    begin = time.process_time()
    index.put("robot.asl", program)
    list(index.symbols("belief"))
    indexed = time.process_time()
    assert completions(index, file, Position(1002, 9))
    assert indexed - begin < 1.0  # ten times the goal, for a loaded machine
    assert time.process_time() - indexed < 0.5
