"""What `jacaros check` reports about offers, in a project whose agents are all known."""

from pathlib import Path

import pytest

from jacaros.runtime.mas.checks.files import check_files

SOUND = """
{ offer(goal, deliver(parcel(string), room([kitchen, office]))) }
{ offer(belief, battery(level(number))) }
{ offer(question, room(name(out(atom)))) }
{ offer(tell, closed(room(atom))) }
{ offer(event, delivered(parcel(string))) }
battery(80).
room(kitchen). room(office).
+!deliver(_, Room) : closed(Room) <- .refuse(closed(Room)).
+!deliver(Parcel, Room) : room(Room) <- .announce(delivered(Parcel)).
-closed(Room) <- .print(Room).
"""


def findings(folder: Path, program: str) -> list[tuple[str, str, str]]:
    """Return the code, message and help of each finding."""
    (folder / "a.asl").write_text(program, encoding="utf-8")
    (folder / "p.jcm").write_text("mas p { agent a }", encoding="utf-8")
    found = check_files([folder / "p.jcm"]).diagnostics
    return [(each.code, each.message, each.help or "") for each in found]


def test_offers_post_goals_tell_beliefs_and_read_them(tmp_path: Path) -> None:
    assert findings(tmp_path, SOUND) == []


@pytest.mark.parametrize(
    ("written", "instead", "code", "message", "help"),
    [
        (
            "offer(goal, deliver(parcel(string), ",
            "offer(goal, deliver(",
            "unknown-goal",
            "no plan for `!deliver/1`",
            "did you mean `!deliver/2`?",
        ),
        (
            "offer(belief, battery(level(number)))",
            "offer(belief, batery(level(number)))",
            "misspelt-belief",
            "belief `batery/1` is never added",
            "did you mean `battery`?",
        ),
        (
            "offer(belief, battery(level(number)))",
            "offer(belief, load(kilograms(number)))",
            "unknown-belief",
            "belief `load/1` is never added",
            "add it in a plan (`+load(Kilograms)`), or at the beginning (`load(Kilograms).`)",
        ),
        (
            "question, room(name(out(atom)))",
            "question, way(metres(out(number)))",
            "unknown-belief",
            "belief `way/1` is never added",
            "write a rule: `way(Metres) :- ...`",
        ),
        (
            "closed(room(atom))",
            "closed(room(string))",
            "never-matches",
            "`closed(lab)` never matches: `lab` is an atom, but `closed/1` has a string",
            'did you mean `"lab"`?',
        ),
        (
            "offer(tell, closed(room(atom)))",
            "offer(tell, closed(room(atom)))} {offer(tell, blocked(door(atom)))",
            "unused-offer",
            "callers may tell `blocked/1`, but nothing reads it",
            "read it in a context, or react to it: `+blocked(Door) <- ...`",
        ),
        (
            "offer(event, delivered(parcel(string)))",
            "offer(event, delivered(parcel(string)))} {offer(event, lost)",
            "unused-offer",
            "event `lost/0` is offered, but never announced",
            "announce it: `.announce(lost)`",
        ),
        (
            ".announce(delivered(Parcel))",
            ".announce(delivered(Parcel)); .announce(parked)",
            "not-offered",
            "event `parked/0` is announced, but not offered",
            "write `{ offer(event, parked) }`",
        ),
        (
            "[kitchen, office]",
            "[kitchen, offcie]",
            "unknown-choice",
            "`offcie` can be chosen for `deliver/2`, but the program does not know it",
            "did you mean `office`?",
        ),
    ],
)
def test_an_offer_that_does_not_fit_the_program_is_reported(
    tmp_path: Path, written: str, instead: str, code: str, message: str, help: str
) -> None:
    program = SOUND.replace(".print(Room).", ".print(Room). +closed(lab).")
    assert written in program
    assert (code, message, help) in findings(tmp_path, program.replace(written, instead))


def test_without_an_offer_nothing_posts_the_goal(tmp_path: Path) -> None:
    offer = "{ offer(goal, deliver(parcel(string), room([kitchen, office]))) }"
    found = findings(tmp_path, SOUND.replace(offer, ""))
    assert {code for code, _, _ in found} == {"goal-never-posted"}


def test_events_that_are_computed_may_be_any(tmp_path: Path) -> None:
    program = SOUND.replace(".announce(delivered(Parcel))", "E = delivered(Parcel); .announce(E)")
    assert findings(tmp_path, program) == []


def test_a_choice_unlike_all_names_may_come_from_a_map(tmp_path: Path) -> None:
    assert findings(tmp_path, SOUND.replace("[kitchen, office]", "[kitchen, office, lab]")) == []
