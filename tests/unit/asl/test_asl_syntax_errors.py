"""What people see when a program is wrong: place, excerpt, help, and all errors at once."""

from textwrap import dedent

import pytest
from asl_lab import errors, places

from jacaros.asl.declaration import Declaration
from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import load_program


def report(text: str) -> str:
    with pytest.raises(AslError) as refused:
        load_program("robot.asl", dedent(text))
    return str(refused.value)


def test_a_missing_final_dot_is_reported_where_the_next_plan_begins():
    assert report(
        """\
        !start.
        +!start <- .print(a); .stopMAS
        +!other <- .print(b).
        """
    ) == dedent(
        """\
        robot.asl:3:1: error: the plan before has no final '.'; the next plan begins here
          3 | +!other <- .print(b).
            | ^
          = help: put a '.' behind line 2"""
    )


def test_all_errors_of_a_file_are_reported_at_once_in_order():
    assert report(
        """\
        battery(60
        !patrol.
        +!patrol : battery(B) : B > 20
           <- !go(lab)
              .print("here);
              !patrol.
        +!go(R) <- .
        +!charge -> dock.
        """
    ) == dedent(
        """\
        robot.asl:2:1: error: '(' is not closed: ')' is expected before '!'
          1 | battery(60
            |        ^
          2 | !patrol.
            | ^
          = help: it was opened at line 1, column 8

        robot.asl:3:23: error: a plan has only one context
          3 | +!patrol : battery(B) : B > 20
            |                       ^
          = help: join the conditions with &

        robot.asl:5:7: error: a ';' is missing before this step
          5 |       .print("here);
            |       ^^^^^^
          = help: steps are separated by ';', the last one is followed by '.'

        robot.asl:5:14: error: the string does not end on its line
          5 |       .print("here);
            |              ^^^^^^^
          = help: close it: "text"; a line break inside is \\n

        robot.asl:7:9: error: the body behind '<-' is missing
          7 | +!go(R) <- .
            |         ^^
          = help: write the steps, or leave out '<-' if there is nothing to do

        robot.asl:8:10: error: there is no '->'
          8 | +!charge -> dock.
            |          ^
          = help: the body of a plan begins with <-"""
    )


def test_carets_stand_under_the_mistake_also_behind_tabs():
    assert report("+!g\n\t<-\t.print(a) b.\n").splitlines()[1:3] == [
        "  2 | \t<-\t.print(a) b.",
        "    | \t  \t          ^",
    ]


@pytest.mark.parametrize(
    ("text", "line", "message", "help"),
    [
        (
            "+!g\n<- X = else.",
            2,
            "'else' is a reserved word and cannot be used here",
            "as an atom it is written",
        ),
        ("\ngröße(3).", 2, "'größe' holds the letter 'ö'; names are made of", "rename it, or put it between"),
        (
            "+!g <- X = [1,2).",
            1,
            "'[' is closed by ')'",
            "it was opened at line 1, column 12; close it with ']'",
        ),
        (
            "+!g <- .print(a;\n .print(b).",
            1,
            "'(' is not closed: ')' is expected before ';'",
            "it was opened",
        ),
        ("+!g <- for (x) { a; b .", 1, "'{' is not closed: '}' is expected before '.'", "it was opened"),
        ("p(1)\nq(2).", 2, "the belief before has no final '.'; the next belief begins here", "put a '.'"),
        ("!g\n!h.", 2, "the goal before has no final '.'; a goal begins here", "put a '.' behind line 1"),
        ("+!g <- a; b", 1, "the plan has no final '.'", "the file ends here"),
        ("start <- .print(a).", 1, "a plan begins with its trigger", "put +! before it"),
        ("+!g :- a.", 1, "':-' belongs to rules", "a plan is written +!goal : condition <- steps."),
        ("+!g <- a, b.", 1, "steps are separated by ';', not by ','", None),
        ("+!g : a, b <- c.", 1, "conditions are not joined by ','", "write & for 'and'"),
        ("p(1), q(2).", 1, "a belief ends with '.', not with ','", "write p(1). p(2)."),
        ("+!g : a && b.", 1, "there is no '&&'", "'and' is &, 'or' is |"),
        ("+!g : a || b.", 1, "there is no '||'", "'and' is &, 'or' is |"),
        ("+!g : X != 1.", 1, "there is no '!='", r"'not equal' is written \=="),
        ("+!g : X =< 1.", 1, "there is no '=<'", "write <="),
        (r"+!g : X \= 1.", 1, r"'\' does not begin anything", r"'not equal' is written \=="),
        ("+!g : 1 < X < 5.", 1, "relations cannot be chained", "join two of them with &"),
        ("r(X) :- p(X) & !.", 1, "there is no cut", "a plan takes the first solution"),
        ("r(X) :- p(X); q(X).", 1, "conditions are not joined by ';'", "'or' is written |"),
        ("+!g(X) <- X++; a.", 1, "there is no '++' behind a variable", "a variable keeps its value"),
        ("+!g : X ~= 1 <- a.", 1, "there is no '~='", r"'not equal' is written \=="),
        ("+!g <- X is Y + 1.", 1, "there is no 'is'", "a variable gets its value by ="),
        ("# a comment\np.", 1, "the character '#' does not belong", "a comment begins with //"),
        ("+!g : .", 1, "the context behind ':' is missing", None),
        ("+!g <- a <- b.", 1, "a plan has only one '<-'", "is the final '.'"),
        ("+!g <- +!h.", 1, "'+!' begins a plan and is no step of a body", "a goal is posted by !g"),
        ("+!g <- if (a) { b } else if (c) { d }.", 1, "'else if' is written elif", "elif (condition)"),
        (
            "+!g <- if (a) { b }; else { c }.",
            1,
            "'else' without an 'if' before it",
            "'if' and 'else' are not",
        ),
        ("+!g <- while x { b }.", 1, "'(' and the condition of 'while' is expected, not 'x'", None),
        ("+!g <- a; ; b.", 1, "there is no step between the two ';'", None),
        ("+!g <- for (X in [1]) { p }.", 1, "there is no 'in'", "an element of a list is found by .member"),
        (
            "+!g <- if x > 3 { p }.",
            1,
            "'(' and the condition of 'if' is expected",
            "if (condition) { steps }",
        ),
        ("+!g : not p(1)\n  .print(q).", 2, "'<-' is expected before '.print'", "the steps of a plan stand"),
        (
            "+!g <- if (p) { q else { r }.",
            1,
            "'}' is missing before 'else'",
            "the block before it was opened at line 1, column 15",
        ),
        ("def go(): pass", 1, "'def' is a word of Python", "this is an agent program"),
        ("+!g <- X = foo + 1.", 1, "'+' needs numbers", "a belief gives its value through a variable"),
        ('+!g <- X = "a" + "b".', 1, "'+' needs numbers", "strings and lists are joined by .concat"),
        ("+!g <- X = math.flor(1) + 1.", 1, "'math.flor' with 1 arguments is not a function", "did you mean"),
        ("+!g <- .print(a)[b].", 1, "'.print' is an internal action, which cannot have annotations", None),
        (
            "+!g : .foreach(p,{a}) <- c.",
            1,
            "'.foreach' acts and cannot stand in a context",
            "do it in the body",
        ),
        (".print(a).", 1, "'.print' cannot stand outside a plan", "is it a step of the plan before"),
        ("!!g.", 1, "an initial goal has one '!'", "write !goal."),
        ("p(a).q(b).", 1, "'.q' is read as one word", "put a blank or a line end after the final"),
        ("@X +!g.", 1, "a label is an atom, with annotations if need be", "as in @stop[atomic]"),
        ("/* never closed\n p.", 1, "the comment is not closed", "end it with */"),
        ("+!g <- a. }", 1, "a belief, a goal or a plan is expected, not '}'", None),
        ("+!g <- a }.", 1, "nothing is open that this '}' closes", None),
        ("p(#).", 1, "the character '#' does not belong to the language", None),
        ("[a].", 1, "a belief, a goal or a plan is expected, not '['", None),
        ("X.", 1, "a belief is a literal", None),
        ("p([a|b]).", 1, "the tail of a list is a variable or a list", "as in [H|T]"),
        ("p[a|b].", 1, "the tail of annotations is a variable", "as in"),
    ],
)
def test_common_mistakes(text: str, line: int, message: str, help: str | None):
    first = errors(text)[0]
    assert first.span is not None
    assert first.span.line == line
    assert first.message.startswith(message)
    if help is not None:
        assert first.help is not None
        assert first.help.startswith(help)


def test_a_context_refuses_an_internal_action_that_is_declared_to_act():
    actions = {
        ".tell": Declaration(body_only=True),
        ".look": Declaration(),
        "my.run": Declaration(body_only=True),
    }
    with pytest.raises(AslError) as refused:
        load_program("robot.asl", "+!g : .look & not .tell(a) & my.run <- c.", actions=actions)
    (wrong,) = refused.value.diagnostics
    assert wrong.message == "'.tell' acts and cannot stand in a context"


def test_one_mistake_gives_one_error():
    for text in (
        "+!a <- foo(.\n+!b <- c.",
        "p(q(1, 2.\nr(3).",
        '+!g <- .print("a); b.\n+!h <- c.',
        "+!g <- x(1))).\n+!h <- c.",
        "gröse(3).",
        "+!g <- if (a { b } else { c }; d.\n+!h.",
        "+!g <- a. { +!i <- b( . +!j <- c. }\n+!h.",
        "+!g(X : a <- b.\n+!h.",
        "+!g <- X = { +!i <- ( }; a.\n+!h.",
    ):
        assert len(places(text)) == 1, text


def test_the_rest_of_the_file_is_read_behind_every_error():
    text = "".join(f"+!g{number} <- a(;{' b' * (number % 3)}.\n" for number in range(40))
    assert sorted({line for line, _ in places(text)}) == list(range(1, 41))


def test_two_plans_with_one_label_are_an_error_that_names_both():
    (error,) = errors("@one +!a.\n@two +!b.\n\n@one +!c.")
    assert error.span is not None
    assert error.span.line == 4
    assert error.message == "two different plans have one label, @one; the first one is at line 1"


def test_two_plans_with_one_label_in_two_files_are_an_error_that_names_both():
    (error,) = errors('@one +!a.\n{ include("x.asl") }', {"x.asl": "\n@one +!b."})
    assert error.place() == "x.asl:2:2: "
    assert error.message.endswith("the first one is at main.asl, line 1")


def test_labels_of_subplans_are_apart_from_those_of_the_program():
    load_program("x", "@one +!a. { @one +e. @two +f. } @two +!b.")
    assert len(errors("@one +!a. { @two +e. @two +f. }")) == 1


@pytest.mark.parametrize(
    ("text", "plain", "message"),
    [
        ("+!g :\n <- a.", "+!g <- a.", "the context behind ':' is missing"),
        ("+!g <- !h().", "+!g <- !h.", "the brackets are empty"),
    ],
)
def test_ways_of_writing_in_the_thesis_are_errors_in_other_programs(text: str, plain: str, message: str):
    old = '+!make <- makeArtifact("m", "jason.architecture.ArtCmdVel"). '
    program, (warning,) = load_program("x", old + text)
    assert (warning.severity, warning.message) == ("warning", message)
    assert program.plans == load_program("x", old + plain)[0].plans
    assert [diagnostic.message for diagnostic in errors(text)] == [message]


def test_warnings_come_with_the_errors_in_the_order_of_the_text():
    found = errors("+!g <- not a.\n+!h <- b(.\n+!i <- not c.")
    assert [diagnostic.severity for diagnostic in found] == ["warning", "error", "warning"]


def test_every_statement_of_a_plan_is_read_although_others_are_wrong():
    text = """\
Corner(1,2).
+!a : x && y <- foo(; .print("abc); bar;
   !b; Foo(1).
+!b : nto c <- whlie (x) { a; b(] }; X := 3; Y is X + 1; Z mdo 2.
+!c <- if (x) then { a }; X += 1; c d; if (y) { a(; b(; c }; e.
+!d(X : y <- a( ; b.
+!e <- if (a) { .print("x; };
   b( ; c }.
"""
    assert [(each.span.line, each.code) for each in errors(text) if each.span is not None] == [
        (1, "upper-case-functor"),
        (2, "wrong-operator"),
        (2, "unexpected-token"),
        (2, "unclosed-string"),
        (3, "upper-case-functor"),
        (4, "misspelt-word"),
        (4, "misspelt-word"),
        (4, "wrong-operator"),
        (4, "foreign-word"),
        (4, "misspelt-word"),
        (5, "foreign-word"),
        (5, "wrong-operator"),
        (5, "missing-semicolon"),
        (5, "unexpected-token"),
        (5, "unexpected-token"),
        (6, "unclosed-bracket"),
        (6, "unexpected-token"),
        (7, "unclosed-string"),
        (8, "unexpected-token"),
    ]


def test_a_sum_has_a_limit_that_a_run_can_bear():
    (wrong,) = errors(f"p({'+'.join(['1'] * 252)}). q.")
    assert wrong.code == "nested-too-deeply"
    (wrong,) = errors(f"p({'**'.join(['1'] * 200)}). q.")
    assert wrong.code == "nested-too-deeply"
