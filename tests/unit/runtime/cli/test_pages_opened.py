"""When a page is opened in the user's browser, and what is logged about it."""

import sys
import webbrowser

import pytest

from jacaros.runtime.cli.outputs import has_display
from jacaros.runtime.cli.watching import log_address, open_page

PAGE = "http://localhost:1/token/"


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The opened pages; the user sits at a terminal of a desktop."""
    found: list[str] = []
    monkeypatch.setattr(webbrowser, "open", found.append)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    for name in ("WAYLAND_DISPLAY", "SSH_CONNECTION"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", ":0")
    return found


def test_the_page_is_opened_where_there_is_a_display(opened: list[str]) -> None:
    opening = open_page(PAGE)
    assert opening is not None
    opening.join(5)
    assert opened == [PAGE]


@pytest.mark.parametrize("lacking", ["display", "terminal", "errors"])
def test_no_page_is_opened_without_a_display(opened: list[str], monkeypatch, lacking: str):
    if lacking == "display":
        monkeypatch.delenv("DISPLAY")
    elif lacking == "terminal":
        monkeypatch.setattr(sys.stderr, "isatty", lambda: False)
    else:
        monkeypatch.setattr(sys, "stderr", None)
    assert open_page(PAGE) is None
    assert opened == []


def test_a_remote_shell_of_another_system_has_no_display(opened: list[str], monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    assert has_display()
    monkeypatch.setenv("SSH_CONNECTION", "1.2.3.4 1 2")
    assert not has_display()


def test_only_an_address_for_other_machines_logs_a_warning() -> None:
    told: list[tuple[str, str]] = []
    log_address(PAGE, "127.0.0.1", lambda text, level: told.append((text, level)))
    assert told == [(f"view: {PAGE}", "info")]
    log_address(PAGE, "0.0.0.0", lambda text, level: told.append((text, level)))
    assert told[-1][1] == "warning"
