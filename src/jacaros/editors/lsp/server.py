"""The language server: takes the texts of an editor, and answers its questions."""

import asyncio
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.editors.lsp.diagnostics import as_shown
from jacaros.editors.lsp.positions import path_of, uri_of
from jacaros.editors.lsp.projects import SUFFIXES, Projects
from jacaros.version import VERSION

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
        self._published: set[Path] = set()
        self._checking: asyncio.Task[None] | None = None

    def begin(self) -> None:
        """Take the folders that are open in the editor."""
        folders = (path_of(each) for each in self.workspace.folders)
        root = path_of(self.workspace.root_uri or "")
        self.projects.roots = [each for each in (*folders, root) if each is not None]

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
            except Exception as defect:
                text = f"internal error: {defect!r}; please file an issue with this program"
                self.window_log_message(types.LogMessageParams(types.MessageType.Error, text))
            else:
                self._publish(found.items())

    def _publish(self, found: Iterable[tuple[Path, list[Diagnostic]]]) -> None:
        for path, diagnostics in found:
            if not diagnostics and path not in self._published:
                continue
            (self._published.add if diagnostics else self._published.discard)(path)
            shown = [as_shown(each, self.workspace.position_codec) for each in diagnostics]
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri_of(path), shown))


def new_server() -> Server:
    """Return a server with all that it can do."""
    server = Server()

    @server.feature(types.INITIALIZED)
    def initialized(ls: Server, _: types.InitializedParams) -> None:
        ls.begin()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(ls: Server, params: types.DidOpenTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def edited(ls: Server, params: types.DidChangeTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(ls: Server, params: types.DidSaveTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(ls: Server, params: types.DidCloseTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    return server
