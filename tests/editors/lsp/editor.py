"""An editor for tests: a client that starts ``jacaros lsp`` as editors do, and speaks the protocol with it."""

import asyncio
import sys
from collections.abc import Awaitable, Callable, Sequence
from pathlib import Path
from typing import Any

from lsprotocol import converters, types
from pygls.lsp.client import LanguageClient

SECONDS = 120.0
"""How long the tests wait for an answer on a busy machine."""

SUPPORTED = {
    "workspace": {
        "didChangeWatchedFiles": {"dynamicRegistration": True},
        "inlayHint": {"refreshSupport": True},
        "workspaceEdit": {"documentChanges": True},
    },
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True, "documentationFormat": ["markdown"]}},
        "codeAction": {"codeActionLiteralSupport": {"codeActionKind": {"valueSet": ["quickfix"]}}},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
        "hover": {"contentFormat": ["markdown"]},
    },
}
"""What VS Code says it supports, as far as it matters to a server."""


class Editor:
    """One editor with one folder open."""

    def __init__(self, folder: Path, client: LanguageClient) -> None:
        self.folder, self.client = folder.resolve(), client
        self.published: dict[str, Sequence[types.Diagnostic]] = {}
        self.logged: list[str] = []
        self.capabilities: types.ServerCapabilities | None = None
        self._versions: dict[str, int] = {}
        self._reported = asyncio.Condition()
        self._reports: dict[str, int] = {}

    def uri(self, name: str) -> str:
        return (self.folder / name).as_uri()

    def document(self, name: str) -> types.TextDocumentIdentifier:
        return types.TextDocumentIdentifier(self.uri(name))

    async def open(self, name: str, text: str | None = None) -> None:
        uri = self.uri(name)
        text = (self.folder / name).read_text(encoding="utf-8") if text is None else text
        self._versions[uri] = 1
        item = types.TextDocumentItem(uri, Path(name).suffix[1:], 1, text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(item))

    def edit(self, name: str, text: str) -> None:
        uri = self.uri(name)
        self._versions[uri] += 1
        document = types.VersionedTextDocumentIdentifier(uri=uri, version=self._versions[uri])
        change = types.TextDocumentContentChangeWholeDocument(text)
        self.client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))

    def close(self, name: str) -> None:
        self.client.text_document_did_close(types.DidCloseTextDocumentParams(self.document(name)))

    def diagnostics(self, name: str) -> list[types.Diagnostic]:
        return list(self.published.get(self.uri(name), ()))

    async def until(self, met: Callable[[], bool]) -> None:
        """Wait until diagnostics meet a condition."""
        async with asyncio.timeout(SECONDS), self._reported:
            await self._reported.wait_for(met)

    async def heard(self) -> None:
        async with self._reported:
            self._reported.notify_all()

    def at(self, name: str, line: int, character: int) -> dict[str, Any]:
        """Return what requests about a place have in common; both count from 0."""
        return {"text_document": self.document(name), "position": types.Position(line, character)}


def with_editor(
    folder: Path,
    use: Callable[[Editor], Awaitable[None]],
    encodings: list[types.PositionEncodingKind] | None = None,
) -> None:
    """Open a folder in an editor, and close it afterwards."""
    asyncio.run(_session(folder, use, encodings))


async def _session(
    folder: Path,
    use: Callable[[Editor], Awaitable[None]],
    encodings: list[types.PositionEncodingKind] | None,
) -> None:
    client = LanguageClient("tests", "1")
    editor = Editor(folder, client)
    registered = asyncio.Event()
    ended = False

    @client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    async def published(params: types.PublishDiagnosticsParams) -> None:
        editor.published[params.uri] = params.diagnostics
        await editor.heard()

    @client.feature(types.WINDOW_LOG_MESSAGE)
    def log(params: types.LogMessageParams) -> None:
        editor.logged.append(params.message)

    @client.feature(types.CLIENT_REGISTER_CAPABILITY)
    def register(_: types.RegistrationParams) -> None:
        registered.set()

    @client.feature(types.WORKSPACE_INLAY_HINT_REFRESH)
    def refresh(_: None) -> None:
        """Ask for no hints again: tests ask when they want them."""

    await client.start_io(sys.executable, "-m", "jacaros", "lsp", cwd=folder)
    capabilities = converters.get_converter().structure(SUPPORTED, types.ClientCapabilities)
    capabilities.general = types.GeneralClientCapabilities(position_encodings=encodings)
    folders = [types.WorkspaceFolder(editor.folder.as_uri(), folder.name)]
    try:
        result = await asyncio.wait_for(
            client.initialize_async(types.InitializeParams(capabilities, workspace_folders=folders)), SECONDS
        )
        editor.capabilities = result.capabilities
        client.initialized(types.InitializedParams())
        await asyncio.wait_for(registered.wait(), SECONDS)
        await use(editor)
        await asyncio.wait_for(client.shutdown_async(None), SECONDS)
        client.exit(None)
        ended = True
    finally:
        if not ended and client._server is not None:
            client._server.kill()  # stop() would wait for the server
        await client.stop()
