"""The written grammar and the parser describe the same language."""

from importlib import resources
from itertools import count, pairwise
from pathlib import Path
from random import Random

import pytest
from ebnf import Recogniser, read, written

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import CLOSERS, ProgramNames
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.agents.language.lexer import Token, tokenize
from jacaros.agents.language.program_parser import ProgramParser
from jacaros.agents.terms.functions import ARITIES

GRAMMAR = read(
    resources.files("jacaros.agents.language").joinpath("grammar.ebnf").read_text(encoding="utf-8")
)
RECOGNISER = Recogniser(GRAMMAR, "program")
TEXTS = {
    "name": ("p", "q", "'r s'"),
    "dotted": ("my.act", ".print"),
    "function": ("math.max",),
    "constant": ("math.pi",),
    "variable": ("X", "Y", "_"),
    "number": ("1", "0.5"),
    "string": ('"s"',),
}
CLASSES = {text: {kind} for kind, texts in TEXTS.items() for text in texts}
CLASSES["math.max"] |= {"dotted"}
CLASSES["math.pi"] |= {"dotted"}
MEANING = {"tested-action", "chained-relation"}
"""Errors of what a text means: an action as a test goal, a comparison of a comparison in brackets."""
INSIDE_TOKENS = {"non-ascii-name", "wrong-escape"}
CHANGES = {"-+", "++", "--", "+<", "+>"}
TRIGGERS = {"+", "-", "^", "@"}
BEFORE_STEPS = {"<-", ";", "{", "}", "(", "|&|", "|||"}
FRAGILE = CHANGES | {"begin", "end"}
"""Tokens that are others in other places."""


class AnyDirective:
    """Accepts all directives."""

    def apply(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Do nothing."""

    def apply_to_block(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Read the block."""
        parser.block(directive)


def errors(tokens: list[str]) -> set[str]:
    """The codes of the parser's errors."""
    found: list[Diagnostic] = []
    names = ProgramNames(count(), count(), count())
    ProgramParser(SourceFile("a.asl", " ".join(tokens)), names, found, AnyDirective()).file_clauses()
    return {each.code for each in found if each.severity == "error"}


def belongs(tokens: list[str]) -> bool:
    """Whether the grammar has the program."""
    return RECOGNISER.accepts([{token} | CLASSES.get(token, set()) for token in tokens])


def program(random: Random, room: int) -> list[str]:
    """A random program of the grammar."""
    clauses = [written(GRAMMAR, random, "clause", room) for _ in range(random.randrange(1, 3))]
    return [random.choice(TEXTS.get(each, (each,))) for clause in clauses for each in clause]


def is_told_in_words(tokens: list[str]) -> bool:
    """Whether the grammar says in words what the parser does with a text: see its comments."""
    for place, (one, two) in enumerate(pairwise(tokens)):
        if one in ("}", ";") and two == "{" and "".join(tokens[place + 2 : place + 3]) in TRIGGERS:
            return True  # sub-plans where a step may follow
        if one in BEFORE_STEPS and two == "(" and behind(tokens, place + 1) in ("+", "-"):
            return True  # a group of steps, or not
    return False


def behind(tokens: list[str], place: int) -> str:
    """The token behind the bracket that closes the one at *place*."""
    depth = 0
    for at in range(place, len(tokens)):
        depth += (tokens[at] in CLOSERS) - (tokens[at] in CLOSERS.values())
        if not depth:
            return tokens[at + 1] if at + 1 < len(tokens) else ""
    return ""


def mutant(random: Random, tokens: list[str]) -> list[str]:
    """A text with a token less, or twice, or with two neighbours swapped."""
    place = random.randrange(len(tokens))
    kind = random.choice(("drop", "double", "swap"))
    if FRAGILE.intersection(tokens[max(0, place - 1) : place + 3]):
        return tokens
    if kind == "drop":
        return tokens[:place] + tokens[place + 1 :]
    if kind == "double":
        return [*tokens[: place + 1], *tokens[place:]]
    return [*tokens[:place], *tokens[place : place + 2][::-1], *tokens[place + 2 :]]


@pytest.mark.parametrize("seed", range(20))
def test_the_parser_accepts_every_program_of_the_grammar(seed: int) -> None:
    random = Random(seed)
    for _ in range(50):
        tokens = program(random, random.randrange(10, 120))
        found = errors(tokens)
        assert not found - MEANING or is_told_in_words(tokens), (found, " ".join(tokens))


@pytest.mark.parametrize("seed", range(10))
def test_a_changed_program_belongs_to_the_grammar_exactly_if_the_parser_accepts_it(seed: int) -> None:
    random = Random(seed)
    for _ in range(60):
        tokens = program(random, random.randrange(10, 60))
        changed = mutant(random, tokens)
        found = errors(changed)
        if not found & MEANING and not is_told_in_words(changed):
            assert belongs(changed) == (not found), (found, " ".join(changed))


ROOT = Path(__file__).parents[4]
RECORDED = sorted(
    path for folder in ("conformance", "../examples") for path in (ROOT / "tests" / folder).rglob("*.asl")
)


def terminals(tokens: list[Token]) -> list[set[str]]:
    """The terminals that each token matches; signs without blanks between them are one, where a step begins."""
    found: list[set[str]] = []
    before = Token("", "", 0, 0, True)
    for token in tokens:
        glued = token.line == before.line and token.column == before.end
        if glued and found and token.text in "+-<>" and "".join(found[-1]) + token.text in CHANGES:
            found[-1] = {"".join(found[-1]) + token.text}
        elif token.kind in ("atom", "variable", "number", "string"):
            found.append(classes(token))
        elif token.kind != "end":
            found.append({token.text})
        before = token
    return found


def classes(token: Token) -> set[str]:
    """The terminals that a token other than a sign matches."""
    if token.kind != "atom":
        return {token.kind}
    if "." not in token.text or token.text[0] == "'":
        return {"name", token.text}
    fewest, most = ARITIES.get(token.text, (1, 0))
    return {"dotted"} | ({"constant"} if fewest == 0 else set()) | ({"function"} if most > 0 else set())


@pytest.mark.parametrize("path", RECORDED, ids=lambda path: path.stem)
def test_recorded_programs_belong_to_the_grammar(path: Path) -> None:
    found: list[Diagnostic] = []
    file = SourceFile(str(path), path.read_text(encoding="utf-8"))
    ProgramParser(file, ProgramNames(count(), count(), count()), found, AnyDirective()).file_clauses()
    tokens = tokenize(file, found.append)
    codes = {each.code for each in found if each.severity == "error"}
    if not codes & (MEANING | INSIDE_TOKENS):
        assert RECOGNISER.accepts(terminals(tokens)) == (not codes)
