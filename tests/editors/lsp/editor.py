"""An editor for tests: a client that starts ``jacaros lsp`` as editors do, and speaks the protocol with it."""

import asyncio
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

from lsprotocol import types
from pytest_lsp import LanguageClient, client_capabilities

SECONDS = 120.0
"""How long the tests wait for an answer on a busy machine."""


class Editor:
    """One editor with one folder open."""

    def __init__(self, folder: Path, client: LanguageClient) -> None:
        self.folder, self.client = folder.resolve(), client
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
        return list(self.client.diagnostics.get(self.uri(name), ()))

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
    client = LanguageClient()
    editor = Editor(folder, client)

    @client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    async def published(_: LanguageClient, params: types.PublishDiagnosticsParams) -> None:
        client.diagnostics[params.uri] = params.diagnostics
        await editor.heard()

    await client.start_io(sys.executable, "-m", "jacaros", "lsp", cwd=folder)
    capabilities = client_capabilities("visual-studio-code")
    capabilities.general = types.GeneralClientCapabilities(position_encodings=encodings)
    folders = [types.WorkspaceFolder(editor.folder.as_uri(), folder.name)]
    params = types.InitializeParams(capabilities=capabilities, workspace_folders=folders)
    try:
        result = await asyncio.wait_for(client.initialize_session(params), SECONDS)
        editor.capabilities = result.capabilities
        await use(editor)
        await asyncio.wait_for(client.shutdown_session(), SECONDS)
    finally:
        if client._server is not None and client._server.returncode is None:
            client._server.kill()  # the test has failed: stop() would wait for the server
        await client.stop()
