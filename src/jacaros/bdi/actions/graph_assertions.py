"""The internal actions behind the goals of tests that play the rest of the ROS graph: messages and services."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import groupby

from jacaros.bdi.actions.assertions import probe_of, tell_assertion
from jacaros.bdi.actions.internal_action import internal_action
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.probe import OthersInGraph
from jacaros.terms.text import display
from jacaros.terms.values import Term


@internal_action("jacaros.fake_message", arity=(2, 3))
def fake_message(ctx: Context, topic: Term, first: Term, second: Term = None) -> None:
    """``jacaros.fake_message(Topic [,Type], Fields)``: somebody publishes a message.

    Raises:
        ActionError: nobody tests this agent.
    """
    type_name, fields = ("", first) if second is None else (display(first), second)
    with _others(ctx, "fake_message") as others:
        others.publish(display(topic), display(fields), type_name)


@internal_action("jacaros.fake_subscriber", arity=2)
def fake_subscriber(ctx: Context, topic: Term, type_name: Term) -> None:
    """``jacaros.fake_subscriber(Topic, Type)``: somebody listens to a topic.

    Raises:
        ActionError: nobody tests this agent.
    """
    with _others(ctx, "fake_subscriber") as others:
        others.hear(display(topic), display(type_name))


@internal_action("jacaros.fake_service", arity=3)
def fake_service(ctx: Context, service: Term, type_name: Term, fields: Term) -> None:
    """``jacaros.fake_service(Name, Type, Fields)``: somebody offers a service, and gives this response.

    Raises:
        ActionError: nobody tests this agent.
    """
    with _others(ctx, "fake_service") as others:
        others.answer(display(service), display(type_name), display(fields))


@internal_action("jacaros.assert_published", arity=(2, 3))
def assert_published(ctx: Context, topic: Term, fields: Term, times: Term = None) -> None:
    """``jacaros.assert_published(Topic, Fields [,Times])``: the run has published such a message (so many times)."""
    with _others(ctx, "assert_published") as others:
        _tell_count(ctx, others.count_published, "a message on", topic, fields, times)


@internal_action("jacaros.assert_not_published", arity=1)
def assert_not_published(ctx: Context, topic: Term) -> None:
    """``jacaros.assert_not_published(Topic)``: the run has published nothing on a topic."""
    with _others(ctx, "assert_not_published") as others:
        count, found = others.count_published(display(topic), "")
        tell_assertion(ctx, not count, f"no message on {display(topic)}", f"there were {_listed(found)}")


@internal_action("jacaros.assert_called", arity=(2, 3))
def assert_called(ctx: Context, service: Term, fields: Term, times: Term = None) -> None:
    """``jacaros.assert_called(Service, Fields [,Times])``: a faked service was asked this (so many times)."""
    with _others(ctx, "assert_called") as others:
        _tell_count(ctx, others.count_asked, "a request to", service, fields, times)


def _tell_count(
    ctx: Context,
    counted: Callable[[str, str], tuple[int, list[str]]],
    what: str,
    name: Term,
    fields: Term,
    times: Term,
) -> None:
    count, found = counted(display(name), display(fields))
    passed = count > 0 if times is None else float(count) == times
    often = "" if times is None else f"{display(times)} times "
    wanted = f" with {display(fields)}" if display(fields) else ""
    told = f"there were {_listed(found)}" if found else "there was none"
    tell_assertion(ctx, passed, f"{often}{what} {display(name)}{wanted}", told)


_SHOWN = 5
"""So many different messages are told."""


def _listed(found: list[str]) -> str:
    """Messages for people, the newest last; of those that are alike in a row one, with their number."""
    rows = [(text, len(list(alike))) for text, alike in groupby(found)]
    shown = [text if count == 1 else f"{count} times {text}" for text, count in rows[-_SHOWN:]]
    more = f", and {len(rows) - _SHOWN} before" if len(rows) > _SHOWN else ""
    return f"{', '.join(shown)}{more}"


@contextmanager
def _others(ctx: Context, what: str) -> Iterator[OthersInGraph]:
    """The rest of the graph; what is wrong with the arguments is told where the test has them."""
    try:
        yield probe_of(ctx, what).others()
    except ValueError as wrong:
        tell_assertion(ctx, False, "", str(wrong))
