"""What agents written in Python say and hear: Python values ↔ the contents of messages."""

from collections.abc import Callable
from typing import Any

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import fresh_names, lower
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import to_value
from jacaros.extension.literal import term_of
from jacaros.extension.views import Message, value_of
from jacaros.terms.substitution import resolve
from jacaros.terms.values import PLAIN, String, Term, functor_of, is_list, list_items, make_list

_ABOUT_PLANS = frozenset({"tellHow", "untellHow", "askHow", "tell-how", "untell-how", "ask-how"})
"""Performatives whose content may be the text of a plan, a string as in AgentSpeak."""

QUESTIONS = frozenset({"askOne", "askAll", "askHow", "ask-one", "ask-all", "ask-how"})


def content_of(value: object, performative: str = "tell") -> Term:
    """The content of a message for a Python value; texts are read as AgentSpeak, those about plans excepted.

    Raises:
        AslError: a text is no term.
    """
    if isinstance(value, str) and performative in _ABOUT_PLANS:
        return String(value)
    if type(value) is str:
        return resolve(lower(parse_term(value), fresh_names()))
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return make_list([content_of(item, performative) for item in value])
    return term_of(value)


def heard(content: Term) -> object:
    """The content of a message as a Python value: a `Literal`, another value such as the text of a plan, or a list."""
    content = resolve(content)
    if is_list(content):
        return [heard(item) for item in list_items(content)]
    symbol = functor_of(content)
    return value_of(content) if symbol is not None and symbol.kind == PLAIN else to_value(content)


class ReceivedMessage(Message):
    """A message that an agent written in Python received, and may answer.

    Attributes:
        answered: True when `reply` has been called.
    """

    def __init__(self, raw: SpeechAct, answer: Callable[[SpeechAct, str, Term], None]) -> None:
        super().__init__(raw)
        self._answer = answer
        self.answered = False

    @property
    def content(self) -> Any:
        """What is said: a `Literal`, another Python value, or a list of them; variables are `Out` objects."""
        return heard(self.raw.content)

    @property
    def is_question(self) -> bool:
        """True when the sender wants an answer."""
        return self.performative in QUESTIONS

    def reply(self, content: object, performative: str = "tell") -> None:
        """Answer the message.

        Args:
            content: a text that is AgentSpeak, a `Literal`, or another value; None to a question means that
                there is no answer.  The answer to ``askAll`` is a list.
            performative: of the answer.

        Raises:
            AslError: the text is not AgentSpeak.
            UnknownAgent: the sender has gone.
        """
        self.answered = True
        if content is None:
            self._answer(self.raw, "untell", self.raw.content)
        else:
            self._answer(self.raw, performative, content_of(content, self.performative))
