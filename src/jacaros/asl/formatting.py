"""Format programs in the project's one style (`jacaros format`).

>>> print(format_program("robot.asl", "+!go:near<-move;!stop."), end="")
+!go : near <- move; !stop.
"""

from collections.abc import Mapping
from typing import Final

from jacaros.asl import nodes
from jacaros.asl.declaration import Declaration
from jacaros.asl.diagnostics import AslError, problem
from jacaros.asl.layout.clauses import ProgramLayout
from jacaros.asl.layout.document import render
from jacaros.asl.layout.expressions import pieces_of
from jacaros.asl.lexer import Comment, tokenize
from jacaros.asl.loader import load_program
from jacaros.asl.source import SourceFile
from jacaros.errors import InternalError

_MOST_ROUNDS: Final = 4


def format_program(name: str, text: str, actions: Mapping[str, Declaration] | None = None) -> str:
    """Format the program *text*; tokens and comments are kept.

    Included files are not read.

    Args:
        name: the file name in diagnostics.
        text: the AgentSpeak source.
        actions: the internal actions, as for `load_program`.

    Raises:
        AslError: the program has errors.
        InternalError: formatting would change the meaning of the program.
    """
    meaning = _meaning(name, text, actions)
    try:
        result = _laid_out(text)
        for _ in range(_MOST_ROUNDS):
            # A comment that has moved to the end of another line may have to move once more.
            again = _laid_out(result)
            if again == result:
                break
            result = again
    except RecursionError:
        wrong = problem("nested-too-deeply", f"{name} is nested too deeply to be formatted", None)
        raise AslError([wrong]) from None
    if _substance(result) != _substance(text) or _meaning(name, result, actions) != meaning:
        raise InternalError(f"formatting would change the meaning of {name}")
    return result


def _laid_out(text: str) -> str:
    return render(ProgramLayout(pieces_of(SourceFile("", text))).program())


def _meaning(name: str, text: str, actions: Mapping[str, Declaration] | None) -> nodes.Program:
    return load_program(name, text, lambda path, _: (f"{path} in {name}", ""), actions=actions)[0]


def _substance(text: str) -> tuple[list[tuple[str, str]], list[str]]:
    """Return the tokens of a text, and the sorted words of its comments: formatting may join two comments."""
    comments: list[Comment] = []
    tokens = tokenize(SourceFile("", text), lambda _: None, comments)
    words = sorted(word for comment in comments for word in comment.text.split())
    return [(token.kind, token.text) for token in tokens], words
