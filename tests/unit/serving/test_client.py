"""The client of a running system: requests in the language, events, and errors."""

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from console_lab import PROGRAM, ServedRun, program, served

from jacaros.runtime.errors import UsageError
from jacaros.serving.client import Client, Json, ServiceError, Unreachable


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServedRun]:
    folder = tmp_path_factory.mktemp("client")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_RUNTIME_DIR", str(folder))
        with served(program(folder)) as found:
            yield found


def pursued(client: Client, goal: str) -> list[Json]:
    return list(client.follow(lambda: client.achieve("bob", goal)))


def test_a_goal_is_followed_to_its_end(run: ServedRun) -> None:
    told = pursued(run.client, 'deliver("p1", office)')
    assert ("running", 0.5, "half way") in [(each["state"], each["progress"], each["note"]) for each in told]
    assert [each["state"] for each in told].count("achieved") == 1
    assert pursued(run.client, "count(3, N)")[-1]["results"] == {"next": 4}


def test_a_refused_goal_has_reasons(run: ServedRun) -> None:
    run.client.tell("bob", "closed(kitchen)")
    refused = pursued(run.client, 'deliver("p1", kitchen)')[-1]
    assert (refused["state"], refused["reasons"][0]) == ("refused", "refused(closed(kitchen))")
    run.client.tell("bob", "closed(kitchen)", untell=True)
    assert pursued(run.client, 'deliver("p1", kitchen)')[-1]["state"] == "achieved"


def test_questions_and_beliefs_are_asked_in_the_language(run: ServedRun) -> None:
    assert run.client.ask("bob", "double(4, Y)") == [{"Y": 8}]
    assert run.client.ask("bob", "battery(99)") == []


def test_offers_have_forms_and_choices(run: ServedRun) -> None:
    deliver = next(each for each in run.client.offers() if each.name == "deliver")
    assert deliver.form == "deliver(parcel: string, room: kitchen | office)"
    assert deliver.choices == ((), ("kitchen", "office"))


def test_events_from_the_opening_on_are_in_the_stream(run: ServedRun) -> None:
    with run.client.events(["bob.battery"]) as events:
        run.client.achieve("bob", 'deliver("p7", office)')
        found = []
        for event in events:
            found.append(event)
            if event["event"] == "goal" and event["state"] == "achieved":
                break
    announced = [each["arguments"] for each in found if each["event"] == "announced"]
    assert announced == [{"parcel": "p7"}]
    assert any(each["event"] == "belief" and each["name"] == "battery" for each in found)


@pytest.mark.parametrize(
    ("request_text", "code", "message"),
    [
        ("fly", "not_offered", "bob offers no goal `fly`"),
        ("count(11, N)", "invalid_arguments", "`n` must be from 0 to 10"),
        ("count(3", "invalid_arguments", "not a literal: unclosed `(`"),
        ("count(" * 5000, "too_large", "characters"),
    ],
)
def test_errors_say_what_is_wrong(run: ServedRun, request_text: str, code: str, message: str) -> None:
    with pytest.raises(ServiceError) as raised:
        run.client.achieve("bob", request_text)
    assert raised.value.code == code
    assert message in raised.value.message


def test_a_wrong_token_has_no_effect(run: ServedRun) -> None:
    with pytest.raises(ServiceError) as raised:
        Client(run.client.url, "guessed").tell("bob", "closed(office)")
    assert raised.value.code == "unauthorized"
    assert run.client.ask("bob", "double(1, Y)") == [{"Y": 2}]


def test_a_system_that_is_gone_is_unreachable() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        url = f"http://127.0.0.1:{free.getsockname()[1]}"
    with pytest.raises(Unreachable, match="help: start it: jacaros run"):
        Client(url, "token").agents()


def test_following_ends_when_the_system_dies(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    with served(program(tmp_path, PROGRAM)) as run:
        goals = run.client.follow(lambda: run.client.achieve("bob", "search"))
        assert next(goals)["state"] == "pending"
        run.kill()
        with pytest.raises(Unreachable):
            list(goals)


@pytest.mark.parametrize("url", ["ftp://127.0.0.1", "http://", "http://127.0.0.1:port"])
def test_an_invalid_url_is_an_error_of_usage(url: str) -> None:
    with pytest.raises(UsageError, match="invalid URL"):
        Client(url, "token")
