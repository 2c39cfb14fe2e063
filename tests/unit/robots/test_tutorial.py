"""ArtTutorial: a topic and a service, and what happens when the service does not answer."""

from typing import Any

import pytest
from robot_lab import Lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.artifacts.thesis import ArtTutorial

ADD = "example_interfaces/srv/AddTwoInts"


def offer_adding(lab: Lab) -> None:
    lab.backend.service("/add_two_ints", ADD, lambda request: {"sum": request.a + request.b})


def say(lab: Lab, text: str, topic: str = "/chatter") -> None:
    publisher = lab.backend.publisher(topic, "std_msgs/msg/String")
    publisher.publish(publisher.message(data=text))


async def test_the_service_adds_and_the_property_shows_the_sum(lab: Lab) -> None:
    offer_adding(lab)
    tutorial = await lab.make(ArtTutorial)
    watcher = lab.watch(tutorial)
    await lab.do(tutorial, "sum", 30, 12)
    assert watcher.values("twoIntsSum") == [(0,), (42,)]
    out = Out()
    await lab.do(tutorial, "sum", -1, 1, out)
    assert out.value == 0
    assert watcher.values("twoIntsSum")[-1] == (0,)
    assert watcher.signals == []


async def test_a_missing_service_fails_the_operation_and_keeps_the_property(lab: Lab) -> None:
    """Defect 11: a failing service silently gave 0."""
    tutorial = await lab.make(ArtTutorial, Structure("timeout", (3,)))
    watcher = lab.watch(tutorial)
    failed = await lab.call(tutorial, "sum", 1, 2)
    assert failed.reason == "service_unavailable(add_two_ints)"
    assert "add_two_ints" in failed.message
    assert lab.clock.elapsed == pytest.approx(3)
    assert watcher.values("twoIntsSum") == [(0,)]
    offer_adding(lab)
    await lab.do(tutorial, "sum", 1, 2)


async def test_a_service_that_does_not_answer_or_breaks_fails_with_its_reason(lab: Lab) -> None:
    async def slow(request: Any) -> dict[str, int]:
        await lab.sleep(60)
        return {"sum": 0}

    def broken(request: Any) -> dict[str, int]:
        raise RuntimeError("out of numbers")

    service = lab.backend.service("/add_two_ints", ADD, slow)
    tutorial = await lab.make(ArtTutorial, {"timeout": 2})
    assert (await lab.call(tutorial, "sum", 1, 2)).reason == "service_timeout(2)"
    service.close()
    lab.backend.service("/add_two_ints", ADD, broken)
    assert (await lab.call(tutorial, "sum", 1, 2)).reason == "service_failed(add_two_ints)"


async def test_other_operations_are_served_while_the_service_is_asked(lab: Lab) -> None:
    async def slow(request: Any) -> dict[str, int]:
        await lab.sleep(5)
        return {"sum": request.a + request.b}

    lab.backend.service("/add_two_ints", ADD, slow)
    tutorial = await lab.make(ArtTutorial)
    adding = lab.begin(tutorial, "sum", 1, 2)
    say(lab, "hello")
    await lab.sleep(0.1)
    await lab.do(tutorial, "getCurrentMessage")
    assert lab.clock.elapsed < 1
    await adding.done
    assert adding.ok


async def test_chatter_is_received_and_shown_again_on_request(lab: Lab) -> None:
    tutorial = await lab.make(ArtTutorial)
    watcher = lab.watch(tutorial)
    assert watcher.holds("chatter") == [("",)]
    for text in ("hello", "hello", "world"):
        say(lab, text)
    await lab.sleep(0.1)
    assert watcher.values("chatter") == [("",), ("hello",), ("world",)]
    await lab.do(tutorial, "getCurrentMessage")
    assert watcher.values("chatter")[-2:] == [("world",), ("world",)]


async def test_a_missing_message_fails_as_no_message(lab: Lab) -> None:
    tutorial = await lab.make(ArtTutorial)
    assert (await lab.call(tutorial, "getCurrentMessage")).reason == "no_message(5)"


async def test_a_robot_name_stands_before_topic_and_properties_and_a_namespace_before_the_topic(
    lab: Lab,
) -> None:
    """Defect 12: only the first way was there, so an agent had to know its robot's name."""
    offer_adding(lab)
    named = await lab.make(ArtTutorial, "robot_0")
    spaced = await lab.make(ArtTutorial, Structure("namespace", ("robot_0",)))
    say(lab, "hi", "/robot_0/chatter")
    await lab.sleep(0.1)
    for artifact, prefix in ((named, "robot_0_"), (spaced, "")):
        watcher = lab.watch(artifact)
        assert watcher.holds(f"{prefix}chatter") == [("hi",)]
        await lab.do(artifact, "sum", 1, 1)
        assert watcher.holds(f"{prefix}twoIntsSum") == [(2,)]
