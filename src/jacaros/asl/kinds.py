"""The kinds of problems that are told: code, level and meaning of each.

The level is the usual one: what the thesis writes and Jason refuses is only a warning in programs of the thesis.
"""

from typing import Final, NamedTuple

from jacaros.asl.diagnostics import Severity


class Kind(NamedTuple):
    """A kind of problem, as a list of rules shows it."""

    level: Severity
    meaning: str


KINDS: Final[dict[str, Kind]] = {
    "acting-condition": Kind("warning", "an internal action that acts or waits is asked whether it holds"),
    "action-in-context": Kind("error", "an internal action that acts or waits stands in a context"),
    "annotated-action": Kind("error", "an internal action has annotations"),
    "capital-constant": Kind("warning", "True, False or None are variables here"),
    "chained-relation": Kind("error", "two relations without an operator between them"),
    "changed-variable": Kind("warning", "a variable cannot get another value"),
    "comparison-without-value": Kind("warning", "a variable without a value is compared by =="),
    "condition-as-step": Kind("warning", "a condition stands where an action is expected"),
    "context-never-true": Kind("warning", "the condition of a plan contradicts itself"),
    "duplicate-label": Kind("error", "two different plans have one label"),
    "else-if": Kind("error", "'else if' is written elif"),
    "else-without-if": Kind("error", "'else' or 'elif' without an 'if' before it"),
    "empty-brackets": Kind("error", "round brackets with nothing in them"),
    "empty-clause": Kind("error", "a '.' or ';' with nothing before it"),
    "empty-step": Kind("error", "no step where one is expected"),
    "end-without-begin": Kind("error", "{ end } without a { begin ... }"),
    "foreign-word": Kind("error", "a word of another language"),
    "formula-in-list": Kind("error", "a relation or another formula as an element of a list"),
    "include-circle": Kind("error", "files that include each other"),
    "include-not-found": Kind("error", "an included file that is not there"),
    "java-function": Kind("warning", "a function that is written in Java"),
    "mismatched-bracket": Kind("error", "a bracket is closed by another kind of bracket"),
    "misplaced-action": Kind("error", "an internal action outside of plans"),
    "missing-blank": Kind("error", "a final '.' that is read as part of the next word"),
    "missing-block": Kind("error", "a statement without its braces"),
    "missing-body": Kind("error", "no steps behind '<-'"),
    "missing-condition": Kind("error", "a statement without its condition in brackets"),
    "missing-context": Kind("error", "no condition behind ':'"),
    "missing-dot": Kind("error", "a clause without its final '.'"),
    "missing-semicolon": Kind("error", "two steps without ';' between them"),
    "missing-trigger": Kind("error", "a plan without its trigger"),
    "misspelt-annotation": Kind("warning", "an annotation of a label that is nearly one with a meaning"),
    "misspelt-belief": Kind("warning", "a belief that nobody makes, and nearly one that somebody makes"),
    "misspelt-word": Kind("error", "nearly a reserved word"),
    "narrow-handler": Kind("note", "plans for a failure that all have conditions"),
    "nested-too-deeply": Kind("error", "too many brackets in each other"),
    "no-effect": Kind("warning", "something in a project file that has no effect here"),
    "non-ascii-name": Kind("error", "a name with other letters than a to z"),
    "not-imported": Kind("note", "names that only running the Python code of the project can tell"),
    "not-a-belief": Kind("error", "a clause that is neither belief, rule, goal nor plan"),
    "not-a-number": Kind("error", "arithmetic with something that is no number"),
    "not-a-step": Kind("error", "a term where a step is expected"),
    "organisation-library": Kind("warning", "a library for organisations, which are not supported"),
    "plan-never-selected": Kind("warning", "a plan behind one that is always taken before it"),
    "prefixed-action": Kind("error", "an internal action with '~' or a namespace"),
    "reserved-word": Kind("error", "a reserved word as a name"),
    "second-body": Kind("error", "a plan with two '<-'"),
    "second-context": Kind("error", "a plan with two contexts"),
    "singleton-variable": Kind("warning", "a variable that occurs only once"),
    "tested-action": Kind("error", "an internal action behind '?'"),
    "trigger-in-body": Kind("error", "'+!', '-!' or '+?' as a step"),
    "too-many": Kind("warning", "how many more problems a file has; only the first 100 are printed"),
    "unclosed-block": Kind("error", "a { begin ... } without { end }"),
    "unclosed-bracket": Kind("error", "a bracket that is not closed"),
    "unclosed-comment": Kind("error", "a comment without its end"),
    "unclosed-string": Kind("error", "a string or quoted atom without its end"),
    "unexpected-end": Kind("error", "the file ends too early"),
    "unexpected-token": Kind("error", "something else is expected here"),
    "unknown-artifact-type": Kind("warning", "a type of artifacts that there is not"),
    "unknown-character": Kind("error", "a character that does not belong to the language"),
    "unknown-code": Kind("warning", "a comment ignores a code that there is not"),
    "unknown-directive": Kind("error", "a directive that there is not"),
    "unknown-goal": Kind("warning", "a goal that no plan is for"),
    "unknown-internal-action": Kind("warning", "an internal action that there is not"),
    "unknown-library": Kind("warning", "a library of another system that is not known here"),
    "unknown-message-type": Kind("warning", "a message type that only the robot's middleware may know"),
    "unknown-operation": Kind("warning", "an action that no artifact of the project offers"),
    "unknown-performative": Kind("warning", "nearly a performative"),
    "unopened-bracket": Kind("error", "a closing bracket without an opening one"),
    "unreadable-file": Kind("error", "a file that is not there or no text"),
    "upper-case-functor": Kind("error", "a name with arguments that begins with an upper-case letter"),
    "wrong-arguments": Kind("warning", "an internal action with too few or too many arguments"),
    "wrong-belief-change": Kind("error", "a sign that does not change beliefs, or no belief behind it"),
    "wrong-directive": Kind("error", "a directive with wrong arguments"),
    "wrong-escape": Kind("error", "a backslash in a string before a character that it does not go with"),
    "wrong-goal": Kind("error", "something that cannot be a goal"),
    "wrong-label": Kind("error", "something that cannot be a label"),
    "wrong-mapping": Kind("error", "a mistake in a mapping file"),
    "wrong-operator": Kind("error", "an operator of another language"),
    "wrong-project": Kind("error", "a mistake in a project file"),
    "wrong-separator": Kind("error", "',' in place of another sign"),
    "wrong-tail": Kind("error", "the tail of a list or of annotations is no variable"),
    "wrong-trigger": Kind("error", "something that cannot trigger a plan"),
    "wrong-urgency": Kind("warning", "an urgency of a plan that is no whole number from 0 on"),
}
"""All kinds, by code.  docs/reference/diagnostics.md shows an example of each."""
