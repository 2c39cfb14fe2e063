"""Lines of a run on the graph's log."""

from typing import Any

from jacaros.robots.ros.errors import CapabilityMissing
from jacaros.runtime.mas.rosout import RosoutConsole


class Written:
    """A console that keeps its lines."""

    def __init__(self) -> None:
        self.lines: list[tuple[str, str]] = []

    def print(self, agent: str, text: str) -> None:
        self.lines.append((agent, text))

    def log(self, text: str, level: str = "info") -> None:
        self.lines.append((level, text))


class Node:
    """A node, as far as its log matters."""

    def __init__(self) -> None:
        self.connected = True
        self.told: list[tuple[str, str]] = []

    def rosout(self, level: str, text: str) -> None:
        self.told.append((level, text))


class WithoutLog(Node):
    """A node of a graph that has no log."""

    def rosout(self, level: str, text: str) -> None:
        raise CapabilityMissing("/rosout is missing")


def console(node: Any) -> tuple[RosoutConsole, Written]:
    written = Written()
    return RosoutConsole(written, lambda: node), written


def test_prints_and_logs_go_to_both_with_the_levels_of_ros() -> None:
    node = Node()
    both, written = console(node)
    both.print("bob", "hello")
    both.log("[bob] warning: no plan", "warning")
    both.log("details", "debug")
    both.log("broken", "error")
    said = [("info", "[bob] hello"), ("warn", "[bob] warning: no plan")]
    assert node.told == [*said, ("debug", "details"), ("error", "broken")]
    assert written.lines[0] == ("bob", "hello")
    assert len(written.lines) == 4


def test_lines_about_the_connection_or_without_one_are_not_published() -> None:
    node = Node()
    both, written = console(node)
    both.log("[ros] the master is lost")
    assert (node.told, written.lines) == ([], [("info", "[ros] the master is lost")])
    early, written = console(None)
    early.print("bob", "early")
    node = Node()
    node.connected = False
    lost, more = console(node)
    lost.print("bob", "lost")
    assert (node.told, written.lines, more.lines) == ([], [("bob", "early")], [("bob", "lost")])


def test_a_graph_without_a_log_is_reported_once() -> None:
    both, written = console(WithoutLog())
    both.print("bob", "one")
    both.print("bob", "two")
    missing = ("warning", "[ros] cannot write to /rosout: /rosout is missing")
    assert written.lines == [("bob", "one"), missing, ("bob", "two")]
