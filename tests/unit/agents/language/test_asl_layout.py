"""Programs in one style: they mean the same, lose no comment, and stay as they are when formatted again."""

from pathlib import Path
from textwrap import dedent

import pytest
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from jacaros.agents.language.diagnostics import AslError, SourceFile
from jacaros.agents.language.formatting import format_program
from jacaros.agents.language.lexer import Comment, tokenize
from jacaros.agents.language.loader import load_program

ROOT = Path(__file__).parents[4]
PROGRAMS = [
    path
    for folder in ("src", "examples", "benchmarks/latency", "tests")
    for path in sorted((ROOT / folder).rglob("*.asl"))
    if "syntax_errors" not in path.parts
]


def formatted(text: str) -> str:
    return format_program("main.asl", text)


def comments_of(text: str) -> list[str]:
    """The words of the comments, sorted: two of them may have become one line."""
    comments: list[Comment] = []
    tokenize(SourceFile("x", text), lambda _: None, comments)
    return sorted(word for comment in comments for word in comment.text.split())


def program(text: str):
    return load_program("x", text, lambda path, _: (f"{path}!", ""))[0]


def test_steps_keep_blank_lines_and_programs_are_there():
    assert len(PROGRAMS) > 330
    text = "p.\nq.\n\n\nr.\n+!g\n  <- a;\n\n\n     b;\n     c.\n"
    assert formatted(text) == "p.\nq.\n\nr.\n+!g\n  <- a;\n\n     b;\n     c.\n"


def test_formatting_keeps_the_meaning_and_is_stable():
    for path in PROGRAMS:
        before = path.read_text(encoding="utf-8")
        after = formatted(before)
        assert program(after) == program(before), path
        assert comments_of(after) == comments_of(before), path
        assert formatted(after) == after, path
        assert after.endswith("\n"), path
        for line in after.splitlines():
            assert line == line.rstrip(), path


def test_the_style():
    text = """\
        p( 1 ). q. p(X) :- q
          & r.
        @l[ atomic ] +!g( X ):a(X)&X>1<-b;if(X>1){c}
        else{d;e};while(f){!g};(x;y)|&|z;?(not w).
        +!h:true<-b(1+2*-3,[H|T]).
        +!i<-
          .print( "a" ) ;
          { }.x( {+!new<-a;b} , Y ).
        """
    text = text.replace("{ }.x(", "x(")
    assert formatted(dedent(text)) == dedent(
        """\
        p(1).
        q.
        p(X) :- q
                & r.
        @l[atomic]
        +!g(X) : a(X) & X > 1
          <- b;
             if (X > 1) { c } else { d; e };
             while (f) { !g };
             (x; y) |&| z;
             ?(not w).
        +!h : true <- b(1 + 2 * -3, [H|T]).
        +!i
          <- .print("a");
             x({ +!new <- a; b }, Y).
        """
    )


def test_lines_that_the_author_breaks_are_aligned():
    text = """\
        +!g : a(X) &
        (b(Y) |
        c(Z)) &
        not d
        <: e
        <- f(1,
        [2,
        3]);
        for (h(X)) { i;
        j };
        k({ +!l <- m; n },
        o).
        p(X) :-
        q(X) &
        r.
        """
    assert formatted(dedent(text)) == dedent(
        """\
        +!g : a(X) &
              (b(Y) |
               c(Z)) &
              not d
            <: e
          <- f(1,
               [2,
                3]);
             for (h(X)) {
                i;
                j
             };
             k({ +!l <- m; n },
               o).
        p(X) :-
            q(X) &
            r.
        """
    )


def test_sub_plans_are_indented():
    text = """\
        { begin namespace(n) }
        @a[x]
        +!g <- a. { @b +e : c <- d;
        f. -e.
        }
        { end }
        """
    assert formatted(dedent(text)) == dedent(
        """\
        { begin namespace(n) }
        @a[x]
        +!g
          <- a. {
          @b
          +e : c
            <- d;
               f.
          -e.
        }
        { end }
        """
    )


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("// a\n\n\n\np.   // b\n\n// c", "// a\n\np.  // b\n\n// c\n"),
        ("/* a */ p. /* b */ q. /* c */", "/* a */ p.\n/* b */ q.  /* c */\n"),
        ("/* a\n   b */ p.", "/* a\n   b */\np.\n"),
        ("p(1, // a\n 2 // b\n).", "p(1,  // a\n  2   // b\n ).\n"),
        ("p(\n // a\n 1).", "p(\n  // a\n  1).\n"),
        (
            "+!g <- // a\n b; // c\n // d\n e. // f",
            "+!g\n  <- // a\n     b;  // c\n     // d\n     e.  // f\n",
        ),
        ("+!g // a\n : b // c\n <- d.", "+!g      // a\n    : b  // c\n  <- d.\n"),
        (
            "+!g <- if (a) { // b\n c // d\n // e\n } // f\n else { // g\n }.",
            "+!g\n  <- if (a) {  // b\n        c      // d\n        // e\n     }       // f\n     else {  // g\n     }.\n",
        ),
        ("+!g. { // a\n +e. // b\n // c\n }", "+!g. {  // a\n  +e.   // b\n  // c\n}\n"),
        ("{ begin dg(g) } // a\n// b\n+!g <- a.\n{ end } // c", None),
        ("p :- // a\n q & // b\n // c\n r.", None),
        ("+!g <- X = [1, // a\n // b\n 2|T]; f({ +!h <- // c\n a; // d\n b }).", None),
        ("// only a comment", "// only a comment\n"),
        ("", ""),
    ],
)
def test_comments_stay(before, after):
    result = formatted(before)
    assert comments_of(result) == comments_of(before)
    assert formatted(result) == result
    if after is not None:
        assert result == after


def test_a_wrong_program_is_refused_and_line_ends_of_other_systems_are_read():
    with pytest.raises(AslError, match="without a final"):
        formatted("p\nq.")
    assert formatted("p. // a\r\nq.\r\n") == "p.  // a\nq.\n"


GAPS = st.sampled_from(
    ["", "", "", " ", "\n", "\n\n\n", " // c\n", "\n// own\n", " /* c */ ", "\n/* a\nb */\n", "/* c */\n"]
)
SMALL = [path.read_text(encoding="utf-8") for path in PROGRAMS if path.stat().st_size < 300]


@settings(
    max_examples=50,
    phases=[Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
@given(st.data())
def test_comments_between_any_tokens_stay(data):
    text = data.draw(st.sampled_from(SMALL))
    lines = text.split("\n")
    for token in reversed(tokenize(SourceFile("x", text), lambda _: None)[:-2]):
        gap = data.draw(GAPS)
        if gap:
            line = lines[token.line - 1]
            lines[token.line - 1] = line[: token.column - 1] + gap + line[token.column - 1 :]
    changed = "\n".join(lines)
    try:
        result = formatted(changed)
    except AslError:
        # Signs that must stand together have been torn apart.
        assume(False)
    assert comments_of(result) == comments_of(changed)
    assert formatted(result) == result
