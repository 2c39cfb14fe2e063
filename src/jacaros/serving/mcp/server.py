"""The requests of MCP: tools, resources, and subscriptions to beliefs."""

import asyncio
import json
import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import mcp_types as types
from mcp.server import Server, ServerRequestContext
from mcp.server.subscriptions import (
    InMemorySubscriptionBus,
    ListenHandler,
    ResourcesListChanged,
    ResourceUpdated,
    ToolsListChanged,
)
from mcp.shared.exceptions import MCPError

from jacaros.agents.language.offers import Offer
from jacaros.serving.arguments import Data, terms_of
from jacaros.serving.callers import RequestError
from jacaros.serving.crossing import Outbox
from jacaros.serving.goals import ACHIEVED, OVER
from jacaros.serving.mcp.clients import Client
from jacaros.serving.mcp.tools import OWN, AgentOffer, belief_at, offers_of, own_tools, resources_of, tool_of
from jacaros.serving.service import Session
from jacaros.version import VERSION

Context = ServerRequestContext[Any, Any]
Result = types.CallToolResult
MOST_SUBSCRIPTIONS = 100
"""Maximum number of beliefs that one client watches."""
REST = 0.5
"""Seconds between two notifications of changed beliefs: a hundred watchers must not slow the agents down."""
INSTRUCTIONS = (
    "The tools give goals to software agents that control robots, ask them, and tell them beliefs. An agent pursues a goal "
    "as its own program says, and may refuse it. The tool of a goal returns when the goal has ended; to stop it earlier, "
    "cancel the request or call `cancel_goal`. If a goal is refused or fails, the error says why: tell the user instead of "
    "repeating it. `why` explains what happened. Resources are beliefs of the agents."
)
_SHOWN = ("id", "agent", "written", "state", "progress", "note", "doing", "results", "message", "reasons")


class McpServer:
    """Serves what agents offer.

    Args:
        name: name of the run.
        client_of: returns the caller of a request.
        patience: seconds after which the tool of a goal returns although the goal continues; None for no limit.

    Attributes:
        server: the server of the SDK.
    """

    def __init__(
        self, name: str, client_of: Callable[[Context], Client], patience: float | None = None
    ) -> None:
        self._client_of, self._patience = client_of, patience
        self._own: Mapping[str, Callable[[Client, Mapping[str, Any]], Any]] = {
            "goals": self._goals,
            "cancel_goal": self._cancel_goal,
            "why": self._why,
            "why_not": self._why_not,
        }
        self.server: Server[Any] = Server(
            name,
            version=VERSION,
            instructions=INSTRUCTIONS,
            on_list_tools=self._list_tools,
            on_call_tool=self._call_tool,
            on_list_resources=self._list_resources,
            on_read_resource=self._read_resource,
            on_subscriptions_listen=self._listen,
        )
        self.server.middleware.clear()  # the run has its own recording
        # What strangers send does not belong in the output of a run; defects do.
        logging.getLogger("mcp").setLevel(logging.ERROR)

    # ---- tools

    async def _list_tools(self, ctx: Context, _: object) -> types.ListToolsResult:
        with _answering():
            tools = await self._client_of(ctx).tools()
        return types.ListToolsResult(tools=[*(tool_of(*each) for each in tools.items()), *own_tools()])

    async def _call_tool(self, ctx: Context, params: types.CallToolRequestParams) -> Result:
        client, given = self._client_of(ctx), params.arguments or {}
        try:
            own = self._own.get(params.name)
            if own is not None:
                terms_of(OWN[params.name], given)
                result: Result = await own(client, given)
                return result
            tool = await client.tool(params.name)
            if tool is None:
                raise MCPError(types.INVALID_PARAMS, f"unknown tool `{params.name[:80]}`")
            return await self._use(ctx, client, tool, given)
        except RequestError as error:
            return _wrong(error.message)

    async def _use(self, ctx: Context, client: Client, tool: AgentOffer, given: Mapping[str, Any]) -> Result:
        agent, offer = tool.agent, tool.offer
        if offer.what == "question":
            answers = await client.do(lambda session: session.ask(agent, offer.key, given))
            return _told(_json(answers), {"answers": answers})
        if offer.what == "tell":
            await client.do(lambda session: session.tell(agent, offer.key, given))
            return _told("told")
        wants_progress = ctx.meta is not None and "progress_token" in ctx.meta
        report = ctx.session.report_progress if wants_progress else None
        return _outcome(offer, await client.pursue(tool, given, report, self._patience))

    async def _goals(self, client: Client, _: object) -> Result:
        def shown(session: Session) -> list[dict[str, Data]]:
            return [_brief(goal.data()) for goal in session.goals()[-MOST_SUBSCRIPTIONS:]]

        return _told(_json(await client.do(shown)))

    async def _cancel_goal(self, client: Client, given: Mapping[str, Any]) -> Result:
        id = given["id"]

        async def cancel(session: Session) -> list[dict[str, Data]]:
            found = [each for each in session.goals() if not each.over] if id == "all" else [session.goal(id)]
            for goal in found:
                session.cancel(goal.id)
            for goal in found:
                await goal.wait()
            return [_brief(goal.data()) for goal in found]

        return _told(_json(await client.wait(cancel)))

    async def _why(self, client: Client, given: Mapping[str, Any]) -> Result:
        explanation = await client.wait(lambda session: session.why(given["question"]))
        return _told(explanation.text())

    async def _why_not(self, client: Client, given: Mapping[str, Any]) -> Result:
        what = given["what"]
        question = what if what[:1] in "+-!@" or what.startswith("plan ") else f"why did it not {what}"
        return await self._why(client, {"question": question})

    # ---- resources

    async def _list_resources(self, ctx: Context, _: object) -> types.ListResourcesResult:
        with _answering():
            offered = await self._client_of(ctx).do(offers_of)
        return types.ListResourcesResult(resources=resources_of(offered))

    async def _read_resource(
        self, ctx: Context, params: types.ReadResourceRequestParams
    ) -> types.ReadResourceResult:
        agent, name = _belief(params.uri)
        with _answering():
            facts = await self._client_of(ctx).do(lambda session: session.beliefs(agent, name))
        content = types.TextResourceContents(uri=params.uri, mime_type="application/json", text=_json(facts))
        return types.ReadResourceResult(contents=[content])

    async def _listen(
        self, ctx: Context, params: types.SubscriptionsListenRequestParams
    ) -> types.SubscriptionsListenResult:
        """Serve a stream of changes, as clients want them since the version 2026-07-28 of the protocol."""
        wanted = params.notifications
        beliefs = {uri: _belief(uri) for uri in (wanted.resource_subscriptions or ())[:MOST_SUBSCRIPTIONS]}
        bus, changed = InMemorySubscriptionBus(), Outbox[str](asyncio.get_running_loop())
        client = self._client_of(ctx)
        with _answering():
            stop = await client.watch(beliefs, changed)
        publishing = asyncio.create_task(_publish(changed, bus))
        try:
            return await ListenHandler(bus)(ctx, params)
        finally:
            publishing.cancel()
            stop()


@contextmanager
def _answering() -> Iterator[None]:
    """Turn a request that has no effect into an error of the protocol."""
    try:
        yield
    except RequestError as error:
        raise MCPError(types.INVALID_PARAMS, error.message) from None


async def _publish(changed: Outbox[str], bus: InMemorySubscriptionBus) -> None:
    while True:
        for uri in await changed.take():
            if uri:
                await bus.publish(ResourceUpdated(uri))
            else:
                await bus.publish(ToolsListChanged())
                await bus.publish(ResourcesListChanged())
        await asyncio.sleep(REST)


def _belief(uri: str) -> tuple[str, str]:
    found = belief_at(uri)
    if found is None:
        raise MCPError(types.INVALID_PARAMS, f"unknown resource `{uri[:80]}`")
    return found


def _outcome(offer: Offer, goal: Mapping[str, Any]) -> Result:
    """Return what came of a goal, for the model."""
    results = goal["results"]
    structured = results if len(offer.inputs) < len(offer.parameters) else None
    if goal["state"] == ACHIEVED:
        return _told(_json(results) if results else f"achieved {goal['written']}", structured)
    if goal["state"] in OVER:
        why = goal["message"] or ", ".join(goal["reasons"])
        return _wrong(f"{goal['state']}: {goal['written']}" + (f": {why}" if why else ""))
    told = (
        f"{goal['state']}: {goal['written']} continues; its id is {goal['id']}, see `goals` and `cancel_goal`"
    )
    return _told(told, structured)


def _brief(goal: Mapping[str, Any]) -> dict[str, Data]:
    return {key: goal[key] for key in _SHOWN if goal[key] not in (None, "", [], {})}


def _told(text: str, structured: Data = None) -> Result:
    return Result(content=[types.TextContent(text=text)], structured_content=structured)


def _wrong(text: str) -> Result:
    return Result(content=[types.TextContent(text=text)], is_error=True)


def _json(data: Data) -> str:
    return json.dumps(data, ensure_ascii=False)
