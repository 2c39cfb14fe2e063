"""Definitions, references and renaming."""

from pathlib import Path

import pytest
from edited import edited

from jacaros.editors.symbols.descriptions import hover
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import RenameRefused
from jacaros.editors.symbols.navigation import definitions, highlights, references
from jacaros.editors.symbols.renaming import renamable, rename
from jacaros.robots.registry import type_finder
from jacaros.runtime.files.python_modules import ProjectModules

LIBRARY = ("lib.asl", "+!help(X) : near(X) <- stop.\nnear(home).")


def places(marked: str) -> list[tuple[str, int, int]]:
    found = definitions(*edited(marked, LIBRARY))
    return [(Path(each.file.name).name, each.line, each.column) for each in found]


@pytest.mark.parametrize(
    ("marked", "expected"),
    [
        ("!go‸(1).\n+!go(X).\n-!go(X).", [("robot.asl", 2, 3), ("robot.asl", 3, 3)]),
        ("at(1).\n+!go : ‸at(X).\n+!b <- +at(2).", [("robot.asl", 1, 1)]),
        ("+!go : at‸(X).\n+!b <- +at(2).", [("robot.asl", 2, 9)]),
        ("far(X) :- at(X).\n+!go : fa‸r(X).", [("robot.asl", 1, 1)]),
        ("+!go(Room) : at(Room) <- move(Roo‸m).", [("robot.asl", 1, 6)]),
        ("+!go <- !hel‸p(1).", [("lib.asl", 1, 3)]),
        ("@l +!go <- .remove_plan(‸l).", [("robot.asl", 1, 2)]),
        ("+!go <- .prin‸t(1).", []),
        ("+!go <- ‸(1).", []),
        ("+!broken <- !hel‸p(1); move(.", [("lib.asl", 1, 3)]),
    ],
)
def test_a_name_leads_to_its_definition(marked: str, expected: list[tuple[str, int, int]]) -> None:
    assert places(marked) == expected


def test_operations_and_properties_lead_to_the_artifact() -> None:
    code = Path(__file__).with_name("edited.py").read_text(encoding="utf-8").splitlines()
    for marked, line in (
        ("+!go <- dri‸ve(1, 2).", "def drive"),
        ("+!go : po‸se(X, Y, Z).", "define_property"),
    ):
        ((file, number, _),) = places(marked)
        assert file == "edited.py"
        assert line in code[number - 1]


def test_references_are_in_all_programs_and_may_leave_definitions_out() -> None:
    index, file, at = edited("+!go <- !help‸(1).\n+!b <- !help(2).", LIBRARY)
    found = [(each.span.file.name, each.span.line) for each in references(index, file, at)]
    assert found == [("lib.asl", 1), ("robot.asl", 1), ("robot.asl", 2)]
    assert len(references(index, file, at, with_definitions=False)) == 2
    assert [each.span.line for each in highlights(index, file, at)] == [1, 2]


def renamed(marked: str, name: str) -> dict[str, str]:
    """Return the texts of the edited programs."""
    index, file, at = edited(marked, LIBRARY)
    found: dict[str, list[str]] = {}
    for span, text in sorted(rename(index, file, at, name), reverse=True, key=lambda each: each.span[1:]):
        lines = found.setdefault(span.file.name, list(span.file.lines))
        line = lines[span.line - 1]
        lines[span.line - 1] = line[: span.column - 1] + text + line[span.end_column - 1 :]
    return {name: "\n".join(lines) for name, lines in found.items()}


def test_rename_changes_all_programs() -> None:
    assert renamed("+!go <- !he‸lp(1). // help", "assist") == {
        "robot.asl": "+!go <- !assist(1). // help",
        "lib.asl": "+!assist(X) : near(X) <- stop.\nnear(home).",
    }


def test_rename_of_a_variable_stays_in_its_clause() -> None:
    assert renamed("+!a(X) : p(‸X) <- q(X).\n+!b(X).", "Room") == {
        "robot.asl": "+!a(Room) : p(Room) <- q(Room).\n+!b(X)."
    }


@pytest.mark.parametrize(
    ("marked", "name", "reason"),
    [
        ("+!go <- !help‸(1).", "Help", "`Help` is not a name"),
        ("+!go <- !help‸(1).", "while", "`while` is a word of the language"),
        ("+!go <- !help‸(1). +!stay(2).", "stay", "`!stay/1` exists already (robot.asl:1)"),
        ("+!go : mine‸(1, 2, 3).", "pose", "`pose/3` is a property of `Wheels`"),
        ("+!go : pose‸(1, 2, 3).", "place", "`pose` is a property of `Wheels`"),
        ("+!go <- drive‸(1, 2).", "move", "`drive` is an operation of `Wheels`"),
        ("+!go <- .print‸(1).", "show", "`.print` is an internal action"),
        ("+!go(X) <- f(X‸, Y).", "Y", "`Y` exists already (robot.asl:1)"),
        ("+!go(X‸) <- f(X).", "y", "`y` is not a variable"),
        ("+!go ‸<- f(X).", "y", "nothing to rename here"),
        ("+!go <- !unread‸; f(", "y", "`unread` is in a clause with errors"),
    ],
)
def test_rename_refuses_what_would_change_the_meaning(marked: str, name: str, reason: str) -> None:
    with pytest.raises(RenameRefused) as refused:
        rename(*edited(marked, LIBRARY), name)
    assert refused.value.message == reason
    assert refused.value.help


def test_rename_refuses_a_name_that_is_also_in_a_broken_clause() -> None:
    broken = "+!go <- !help‸(1). // help\n+!b <- .print(help).\n+!c <- !help(; a."
    with pytest.raises(RenameRefused, match=r"a clause with errors \(robot.asl:3\)"):
        rename(*edited(broken, LIBRARY), "assist")
    assert rename(*edited(broken.replace("(;", ";"), LIBRARY), "assist")


def test_rename_refuses_names_of_libraries() -> None:
    index, file, at = edited("+!go <- !hel‸p.", ("$jacaros/lib.asl", "+!help."))
    with pytest.raises(RenameRefused, match="in the library"):
        renamable(index, file, at)


def test_python_of_the_project_is_read_and_not_run(tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(
        "from pathlib import Path\n"
        "from jacaros.artifacts import Artifact, operation\n"
        "Path(__file__).with_name('ran').touch()\n\n\n"
        "class Lamp(Artifact):\n"
        '    """Gives light."""\n\n'
        "    def init(self) -> None:\n"
        '        self.define_property("lit", False)\n\n'
        "    @operation\n"
        "    async def fade(self, seconds: float) -> None:\n"
        '        """Fade in *seconds* seconds."""\n',
        encoding="utf-8",
    )
    lamp = type_finder(ProjectModules(tmp_path, unseen=set()))("Lamp")
    for marked, line, column in (("+!go <- fa‸de(3).", 13, 15), ("+li‸t(true).", 10, 30)):
        (found,) = definitions(*edited(marked, index=Index([lamp])))
        assert found[1:3] == (line, column)
        assert Path(found.file.name) == tmp_path / "artifacts.py"
    text = hover(*edited("+!go <- fa‸de(3).", index=Index([lamp])))
    assert text is not None
    assert "Fade in *seconds* seconds" in text.text
    assert not (tmp_path / "ran").exists()
