"""Goals, beliefs, questions and explanations over HTTP."""

import asyncio
import json
from typing import Any

import httpx
import jsonschema
import pytest
from http_lab import Lab, problem, serve

PARCEL = {"parcel": "p1", "room": "kitchen"}


def test_agents_and_their_offers_depend_on_the_caller() -> None:
    async def test(lab: Lab) -> None:
        assert (await lab.anna.get("/agents")).json() == {"agents": [{"name": "bob", "url": "/agents/bob"}]}
        anna = (await lab.anna.get("/agents/bob")).json()
        assert [each["name"] for each in anna["goals"]] == ["deliver", "count", "guard", "ponder"]
        assert anna["goals"][0]["arguments"]["properties"]["room"]["enum"] == ["kitchen", "office"]
        async with lab.client("boss") as boss, lab.client("wall") as wall:
            assert "reset" in [each["name"] for each in (await boss.get("/agents/bob")).json()["goals"]]
            found = (await wall.get("/agents/bob")).json()
            assert (found["goals"], found["beliefs"][0]["name"]) == ([], "battery")
        problem(await lab.anna.get("/agents/eve"), 404, "unknown_agent")

    serve(test)


@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_goal_is_given_watched_and_achieved(clock: str) -> None:
    async def test(lab: Lab) -> None:
        given = await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL)
        assert (given.status_code, given.json()["state"]) == (201, "running")
        place = given.headers["location"]
        waiting = asyncio.create_task(lab.anna.get(place, headers={"Prefer": "wait=30"}))
        lab.mas.agent("bob").add_belief("go")
        ended = await waiting
        assert ended.headers["preference-applied"] == "wait=30"
        found = ended.json()
        assert (found["state"], found["progress"], found["note"]) == ("achieved", 0.5, "half way")
        assert [each["id"] for each in (await lab.anna.get("/goals")).json()["goals"]] == [found["id"]]

    serve(test, clock=clock)


def test_results_come_with_the_response_if_the_client_waits() -> None:
    async def test(lab: Lab) -> None:
        ended = await lab.anna.post("/agents/bob/goals/count", json={"n": 3}, headers={"Prefer": "wait=30"})
        assert (ended.status_code, ended.json()["state"], ended.json()["results"]) == (
            201,
            "achieved",
            {"next": 4},
        )
        failed = await lab.anna.post("/agents/bob/goals/ponder", headers={"Prefer": "respond-async, wait=30"})
        assert (failed.status_code, failed.json()["state"]) == (201, "failed")

    serve(test)


def test_a_refused_goal_is_a_problem_with_the_reason() -> None:
    async def test(lab: Lab) -> None:
        assert (
            await lab.anna.post("/agents/bob/beliefs/closed", json={"room": "kitchen"})
        ).status_code == 204
        told = problem(await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL), 409, "refused")
        assert "refused(closed(kitchen))" in told["reasons"]
        assert (await lab.anna.get(told["goal"])).json()["state"] == "refused"
        gone = await lab.anna.request("DELETE", "/agents/bob/beliefs/closed", json={"room": "kitchen"})
        assert gone.status_code == 204
        assert (await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL)).status_code == 201

    serve(test)


def test_a_goal_is_cancelled_by_its_caller_or_an_operator_alone() -> None:
    async def test(lab: Lab) -> None:
        place = (await lab.anna.post("/agents/bob/goals/guard")).headers["location"]
        async with lab.client("bert") as bert, lab.client("boss") as boss:
            problem(await bert.get(place), 404, "unknown_goal")
            problem(await bert.delete(place), 404, "unknown_goal")
            assert (await bert.get("/goals")).json() == {"goals": []}
            assert len((await boss.get("/goals", params={"limit": "1"})).json()["goals"]) == 1
            ended = await boss.delete(place, headers={"Prefer": "wait=30"})
        assert (ended.status_code, ended.json()["state"]) == (200, "cancelled")
        assert (await lab.anna.get(place)).json()["state"] == "cancelled"

    serve(test)


def test_beliefs_and_questions() -> None:
    async def test(lab: Lab) -> None:
        assert (await lab.anna.get("/agents/bob/beliefs/battery")).json() == {"beliefs": [{"level": 80}]}
        asked = await lab.anna.post("/agents/bob/questions/double", json={"x": 4})
        assert asked.json() == {"answers": [{"y": 8}]}
        problem(await lab.anna.get("/agents/bob/beliefs/secret"), 404, "not_offered")

    serve(test)


def test_why_names_the_caller() -> None:
    async def test(lab: Lab) -> None:
        await lab.anna.post("/agents/bob/goals/count", json={"n": 3}, headers={"Prefer": "wait=30"})
        told = await lab.anna.get("/why", params={"question": "why !count(3, _)"})
        assert "asked by http:anna" in told.json()["text"]
        problem(await lab.anna.get("/why", params={"question": ")("}), 422, "invalid_arguments")
        problem(await lab.anna.get("/why", params={"question": "x", "at": "nan"}), 422, "invalid_arguments")

    serve(test)


ASKS = """
{ include("$jacaros/artifacts.asl") }
{ offer(belief, place(room(atom))) }
!fetch.
+!fetch <- !use_artifact("operator", "Operator"); ask("Where is the ball?", [kitchen, hall], Room); +place(Room).
"""


def test_a_person_answers_a_question_of_an_agent() -> None:
    async def test(lab: Lab) -> None:
        async with lab.events("?beliefs=bob.place") as events:
            assert (await anext(events))["beliefs"] == []
            asked: list[Any] = []
            while not asked:
                asked = (await lab.anna.get("/questions")).json()["questions"]
            assert (asked[0]["text"], asked[0]["options"]) == ("Where is the ball?", ["kitchen", "hall"])
            place = f"/questions/{asked[0]['id']}"
            async with lab.client("wall") as wall, lab.client("boss") as boss:
                problem(await wall.post(place, json={"option": 2}), 403, "not_permitted")
                artifacts = (await boss.get("/artifacts")).json()["artifacts"]
                assert "Operator" in [each["type"] for each in artifacts]
            problem(await lab.anna.get("/artifacts"), 403, "not_permitted")
            problem(await lab.anna.post(place, json={"option": True, "x": 1}), 422, "invalid_arguments")
            problem(await lab.anna.post(place, json={"text": "cellar"}), 422, "invalid_arguments")
            problem(
                await lab.anna.post("/questions/operator-7", json={"text": "hall"}), 404, "unknown_question"
            )
            assert (await lab.anna.post(place, json={"option": 2})).status_code == 204
            assert (await anext(events))["beliefs"] == [{"room": "hall"}]

    serve(test, ASKS)


def test_the_openapi_document_describes_what_the_caller_may_do() -> None:
    async def test(lab: Lab) -> None:
        document = (await lab.anna.get("/openapi.json")).json()
        assert document["openapi"] == "3.1.0"
        paths = document["paths"]
        assert "/agents/bob/goals/deliver" in paths
        assert "/agents/bob/goals/reset" not in paths
        body = paths["/agents/bob/goals/deliver"]["post"]["requestBody"]
        jsonschema.validate(PARCEL, body["content"]["application/json"]["schema"])
        for path, methods in paths.items():
            named = {part[1:-1] for part in path.split("/") if part.startswith("{")}
            for operation in methods.values():
                given = {each["name"] for each in operation.get("parameters", []) if each["in"] == "path"}
                assert given == named, path
                assert operation["responses"], path
        goal = document["components"]["schemas"]["Goal"]
        jsonschema.Draft202012Validator.check_schema(goal)
        count = await lab.anna.post("/agents/bob/goals/count", json={"n": 3}, headers={"Prefer": "wait=30"})
        jsonschema.validate(count.json(), goal)
        problems = document["components"]["schemas"]["Problem"]
        jsonschema.validate((await lab.anna.get("/agents/eve")).json(), problems)

    serve(test)


@pytest.mark.parametrize(
    ("method", "path", "body", "status", "code"),
    [
        ("GET", "/nothing", b"", 404, "unknown_path"),
        ("PUT", "/goals", b"", 405, "method_not_allowed"),
        ("POST", "/agents/bob/goals/secret", b"{}", 404, "not_offered"),
        ("POST", "/agents/bob/goals/reset", b"{}", 403, "not_permitted"),
        ("POST", "/agents/bob/goals/count", b"{", 400, "malformed"),
        ("POST", "/agents/bob/goals/count", b"[3]", 400, "malformed"),
        ("POST", "/agents/bob/goals/count", b'{"n": NaN}', 400, "malformed"),
        ("POST", "/agents/bob/goals/count", b'{"n": "3"}', 422, "invalid_arguments"),
        ("POST", "/agents/bob/goals/count", b'{"n": 1' + b"0" * 400 + b"}", 422, "invalid_arguments"),
        ("POST", "/agents/bob/goals/count", b'{"n":' * 9000 + b"1" + b"}" * 9000, 400, "malformed"),
        ("POST", "/agents/bob/goals/count", b'{"n": "' + b"x" * 70_000 + b'"}', 413, "too_large"),
        ("GET", "/goals?limit=many", b"", 422, "invalid_arguments"),
        ("GET", "/events?beliefs=battery", b"", 422, "invalid_arguments"),
        ("GET", "/events?beliefs=bob.secret", b"", 404, "not_offered"),
    ],
)
def test_every_error_is_a_problem_document(
    method: str, path: str, body: bytes, status: int, code: str
) -> None:
    async def test(lab: Lab) -> None:
        problem(await lab.anna.request(method, path, content=body), status, code)
        assert (await lab.anna.get("/agents/bob/beliefs/battery")).json() == {"beliefs": [{"level": 80}]}

    assert [line for line in serve(test) if "error" in line] == []


def test_the_end_of_the_run_answers_who_waits() -> None:
    async def test(lab: Lab) -> None:
        place = (await lab.anna.post("/agents/bob/goals/deliver", json=PARCEL)).headers["location"]
        waiting = asyncio.create_task(lab.anna.get(place, headers={"Prefer": "wait=30"}))
        async with lab.events() as events:
            assert (await anext(events))["state"] == "running"
            lab.mas.stop()
            closing = asyncio.create_task(lab.door.close())
            told = [each async for each in events]
        assert told[-1]["event"] in ("goal", "agent_ended")
        assert (await waiting).json()["state"] == "failed"
        await closing
        with pytest.raises(httpx.ConnectError):
            await lab.anna.get("/agents")

    serve(test)


def test_json_of_events_is_strict() -> None:
    program = '{ offer(belief, far(m(any))) } far(1 / 0). far("é\u2028").'

    async def test(lab: Lab) -> None:
        text = (await lab.anna.get("/agents/bob/beliefs/far")).text
        found = json.loads(text, parse_constant=pytest.fail)["beliefs"]
        assert sorted(each["m"] for each in found) == ["inf", "é\u2028"]

    serve(test, program)


def test_a_goal_can_be_named_with_its_number_of_arguments() -> None:
    async def test(lab: Lab) -> None:
        given = await lab.anna.post("/agents/bob/goals/count/2", json={"n": 3}, headers={"Prefer": "wait=5"})
        assert given.json()["results"] == {"next": 4}
        problem(await lab.anna.post("/agents/bob/goals/count/3", json={"n": 3}), 404, "not_offered")

    serve(test)
