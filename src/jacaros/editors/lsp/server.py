"""The language server: takes the texts of an editor, and answers its questions."""

import asyncio
import time
import traceback
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.capabilities import get_capability
from pygls.lsp.server import LanguageServer

from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.editors.lsp.answers import Answers, as_shown
from jacaros.editors.lsp.lenses import last_recording
from jacaros.editors.lsp.membership import roots_of
from jacaros.editors.lsp.positions import path_of, uri_of
from jacaros.editors.lsp.projects import SUFFIXES, Projects
from jacaros.editors.symbols.index import Index
from jacaros.editors.symbols.model import Position
from jacaros.version import VERSION

_WATCHED: Final = "**/*.{asl,jcm,mas2j,py,yaml,yml,jsonl,gz}"
OFTEN: Final = 5.0
"""Seconds between searches for recordings."""
PAUSE: Final = 0.03
"""Seconds between an edit and the check, so that fast typing is checked less often."""


class Server(LanguageServer):
    """The state of one editor: its open texts, and what was found in them.

    Attributes:
        projects: what open files belong to. A check runs in another thread, one at a time.
    """

    def __init__(self) -> None:
        # In full: pygls splits lines at more characters than the protocol does, so ranges could shift.
        super().__init__("jacaros", VERSION, text_document_sync_kind=types.TextDocumentSyncKind.Full)
        self.projects = Projects()
        self._changed: dict[Path, None] = {}
        self._found: dict[Path, list[Diagnostic]] = {}
        self._nothing = Index()
        self._checking: asyncio.Task[None] | None = None
        self._watches = False
        self._recordings: dict[tuple[Path, ...], tuple[float, Path | None]] = {}

    def begin(self) -> None:
        """Take the folders that are open in the editor."""
        folders = (path_of(each) for each in self.workspace.folders)
        root = path_of(self.workspace.root_uri or "")
        self.projects.roots = [each for each in (*folders, root) if each is not None]
        self._watch()

    def _watch(self) -> None:
        """Have the client report files that change outside the editor, or in other kinds of documents."""
        if self._watches or not self._can("workspace.did_change_watched_files.dynamic_registration"):
            return
        self._watches = True
        options = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher(_WATCHED)])
        kind = types.WORKSPACE_DID_CHANGE_WATCHED_FILES
        registration = types.Registration("jacaros-files", kind, options)
        self.client_register_capability(types.RegistrationParams([registration]))

    def _can(self, capability: str) -> bool:
        """Return whether the client has a capability."""
        return bool(get_capability(self.client_capabilities, capability, False))

    def files_changed(self) -> None:
        """Check everything again: files have changed outside the editor."""
        self.projects.files_changed()
        self.changed(*self.texts())

    # What is asked about a document.

    def answers(self, uri: str) -> Answers:
        """Return what converts answers about a document."""
        path = path_of(uri)
        text = self.workspace.get_text_document(uri).source.replace("\r\n", "\n").replace("\r", "\n")
        units = self.projects.units_of(path) if path is not None else []
        name = units[0].name_of(path) if path is not None and units else str(path or uri)
        has_snippets = self._can("text_document.completion.completion_item.snippet_support")
        return Answers(SourceFile(name, text), self.workspace.position_codec, has_snippets)

    def asked(self, uri: str, place: types.Position) -> tuple[Answers, Index, Position]:
        """Return what converts answers about a document, the names that it can use, and the place of a request."""
        answers = self.answers(uri)
        return answers, self.index_of(uri), Position(*answers.positions.from_client(place))

    def index_of(self, uri: str) -> Index:
        """Return the names that a document can use; those of the language until its project has been read."""
        path = path_of(uri)
        units = self.projects.units_of(path) if path is not None else []
        return next((each.index for each in units if each.index is not None), self._nothing)

    def found_in(self, uri: str, file: SourceFile) -> list[Diagnostic]:
        """Return the diagnostics of a document, unless its text has changed since."""
        path = path_of(uri)
        found = self._found.get(path, []) if path is not None else []
        return [each for each in found if each.span is not None and each.span.file.lines == file.lines]

    async def last_recording(self, path: Path) -> Path | None:
        """Return the newest recording in the folders of a file's project. They are searched every few seconds only."""
        folders = tuple(roots_of(self.projects.roots, path))
        searched, found = self._recordings.get(folders, (-OFTEN, None))
        if time.monotonic() - searched >= OFTEN:
            found = await asyncio.to_thread(last_recording, folders)
            self._recordings[folders] = time.monotonic(), found
        return found

    # Checking.

    def texts(self) -> dict[Path, str]:
        """Return the open texts, by file."""
        documents = self.workspace.text_documents.values()
        found = ((path_of(each.uri), each.source) for each in documents)
        return {path: text for path, text in found if path is not None and path.suffix in SUFFIXES}

    def changed(self, *paths: Path | None) -> None:
        """Check soon what changed files belong to."""
        self._changed |= dict.fromkeys(each for each in paths if each is not None)
        if self._changed and (self._checking is None or self._checking.done()):
            self._checking = asyncio.create_task(self._check())

    async def _check(self) -> None:
        while self._changed:
            await asyncio.sleep(PAUSE)
            changed, self._changed = [*self._changed], {}
            try:
                found = await asyncio.to_thread(self.projects.update, changed, self.texts())
                self._publish(found.items())
                await self._index()
            except Exception as defect:  # the next edit is checked all the same
                traceback.print_exception(defect)
                text = f"internal error: {defect!r}; please file an issue with this program"
                self.window_log_message(types.LogMessageParams(types.MessageType.Error, text))

    async def _index(self) -> None:
        """Read the meaning of names again, after the diagnostics: a user waits for these."""
        is_first = await asyncio.to_thread(self.projects.index, self.texts())
        if is_first and self._can("workspace.inlay_hint.refresh_support"):
            self.workspace_inlay_hint_refresh(None)  # the answer says nothing

    def _publish(self, found: Iterable[tuple[Path, list[Diagnostic]]]) -> None:
        for path, diagnostics in found:
            if not diagnostics and not self._found.get(path):
                continue
            self._found[path] = diagnostics
            shown = [as_shown(each, self.workspace.position_codec) for each in diagnostics]
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri_of(path), shown))
