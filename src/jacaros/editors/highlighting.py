"""Pygments' lexers of AgentSpeak programs and project files.

They are entry points of the package, so everything that highlights with Pygments knows the languages: the site of the
documentation, notebooks, `rich`. Pygments comes with `rich`; nothing in the package imports this module.
"""

from typing import ClassVar

from pygments.lexer import RegexLexer, bygroups, include
from pygments.token import Comment, Keyword, Name, Number, Operator, Punctuation, String, Whitespace

__all__ = ["AgentSpeakLexer", "ProjectLexer"]

_NAME = r"[^\W\dA-Z_]\w*"
_PREFIX = r"(?:[\w.]*::)?~?"
"""A namespace and a strong negation, both optional."""

_COMMON = [
    (r"\s+", Whitespace),
    (r"//.*", Comment.Single),
    (r"/\*(?:.|\n)*?\*/", Comment.Multiline),
    (r'"(?:\\.|[^"\\\n])*"', String.Double),
    (r"'(?:\\.|[^'\\\n])*'", String.Symbol),
    (r"(?:\d+|\d*\.\d+)(?:[eE][+-]?\d+)?", Number),
]


class AgentSpeakLexer(RegexLexer):  # type: ignore[misc]
    """Highlights agent programs: goals, plans, actions of the agent itself, variables and directives."""

    name = "AgentSpeak"
    aliases: ClassVar = ["agentspeak", "asl"]
    filenames: ClassVar = ["*.asl"]
    mimetypes: ClassVar = ["text/x-agentspeak"]
    tokens: ClassVar = {
        "root": [
            include("common"),
            (
                r"(\{)(\s*)(begin|end|include|namespace|offer|register_function)\b",
                bygroups(Punctuation, Whitespace, Keyword.Namespace),
            ),
            (rf"@{_PREFIX}(?:{_NAME})?", Name.Decorator),
            (rf"([+\-^]?(?:!!|!|\?))(\s*)({_PREFIX}{_NAME})", bygroups(Operator, Whitespace, Name.Function)),
            (r"(?:if|elif|else|while|for)(?=\s*[({])", Keyword),
            (r"(?:not|div|mod)\b", Operator.Word),
            (r"(?:true|false)\b", Keyword.Constant),
            (rf"(?:{_NAME})?(?:\.{_NAME})+", Name.Builtin),
            (r"[\w.]*::", Name.Namespace),
            (r"[A-Z_]\w*", Name.Variable),
            (_NAME, Name),
            (r"<-|:-|<:|\|&\||\|\|\||=\.\.|\\==|[-+*/<>=&|:~!?^]+", Operator),
            (r"[()\[\]{},;.]", Punctuation),
        ],
        "common": _COMMON,
    }


class ProjectLexer(RegexLexer):  # type: ignore[misc]
    """Highlights project files, JaCaMo's and Jason's: what they declare, and the keys of each."""

    name = "JaCaMo project"
    aliases: ClassVar = ["jcm", "mas2j"]
    filenames: ClassVar = ["*.jcm", "*.mas2j"]
    mimetypes: ClassVar = ["text/x-jacamo-project"]
    tokens: ClassVar = {
        "root": [
            include("common"),
            (
                r"(mas|agent|workspace|artifact|node|organisation|institution)(\s+)([\w.]+)",
                bygroups(Keyword.Declaration, Whitespace, Name.Class),
            ),
            (r"(MAS)(\s+)(\w+)", bygroups(Keyword.Declaration, Whitespace, Name.Class)),
            (r"(?:uses|at)\b", Keyword),
            (
                r"(?<=[{\n\t ])([a-zA-Z][\w-]*)(\s*)(:)(?!:)",
                bygroups(Name.Attribute, Whitespace, Punctuation),
            ),
            (r"[A-Z_]\w*", Name.Variable),
            (r"[\w.-]+", Name),
            (r"::|[#~@*]", Operator),
            (r"[()\[\]{},;:=|<>/+&!?-]", Punctuation),
        ],
        "common": _COMMON,
    }
