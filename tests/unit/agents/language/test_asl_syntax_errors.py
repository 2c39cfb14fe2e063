"""What people see when a program is wrong: place, excerpt, help, and all errors at once."""

from textwrap import dedent

import pytest
from asl_lab import errors, places

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import Declaration


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
        robot.asl:3:1: error: plan without a final `.` before the next plan
          3 | +!other <- .print(b).
            | ^
          = help: put a `.` at the end of line 2"""
    )


def test_all_errors_of_a_file_are_reported_in_one_pass_in_order():
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
        robot.asl:2:1: error: unclosed `(`: expected `)`, found `!`
          1 | battery(60
            |        ^
          2 | !patrol.
            | ^
          = help: close it with `)`; it was opened at line 1, column 8

        robot.asl:3:23: error: second context of a plan
          3 | +!patrol : battery(B) : B > 20
            |                       ^
          = help: join the conditions with `&`

        robot.asl:5:7: error: missing `;` before this step
          5 |       .print("here);
            |       ^^^^^^
          = help: separate steps with `;` and end the last one with `.`

        robot.asl:5:14: error: unterminated string
          5 |       .print("here);
            |              ^^^^^^^
          = help: close it on the same line: "text"; write a line break as `\\n`

        robot.asl:7:9: error: missing body after `<-`
          7 | +!go(R) <- .
            |         ^^
          = help: write the steps, or remove `<-` if there is nothing to do

        robot.asl:8:10: error: unknown operator `->`
          8 | +!charge -> dock.
            |          ^
          = help: begin the body of a plan with `<-`"""
    )


def test_carets_are_below_the_error_even_after_tabs():
    assert report("+!g\n\t<-\t.print(a) b.\n").splitlines()[1:3] == [
        "  2 | \t<-\t.print(a) b.",
        "    | \t  \t          ^",
    ]


COMMON_MISTAKES = r"""
+!g⏎<- X = else. => 2: reserved word `else` used as a name => quote it as an atom
⏎größe(3). => 2: name `größe` contains the letter `ö`; names consist of => rename it, or quote it
+!g <- X = [1,2). => 1: `[` is closed by `)` => close it with `]`; it was opened at line 1, column 12
+!g <- .print(a;⏎ .print(b). => 1: unclosed `(`: expected `)`, found `;` => close it with `)`; it was opened at
+!g <- for (x) { a; b . => 1: unclosed `{`: expected `}`, found `.` => close it with `}`; it was opened at
p(1)⏎q(2). => 2: belief without a final `.` before the next belief => put a `.`
!g⏎!h. => 2: goal without a final `.` before a goal => put a `.` at the end of line 1
+!g <- a; b => 1: plan without a final `.` => put a `.` at the end of the file
start <- .print(a). => 1: expected the trigger of a plan => write a plan as `+!goal
+!g :- a. => 1: unexpected `:-` in a plan => write a plan as `+!goal : condition <- steps.`
+!g <- a, b. => 1: expected `;` between steps, found `,`
+!g : a, b <- c. => 1: expected `&` between conditions, found `,` => write `&` for 'and'
p(1), q(2). => 1: expected `.` after a belief, found `,` => write `p(1). p(2).`
+!g : a && b. => 1: unknown operator `&&` => write one `&` for 'and', one `|` for 'or'
+!g : a || b. => 1: unknown operator `||` => write one `&` for 'and', one `|` for 'or'
+!g : X != 1. => 1: unknown operator `!=` => write `\==` for 'not equal'
+!g : X =< 1. => 1: unknown operator `=<` => write `<=`
+!g : X \= 1. => 1: unexpected `\` => write `\==` for 'not equal'
+!g : 1 < X < 5. => 1: relations cannot be chained => join two of them with `&`
r(X) :- p(X) & !. => 1: unknown operator `!` (cut) => a plan takes the first solution
r(X) :- p(X); q(X). => 1: expected `&` or `|` between conditions, found `;` => write `|` for 'or'
+!g(X) <- X++; a. => 1: unknown operator `++` => variables keep their value
+!g : X ~= 1 <- a. => 1: unknown operator `~=` => write `\==` for 'not equal'
+!g <- X is Y + 1. => 1: unknown keyword `is` => bind a variable with `=`
# a comment⏎p. => 1: unexpected character '#' => begin comments with `//`
+!g : . => 1: missing context after `:`
+!g <- a <- b. => 1: second `<-` in a plan => if this is a new plan
+!g <- +!h. => 1: expected a step, found the trigger `+!` => post a goal with `!g`
+!g <- if (a) { b } else if (c) { d }. => 1: write `elif` for `else if` => elif (condition)
+!g <- if (a) { b }; else { c }. => 1: `else` without `if` => remove the `;`
+!g <- while x { b }. => 1: expected `(` and the condition of `while`, found `x`
+!g <- a; ; b. => 1: empty step between two `;`
+!g <- for (X in [1]) { p }. => 1: unknown keyword `in` => find elements of a list with `.member`
+!g <- if x > 3 { p }. => 1: expected `(` and the condition of `if`, found `x` => write `if (condition) { steps }`
+!g : not p(1)⏎  .print(q). => 2: expected `<-`, found `.print` => write `<-` before the steps
+!g <- if (p) { q else { r }. => 1: missing `}` before `else` => close the block that was opened at line 1, column 15
!start <- .print("hi"). => 1: `!start` is a goal, not the trigger of a plan => write `+!start`
p. !start(1) : p <- q. => 1: `!start` is a goal, not the trigger of a plan => write `+!start`
+!g <- .print(f"at {X}"). => 1: strings have no prefix such as `f` in Python => write values between strings
def go(): pass => 1: Python keyword `def` in an agent program => this is an agent program
+!g <- X = foo + 1. => 1: operand of `+` is not a number => ask for the value first
+!g <- X = "a" + "b". => 1: operand of `+` is not a number => join strings and lists with `.concat
+!g <- X = math.flor(1) + 1. => 1: unknown function `math.flor/1` => did you mean
+!g <- .print(a)[b]. => 1: internal action `.print` cannot have annotations
+!g : .foreach(p,{a}) <- c. => 1: internal action `.foreach` acts and cannot be in a context => move it into the body
.print(a). => 1: internal action `.print` outside a plan => if it is a step of the plan before
!!g. => 1: expected one `!` before an initial goal => write `!goal.`
p(a).q(b). => 1: `.q` is read as one word => put a blank or a line end after the final
@X +!g. => 1: expected an atom as label, optionally with annotations => write `@stop[atomic]
@p[x(1 div 0)] +!g. => 1: cannot evaluate the annotations of a label: integer division by zero => write
/* never closed⏎ p. => 1: unterminated comment => end it with `*/`
+!g <- a. } => 1: expected a belief, a goal or a plan, found `}`
+!g <- a }. => 1: unmatched `}`
p(#). => 1: unexpected character '#'
[a]. => 1: expected a belief, a goal or a plan, found `[`
X. => 1: expected a literal as belief
p([a|b]). => 1: expected a variable or a list as the tail of a list => write `[H|T]`
p[a|b]. => 1: expected a variable as the tail of annotations => write `p(X)
"""


@pytest.mark.parametrize("case", COMMON_MISTAKES.strip().splitlines())
def test_common_mistakes(case):
    text, told, *help = case.split(" => ")
    first = errors(text.replace("\N{RETURN SYMBOL}", "\n"))[0]
    assert first.span is not None
    assert f"{first.span.line}: {first.message}".startswith(told)
    assert (first.help or "").startswith("".join(help))


def test_a_context_refuses_an_internal_action_that_is_declared_to_act():
    actions = {
        ".tell": Declaration(body_only=True),
        ".look": Declaration(),
        "my.run": Declaration(body_only=True),
    }
    with pytest.raises(AslError) as refused:
        load_program("robot.asl", "+!g : .look & not .tell(a) & my.run <- c.", actions=actions)
    (wrong,) = refused.value.diagnostics
    assert wrong.message == "internal action `.tell` acts and cannot be in a context"


def test_one_mistake_gives_one_error_and_parsing_continues():
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
    text = "".join(f"+!g{number} <- a(;{' b' * (number % 3)}.\n" for number in range(40))
    assert sorted({line for line, _ in places(text)}) == list(range(1, 41))
    found = errors("+!g <- not a.\n+!h <- b(.\n+!i <- not c.")
    assert [diagnostic.severity for diagnostic in found] == ["warning", "error", "warning"]
    (wrong,) = errors(f"p({'+'.join(['1'] * 252)}). q.")
    assert wrong.code == "nested-too-deeply"
    (wrong,) = errors(f"p({'**'.join(['1'] * 200)}). q.")
    assert wrong.code == "nested-too-deeply"


def test_two_plans_with_one_label_are_an_error_that_names_both():
    (error,) = errors("@one +!a.\n@two +!b.\n\n@one +!c.")
    assert error.span is not None
    assert error.span.line == 4
    assert error.message == "two different plans have the label `@one`; the first one is at line 1"
    (error,) = errors('@one +!a.\n{ include("x.asl") }', {"x.asl": "\n@one +!b."})
    assert error.place() == "x.asl:2:2: "
    assert error.message.endswith("the first one is at main.asl, line 1")
    load_program("x", "@one +!a. { @one +e. @two +f. } @two +!b.")
    assert len(errors("@one +!a. { @two +e. @two +f. }")) == 1


@pytest.mark.parametrize(
    ("text", "plain", "message"),
    [
        ("+!g :\n <- a.", "+!g <- a.", "missing context after `:`"),
        ("+!g <- !h().", "+!g <- !h.", "empty brackets"),
    ],
)
def test_ways_of_writing_in_the_thesis_are_errors_in_other_programs(text, plain, message):
    old = '+!make <- makeArtifact("m", "jason.architecture.ArtCmdVel"). '
    program, (warning,) = load_program("x", old + text)
    assert (warning.severity, warning.message) == ("warning", message)
    assert program.plans == load_program("x", old + plain)[0].plans
    assert [diagnostic.message for diagnostic in errors(text)] == [message]


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
