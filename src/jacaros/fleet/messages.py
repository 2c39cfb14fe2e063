"""Messages between agents of this member and of another one."""

from collections.abc import Collection
from functools import partial

from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.plan import Failure
from jacaros.agents.terms.values import String, atom, functor
from jacaros.fleet import protocol
from jacaros.fleet.agents import FleetAgents
from jacaros.fleet.causes import Causes
from jacaros.fleet.channel import Channel
from jacaros.fleet.rights import SEND, TELL_HOW
from jacaros.fleet.served import Line
from jacaros.fleet.wire import NotSendable, Wire
from jacaros.runtime.mas.system import System

FULL = 8 << 20
"""Bytes under way to a member beyond which no message is accepted for it."""
_QUESTIONS = 10_000
"""Questions to a member whose answers are awaited, or must be ignored; older ones get no report of its loss."""
_ERROR, _ERROR_MSG = functor("error", 1), functor("error_msg", 1)
_HOW = frozenset({"tellHow", "tell-how", "untellHow", "untell-how"})
"""Performatives that change the program of their receiver."""
_ASKING = "ask"
_ASKING_HOW = ("askHow", "ask-how")


class Messages:
    """The messages in both directions. It is the `jacaros.fleet.agents.Post` of the other member.

    Args:
        member: name of the other member.
        system: the system of this member.
        channel: the channel to the other member.
        line: reports about it.
        agents: agents of all other members.
        wire: converts terms.
        causes: describes what led to a message.
        rights: what the other member may do here.

    Attributes:
        asked: questions whose answers are awaited, by id.
    """

    def __init__(
        self,
        member: str,
        system: System,
        channel: Channel,
        line: Line,
        agents: FleetAgents,
        wire: Wire,
        causes: Causes,
        rights: Collection[str],
    ) -> None:
        self._member, self._system, self._channel, self._line = member, system, channel, line
        self._agents, self._wire, self._causes, self._rights = agents, wire, causes, rights
        self.asked: dict[str, SpeechAct] = {}
        self._failed: dict[str, bool] = {}

    def lost(self) -> None:
        """Fail the questions to it: it is gone."""
        asked, self.asked = self.asked, {}
        self._failed = dict.fromkeys([*self._failed, *asked][-_QUESTIONS:], True)
        for message in asked.values():
            self._system.mailboxes.returned(message, "member_lost")

    def forget(self) -> None:
        """Forget questions that failed: it will not return."""
        self._failed.clear()

    def post(self, message: SpeechAct, receiver: str) -> None:
        """Send a message to an agent of it.

        Raises:
            Failure: too much is under way, or the content cannot be sent.
        """
        if self._channel.backlog > FULL:
            raise Failure((_ERROR, atom("mailbox_full")), (_ERROR_MSG, String(f"{self._member} is too slow")))
        try:
            content = self._wire.from_term(message.content)
        except NotSendable as error:
            raise Failure((_ERROR, atom("not_sendable")), (_ERROR_MSG, String(str(error)))) from None
        said = protocol.Message(
            message.performative,
            message.sender,
            receiver,
            content,
            message.id,
            message.in_reply_to,
            self._causes.of_step(message.sender),
        )
        payload = protocol.write(said)
        if len(payload) > protocol.LARGEST:
            raise Failure((_ERROR, atom("not_sendable")), (_ERROR_MSG, String(protocol.TOO_LARGE)))
        if message.performative.startswith(_ASKING):
            self._note_question(message)
            self._channel.send(payload)
        else:
            self._channel.send(payload, partial(self._system.mailboxes.returned, message, "unconfirmed"))

    def _note_question(self, message: SpeechAct) -> None:
        self.asked[message.id] = message
        if len(self.asked) > _QUESTIONS:
            del self.asked[next(iter(self.asked))]

    def received(self, said: protocol.Message) -> None:
        """Put a message into the mailbox of its receiver, or return it."""
        reason = "malformed"
        try:
            reason = self._deliver(said)
        finally:
            if reason:
                returned = protocol.Returned(
                    said.id, said.sender, said.receiver, said.performative, said.content, reason
                )
                # Kept if it is lost now: nothing else tells the sender.
                self._channel.send(protocol.write(returned), lambda: None)

    def _deliver(self, said: protocol.Message) -> str:
        """Put a message into the mailbox of its receiver. Return why that is impossible, or an empty text."""
        right = TELL_HOW if said.performative in _HOW and not self._is_answer_to_how(said) else SEND
        if right not in self._rights:
            self._line.report(f"refused a message: it lacks the right `{right}` (--fleet-allow)")
            return "not_permitted"
        if not (said.performative + said.sender).isprintable():
            return "malformed"  # they get into logs
        if said.in_reply_to is not None:
            self.asked.pop(said.in_reply_to, None)
            if self._failed.pop(said.in_reply_to, False):
                return ""  # its asker knows that the member was lost, and would take it for news
        sender, content = self._agents.called(said.sender, self._member), self._wire.to_term(said.content)
        message = SpeechAct(said.performative, sender, said.receiver, content, said.id, said.in_reply_to)
        if self._system.directory.find_here(said.receiver) is None:
            return "receiver_not_found"  # even if another member has it: messages are not passed on
        try:
            return (
                ""
                if self._system.deliver(message, self._causes.arrived(said.cause))
                else "receiver_not_found"
            )
        except Failure:
            return "mailbox_full"

    def _is_answer_to_how(self, said: protocol.Message) -> bool:
        """Return whether it brings the plans that its receiver has asked for."""
        asked = self.asked.get(said.in_reply_to or "")
        return (
            asked is not None and asked.performative in _ASKING_HOW and asked.sender == said.receiver
        ) and not said.performative.startswith("un")

    def returned(self, said: protocol.Returned) -> None:
        """Hear that a message could not be put into the mailbox of its receiver."""
        if self.asked.pop(said.id, None) is None and said.performative.startswith(_ASKING):
            return  # the asker knows that the member was lost
        receiver, content = self._agents.called(said.receiver, self._member), self._wire.to_term(said.content)
        message = SpeechAct(said.performative, said.sender, receiver, content, said.id)
        self._system.mailboxes.returned(message, said.reason)
