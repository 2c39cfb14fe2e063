"""The tree-sitter grammar accepts what the parser accepts, and little more."""

import ctypes
import hashlib
import random
import shutil
import subprocess
import warnings
from pathlib import Path

import pytest
from tree_sitter import Language, Node, Parser, Query, QueryCursor

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program

ROOT = Path(__file__).parents[2]
GRAMMAR = ROOT / "editors" / "tree-sitter-agentspeak"
PROGRAMS = sorted(
    path for folder in ("examples", "tests", "src", "benchmarks") for path in (ROOT / folder).rglob("*.asl")
)
ALLOWED = 0.05
"""Share of mutants that the grammar may accept although the parser does not, such as `a <-b` read as `a < -b`."""


@pytest.fixture(scope="module")
def language(tmp_path_factory: pytest.TempPathFactory) -> Language:
    library = tmp_path_factory.mktemp("parser") / "agentspeak.so"
    compiler = shutil.which("cc") or shutil.which("gcc")
    assert compiler is not None
    source = GRAMMAR / "src" / "parser.c"
    command = [compiler, "-O1", "-shared", "-fPIC", str(source), "-o", str(library)]
    subprocess.run(command, check=True)
    function = ctypes.CDLL(str(library)).tree_sitter_agentspeak
    function.restype = ctypes.c_void_p
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # an address is what ctypes can give
        return Language(function())


@pytest.fixture(scope="module")
def parser(language: Language) -> Parser:
    return Parser(language)


def is_accepted(path: Path, text: str) -> bool:
    """Return whether the parser of JaCaROS finds no error."""
    _, diagnostics = read_program(SourceFile(str(path), text), lambda name, _: (name, ""))
    return all(each.severity != "error" for each in diagnostics)


def has_error(parser: Parser, text: str) -> bool:
    return parser.parse(text.encode()).root_node.has_error


def test_the_parser_was_generated_from_this_grammar() -> None:
    recorded = (GRAMMAR / "src" / "grammar.sha256").read_text(encoding="utf-8").split()[0]
    assert hashlib.sha256((GRAMMAR / "grammar.js").read_bytes()).hexdigest() == recorded, (
        "generate the parser: npm run generate, in editors/tree-sitter-agentspeak"
    )


def test_programs_that_the_parser_accepts_have_no_error(parser: Parser) -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in PROGRAMS}
    accepted = {path: text for path, text in texts.items() if is_accepted(path, text)}
    assert len(accepted) > 500
    assert [path for path, text in accepted.items() if has_error(parser, text)] == []


def test_few_mutants_that_the_parser_rejects_are_accepted(parser: Parser) -> None:
    chosen = random.Random(1)
    texts = [path.read_text(encoding="utf-8") for path in PROGRAMS]
    texts = [text for text in texts if is_accepted(Path("program.asl"), text)]
    rejected = missed = 0
    for text in chosen.sample(texts, 300):
        at = chosen.randrange(len(text))
        mutant = text[:at] + chosen.choice(["", "(", ")", ".", ";", "<-", "}"]) + text[at + 1 :]
        if not is_accepted(Path("program.asl"), mutant):
            rejected += 1
            missed += not has_error(parser, mutant)
    assert rejected > 100
    assert missed <= ALLOWED * rejected


TREES = {
    "p(X)[source(S)].": "belief literal functor",
    "far :- near(X) & not X < 3.": "rule literal literal variable_term not binary variable_term number",
    "@stop[atomic] +!stop <- .print(a).": "plan label literal annotations trigger literal body action arguments",
    "+b(X) : X > -1 <- if (a) { !g } else { -b(X) }.": "if literal body goal body belief_change",
    "+!g <- (a; b) |&| !c.": "fork group literal literal goal",
    "{ begin namespace(m) } p. { end }": "block literal belief",
    "+!g <- !h. { +!h <- a. }": "plan sub_plans plan",
    "+!g : true <: done(G) <- work.": "boolean literal body",
    "p({ +!g : a <- b }, { h :- b }, [H|T]).": "braces plan braces rule list variable_term variable_term",
}


def kinds(node: Node) -> list[str]:
    return [node.type, *(kind for each in node.named_children for kind in kinds(each))]


@pytest.mark.parametrize("text", TREES)
def test_a_tree_has_the_expected_nodes(parser: Parser, text: str) -> None:
    root = parser.parse(text.encode()).root_node
    assert not root.has_error
    found = iter([*kinds(root), "functor"])
    assert [kind for kind in TREES[text].split() if kind not in found] == []


def test_highlights_name_goals_beliefs_and_actions(parser: Parser, language: Language) -> None:
    text = b"// why\n@l[atomic] +!move(X) : at(X) <- .print(X); go(X); !!rest."
    query = Query(language, (GRAMMAR / "queries" / "highlights.scm").read_text(encoding="utf-8"))
    captures = QueryCursor(query).captures(parser.parse(text).root_node)
    found = {name: {(each.text or b"").decode() for each in nodes} for name, nodes in captures.items()}
    assert found["comment"] == {"// why"}
    assert found["label"] == {"l"}
    assert found["attribute"] == {"atomic"}
    assert found["function"] == {"move"}
    assert found["function.builtin"] == {".print"}
    assert found["function.method.call"] == {"go"}
    assert found["function.call"] == {"rest"}
    assert "at" in found["property"]
    assert {"<-", "!!"} <= found["operator"]


def test_folds_can_be_compiled(language: Language) -> None:
    assert Query(language, (GRAMMAR / "queries" / "folds.scm").read_text(encoding="utf-8")).pattern_count
