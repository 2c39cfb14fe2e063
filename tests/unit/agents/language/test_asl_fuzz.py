"""Whatever the text, there is a tree or there are diagnostics."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from jacaros.agents.language.diagnostics import AslError, Diagnostic
from jacaros.agents.language.loader import load_program, parse_plans, parse_term
from jacaros.agents.language.lowering import format_term

TESTS = Path(__file__).parents[3]
PROGRAMS = [path.read_text(encoding="utf-8") for path in sorted((TESTS / "conformance").rglob("*.asl"))]
WORDS = r"""
    p X _ _1 12 .5 "s" 'q' " ' a.b .print .length math.max ns:: N:: . , ; : :- <- <: ! !! ? ^ @ @l ~ ::
    # $ \ é 日 + - -+ ++ -- +< +> * / ** < <= > = == \== =.. | & ( ) [ ] { } [a|T] |&| ||| +!g +b(X)
    if(a){b} {end} div mod not true false if else elif for while begin end // /* */ {include("x")}
    {namespace(n)}
"""
PIECES = [*WORDS.split(), "{begin dg(g)}", "\n", "\t", " "]
fuzzed = settings(max_examples=150)


def read(path: str, including: str) -> tuple[str, str]:
    if path == "x":
        return "x", 'p. +!g <- a. {include("y")}'
    raise FileNotFoundError(path)


def check_diagnostics(text: str) -> None:
    for diagnostic in diagnostics_of(text):
        assert diagnostic.span is not None
        if diagnostic.span.file.name == "fuzz.asl":
            assert 1 <= diagnostic.span.line <= text.count("\n") + 1
        assert diagnostic.render()


def diagnostics_of(text: str) -> Sequence[Diagnostic]:
    try:
        return load_program("fuzz.asl", text, read)[1]
    except AslError as error:
        return error.diagnostics


@fuzzed
@given(st.lists(st.sampled_from(PIECES), max_size=60))
def test_random_tokens_give_diagnostics(pieces):
    check_diagnostics(" ".join(pieces))
    check_diagnostics("".join(pieces))


@fuzzed
@given(st.text(max_size=80))
def test_random_text_gives_diagnostics(text):
    check_diagnostics(text)


@fuzzed
@given(st.data())
def test_changed_programs_give_diagnostics(data):
    text = data.draw(st.sampled_from(PROGRAMS))
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, max(len(text) - 1, 0)))
        length = data.draw(st.integers(0, 6))
        inserted = data.draw(st.sampled_from(["", *PIECES]))
        text = text[:at] + inserted + text[at + length :]
    check_diagnostics(text)


@fuzzed
@given(st.lists(st.sampled_from(PIECES), max_size=12))
def test_terms_and_plans_at_run_time_give_diagnostics(pieces):
    text = " ".join(pieces)
    try:
        term = parse_term(text)
    except AslError:
        pass
    else:
        assert parse_term(format_term(term)) is not None
    with suppress(AslError):
        parse_plans(text)


def test_every_beginning_of_a_program_gives_diagnostics():
    text = max((program for program in PROGRAMS if len(program) < 900), key=len)
    for end in range(len(text)):
        check_diagnostics(text[:end])
