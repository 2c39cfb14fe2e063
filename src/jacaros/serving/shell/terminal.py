"""The console in a terminal: a prompt with history and completion. Lines of the run appear above it."""

import sys
import threading
from collections.abc import Iterator
from contextlib import redirect_stdout, suppress
from pathlib import Path
from typing import TextIO, cast

from prompt_toolkit import PromptSession
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.input import create_input
from prompt_toolkit.patch_stdout import StdoutProxy

from jacaros.runtime.files.texts import kept_files, visible
from jacaros.runtime.output import beneath
from jacaros.serving.client import Offered
from jacaros.serving.shell.dialogue import SIGNS, Dialogue

PROMPT = "> "
_SOON = 0.05
"""Seconds for which lines above the prompt are collected: each redraws it."""


class OfferCompleter(Completer):
    """Completes commands, what is offered, and arguments with a few possible values.

    Args:
        dialogue: knows the commands and offers.
    """

    def __init__(self, dialogue: Dialogue) -> None:
        self._dialogue = dialogue

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterator[Completion]:
        """Yield what the text before the cursor may become."""
        del complete_event
        text = document.text_before_cursor.lstrip()
        if "(" in text:
            yield from self._values(text)
            return
        for command in self._dialogue.commands:
            if text and command.startswith(text):
                yield Completion(command, -len(text))
        for each in self._dialogue.offers:
            for sign in _signs(each):
                written = f"{sign}{each.name}{'(' if '(' in each.form else ''}"
                if text and written.startswith(text) and written != text:
                    yield Completion(written, -len(text), f"{sign}{each.form}", each.doc)

    def _values(self, text: str) -> Iterator[Completion]:
        head, _, arguments = text.partition("(")
        place = arguments.count(",")
        begun = arguments.rpartition(",")[2].lstrip()
        for each in self._dialogue.offers:
            if head.endswith(each.name) and place < len(each.choices):
                for value in each.choices[place]:
                    if value.startswith(begun):
                        yield Completion(value, -len(begun))


def _signs(offer: Offered) -> tuple[str, ...]:
    sign = SIGNS.get(offer.kind)
    return () if sign is None else (sign, "-") if sign == "+" else (sign,)


class Terminal:
    """The terminal of this process.

    Attributes:
        stream: prints complete lines above the prompt; any thread may write.
    """

    def __init__(self) -> None:
        with redirect_stdout(beneath(sys.stdout)):  # prompt_toolkit keeps the stream, and escapes by itself
            self.stream = cast(TextIO, StdoutProxy(_SOON))
        self._input = create_input()
        # Otherwise Ctrl+C would end a run in the moments when lines are printed above the prompt.
        self._input.cooked_mode = self._input.raw_mode  # type: ignore[method-assign]
        self._session: PromptSession[str] = PromptSession(
            PROMPT,
            input=self._input,
            history=_history(),
            auto_suggest=AutoSuggestFromHistory(),
            reserve_space_for_menu=4,
        )
        self._left = False

    def show(self, text: str) -> None:
        """Print lines above the prompt."""
        self.stream.write(visible(f"{text}\n"))

    def read(self, dialogue: Dialogue) -> None:
        """Read lines and execute them, until the user leaves, or `leave`."""
        completer = OfferCompleter(dialogue)
        is_main = threading.current_thread() is threading.main_thread()
        # While a line is executed, keys are kept for the next one, and Ctrl+C does not end a run of this process.
        with self._input.raw_mode():
            while not self._left:
                try:
                    line = self._session.prompt(completer=completer, handle_sigint=is_main)
                    if line.strip() in ("quit", "exit"):
                        return
                    dialogue.execute(line)
                except KeyboardInterrupt:
                    continue  # Ctrl+C clears the line
                except EOFError:
                    return

    def leave(self) -> None:
        """End `read`, and restore the terminal. Any thread may call it."""
        self._left = True
        app = self._session.app

        def exit() -> None:
            if app.is_running:
                app.exit(exception=EOFError)

        if app.is_running and app.loop is not None:
            with suppress(RuntimeError):  # it has just ended
                app.loop.call_soon_threadsafe(exit)

    def close(self) -> None:
        """Print what has not been printed."""
        cast(StdoutProxy, self.stream).close()


def _history() -> History:
    folder = kept_files()
    return InMemoryHistory() if folder is None else FileHistory(str(_private(folder / "console_history")))


def _private(path: Path) -> Path:
    """Create a file that only this user can read."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch(mode=0o600)
    return path
