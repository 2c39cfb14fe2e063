"""``jacaros achieve``, ``ask``, ``tell``, ``events`` and ``console``: talk to the agents of a running system."""

import json
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib.util import find_spec
from types import FrameType

import click

from jacaros.runtime.cli.options import option, variables, with_options
from jacaros.runtime.cli.usage import examples, usage_error
from jacaros.runtime.errors import UsageError
from jacaros.serving import running
from jacaros.serving.client import Client, Json, Offered, ServiceError, Unreachable
from jacaros.serving.shell.choice import GOALS, QUESTIONS, TELLS, chosen
from jacaros.serving.shell.wording import answer_lines, error_text, event_text, row_text, state_text

FAILED, REFUSED, CANCELLED, LOST = 1, 3, 4, 5
"""Exit codes of ``jacaros achieve``; 0 for an achieved goal, 2 for wrong usage."""
_CODES = {"achieved": 0, "failed": FAILED, "refused": REFUSED, "cancelled": CANCELLED}
_COMMANDS = {"goal": "achieve", "question": "ask", "belief": "ask", "tell": "tell"}
_PROGRAMS = (".asl", ".py", ".mas2j", ".jcm")

system_options = with_options(
    option(
        "--url URL",
        "Where the system serves (default: the only running system of this user).",
        envvar="JACAROS_URL",
    ),
    option("--token TOKEN", "Your token (default: that of the running system).", envvar="JACAROS_TOKEN"),
)
"""Add the options that name a running system."""
json_option = option("--json", "Print JSON.", name="as_json")


def client_of(url: str | None, token: str | None) -> Client:
    """Return a client of the system that the options name.

    Raises:
        UsageError: no system is running, several are, or the token is missing.
    """
    known = running.services()
    if url is not None:
        known = [each for each in known if each.url == url.rstrip("/")]
        if token is None and not known:
            raise usage_error(f"no token for {url}", "add --token TOKEN, or set JACAROS_TOKEN")
    elif not known:
        raise usage_error("no running system of this user serves callers", "jacaros run FILE --serve 0")
    elif len(known) > 1:
        names = ", ".join(f"{each.name} ({each.url})" for each in known)
        raise usage_error(f"several running systems: {names}", f"name one: --url {known[0].url}")
    if not known:
        return Client(str(url), str(token))
    return Client(known[0].url, token or known[0].token, known[0].certificate)


def _written(kind: str, agent: str, text: str) -> str:
    """Return a request as a command."""
    return " ".join(each for each in ("jacaros", _COMMANDS[kind], agent, f"'{text}'") if each)


@contextmanager
def _requests() -> Iterator[None]:
    """Turn errors of requests into errors of usage: exit code 1 stands for failed goals and the answer `no`."""
    try:
        yield
    except (ServiceError, Unreachable) as error:
        raise UsageError(error_text(error)) from None


def _request(
    client: Client, kinds: tuple[str, ...], words: tuple[str, ...], signs: str
) -> tuple[Offered, str]:
    """Return what is requested by ``[AGENT] TEXT``, and its text without a sign such as ``!``."""
    if len(words) > 2:
        command = _written(kinds[0], "AGENT", 'name("text", atom)')
        raise usage_error(
            f"expected [AGENT] and one text, found {len(words)} words", f"quote the text: {command}"
        )
    text = "".join(words[-1:]).strip().removesuffix(".")
    text = text[1:].strip() if text[:1] in tuple(signs) else text
    with _requests():
        offers = client.offers()
    return chosen(offers, kinds, text, words[0] if len(words) == 2 else "", _written), text


# ---- goals


class _Pursuit:
    """A goal that is pursued. Ctrl+C and SIGTERM cancel it.

    Attributes:
        id: the goal; empty until the system has taken it. A signal before that waits for it.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self.id, self._told, self._wanted = "", "", False

    def follow(self, begin: Callable[[], Json]) -> Json:
        """Print the progress of the goal until its end. Return its data."""
        goal = Json()
        for goal in self._client.follow(begin):
            if not self.id:
                self.id = goal["id"]
                if self._wanted:
                    raise KeyboardInterrupt
            told = state_text(goal)
            if told != self._told and goal["state"] not in ("pending", "achieved"):
                self._told = told
                click.echo(f"[{goal['agent']}] !{goal['written']} {told}", err=True)
        return goal

    @contextmanager
    def by_signals(self) -> Iterator[None]:
        """Let signals raise `KeyboardInterrupt`."""
        before = {each: signal.signal(each, self._notice) for each in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for each, handler in before.items():
                signal.signal(each, handler)

    def _notice(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        again, self._wanted = self._wanted, True
        if self.id or again:
            raise KeyboardInterrupt


@click.command(
    "achieve",
    epilog=examples(
        "jacaros achieve 'deliver(\"p1\", kitchen)'",
        "jacaros achieve robot 'deliver(\"p1\", kitchen)' --json",
    ),
)
@click.argument("words", nargs=-1, required=True, metavar="[AGENT] GOAL")
@json_option
@system_options
def achieve(words: tuple[str, ...], as_json: bool, url: str | None, token: str | None) -> int:
    """Give GOAL to an agent that offers it, and wait for its end.

    Progress goes to the standard error output, results to the standard output. The exit code is 0 if the goal is achieved,
    1 if it fails, 2 if it cannot be given, 3 if the agent refuses it, 4 if it is cancelled, and 5 if the system no
    longer answers. Ctrl+C cancels the goal.
    """  # fmt: skip
    client = client_of(url, token)
    offer, text = _request(client, GOALS, words, "!")
    pursuit = _Pursuit(client)
    with pursuit.by_signals(), _requests():
        try:
            try:
                goal = pursuit.follow(partial(client.achieve, offer.agent, text))
            except KeyboardInterrupt:
                if not pursuit.id:
                    raise
                goal = pursuit.follow(partial(client.cancel, pursuit.id))
        except (ServiceError, Unreachable) as error:
            if not pursuit.id:
                raise
            click.echo(error_text(error), err=True)
            return LOST
    if as_json:
        click.echo(json.dumps(goal))
    elif goal["results"]:
        click.echo(row_text(goal["results"]))
    return _CODES[goal["state"]]


# ---- questions, beliefs and events


@click.command(
    "ask", epilog=examples("jacaros ask 'battery(Level)'", "jacaros ask robot 'route(lab, Metres)'")
)
@click.argument("words", nargs=-1, required=True, metavar="[AGENT] QUESTION")
@json_option
@system_options
def ask(words: tuple[str, ...], as_json: bool, url: str | None, token: str | None) -> int:
    """Ask an agent QUESTION, or for a belief, and print the values of its variables: a line for each answer.

    The exit code is 1 if there is no answer.
    """  # fmt: skip
    client = client_of(url, token)
    offer, text = _request(client, QUESTIONS, words, "?")
    with _requests():
        answers = client.ask(offer.agent, text)
    click.echo(json.dumps(answers) if as_json else "\n".join(answer_lines(answers)))
    return 0 if answers else 1


@click.command(
    "tell", epilog=examples("jacaros tell 'closed(kitchen)'", "jacaros tell --untell 'closed(kitchen)'")
)
@click.argument("words", nargs=-1, required=True, metavar="[AGENT] BELIEF")
@option("--untell", "Take the belief back.")
@json_option
@system_options
def tell(words: tuple[str, ...], untell: bool, as_json: bool, url: str | None, token: str | None) -> None:
    """Tell BELIEF to an agent that takes it from callers."""
    client = client_of(url, token)
    offer, text = _request(client, TELLS, words, "+")
    with _requests():
        client.tell(offer.agent, text, untell)
    if as_json:
        click.echo(json.dumps({"agent": offer.agent, "untold" if untell else "told": text}))


@click.command("events", epilog=examples("jacaros events", "jacaros events --belief robot.battery --json"))
@click.argument("agent", required=False)
@option("--belief AGENT.NAME...", "Print the beliefs of this name, now and whenever they change. Repeatable.")
@json_option
@system_options
def events(
    agent: str | None, belief: tuple[str, ...], as_json: bool, url: str | None, token: str | None
) -> None:
    """Print goals, and events that agents announce, until the system ends or you press Ctrl+C."""
    client = client_of(url, token)
    connected = False
    while True:
        try:
            with client.events(belief) as found:
                connected = True
                for event in found:
                    if agent in (None, event["agent"]):
                        click.echo(json.dumps(event) if as_json else event_text(event))
        except (Unreachable, ServiceError) as error:
            if connected and (isinstance(error, Unreachable) or error.code in ("ended", "unknown_agent")):
                return  # the system has ended, or an agent whose beliefs are printed
            with _requests():
                raise


# ---- the console


@click.command(
    "console",
    context_settings={"ignore_unknown_options": True},
    epilog=examples(
        "jacaros console", "jacaros console robot.asl --world house", "jacaros console http://127.0.0.1:8000"
    ),
)
@option("--token TOKEN", "Your token (default: that of the running system).", envvar="JACAROS_TOKEN")
@click.argument("system", required=False, metavar="[FILE|URL]")
@click.argument("options", nargs=-1, type=click.UNPROCESSED, metavar="[OPTIONS OF jacaros run]...")
def console(system: str | None, options: tuple[str, ...], token: str | None) -> int:
    """Talk to the agents of a running system in AgentSpeak, or run FILE and talk to its agents.

    `!goal`, `?question`, `+belief` and `-belief` go to the agent that offers them; `help` lists what else you can write.
    Without a terminal, lines of the standard input are executed in turn; the exit code is 1 if one fails.
    """  # fmt: skip
    from jacaros.serving.shell.console import Console, is_interactive  # here: few commands are consoles

    if is_interactive() and find_spec("prompt_toolkit") is None:
        raise usage_error("the console needs prompt_toolkit", 'pip install "jacaros[console]"')
    if system is not None and system.endswith(_PROGRAMS):
        from jacaros.runtime.cli.run import command  # here: it imports the language

        serve = () if any(each.partition("=")[0] == "--serve" for each in options) else ("--serve", "0")
        arguments = [system, *serve, "--console", *options]
        code: int = command.main(arguments, "jacaros console", standalone_mode=False, obj=variables())
        return code
    if options:
        raise usage_error(
            f"`{options[0]}` needs a file to run", "jacaros console FILE [OPTIONS OF jacaros run]"
        )
    with _requests():
        return Console().talk(client_of(system, token))
