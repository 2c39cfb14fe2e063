"""What the language server can do, by the requests of the protocol."""

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from jacaros.editors.lsp import editing, fixes, lenses, outline
from jacaros.editors.lsp.answers import as_shown
from jacaros.editors.lsp.colours import LEGEND, colours
from jacaros.editors.lsp.membership import PROGRAM
from jacaros.editors.lsp.positions import path_of
from jacaros.editors.lsp.server import Server
from jacaros.editors.symbols import navigation, renaming, yaml_keys
from jacaros.editors.symbols.completion import completions
from jacaros.editors.symbols.descriptions import hover
from jacaros.editors.symbols.hints import hints
from jacaros.editors.symbols.model import RenameRefused
from jacaros.runtime.mas.checks.files import MAPPINGS, PROJECTS

_TRIGGERS: Final = ["!", "?", "+", "-", ".", "@", "(", "[", ":", " "]


_OfDocument = (
    types.DidOpenTextDocumentParams | types.DidChangeTextDocumentParams | types.DidCloseTextDocumentParams
)


class _Refused(JsonRpcException):
    """An answer that the editor shows to its user."""

    CODE = -32803  # RequestFailed


def new_server() -> Server:
    """Return a server with all that it can do."""
    server = Server()
    for add in (_documents, _places, _names, _texts, _commands):
        add(server)
    return server


def _documents(server: Server) -> None:
    @server.feature(types.INITIALIZED)
    def initialized(ls: Server, _: types.InitializedParams) -> None:
        ls.begin()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def changed(ls: Server, params: _OfDocument) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def others_changed(ls: Server, params: types.DidChangeWatchedFilesParams) -> None:
        ls.files_changed()

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders_changed(ls: Server, params: types.DidChangeWorkspaceFoldersParams) -> None:
        ls.begin()
        ls.files_changed()


def _places(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=_TRIGGERS))
    def complete(ls: Server, params: types.CompletionParams) -> types.CompletionList:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        if answers.file.name.endswith(PROGRAM):
            found = completions(index, answers.file, at)
        else:
            found = yaml_keys.yaml_completions(answers.file, at)
        return types.CompletionList(False, [answers.completion(each) for each in found])

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def hovered(ls: Server, params: types.HoverParams) -> types.Hover | None:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        found = None
        if not answers.file.name.endswith(MAPPINGS):
            found = hover(index, answers.file, at)
        if found is None and not answers.file.name.endswith(PROGRAM):
            found = yaml_keys.yaml_hover(answers.file, at)
        return None if found is None else answers.hover(found)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def definition(ls: Server, params: types.DefinitionParams) -> list[types.Location]:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        return answers.places(navigation.definitions(index, answers.file, at))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def references(ls: Server, params: types.ReferenceParams) -> list[types.Location]:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        found = navigation.references(index, answers.file, at, params.context.include_declaration)
        return answers.places(each.span for each in found)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlight(ls: Server, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        found = navigation.highlights(index, answers.file, at)
        return [answers.highlight(each) for each in found]


def _names(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(ls: Server, params: types.PrepareRenameParams) -> types.Range:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        with _refusals():
            return answers.positions.range(renaming.renamable(index, answers.file, at))

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename(ls: Server, params: types.RenameParams) -> types.WorkspaceEdit:
        answers, index, at = ls.asked(params.text_document.uri, params.position)
        with _refusals():
            return answers.edit(renaming.rename(index, answers.file, at, params.new_name))

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def in_document(ls: Server, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        answers = ls.answers(params.text_document.uri)
        return outline.symbols(outline.outline_of(answers.file), answers.positions)

    @server.feature(types.WORKSPACE_SYMBOL)
    async def in_workspace(ls: Server, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        codec = ls.workspace.position_codec
        return await asyncio.to_thread(outline.search, ls.projects.roots, params.query, ls.texts(), codec)


@contextmanager
def _refusals() -> Iterator[None]:
    """Show why a name cannot be changed."""
    try:
        yield
    except RenameRefused as refused:
        raise _Refused(f"{refused.message}\nhelp: {refused.help}") from None


def _texts(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    def coloured(ls: Server, params: types.SemanticTokensParams) -> types.SemanticTokens:
        answers = ls.answers(params.text_document.uri)
        is_program = answers.file.name.endswith(PROGRAM)
        return types.SemanticTokens(colours(answers.file, answers.positions) if is_program else [])

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def folded(ls: Server, params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
        file = ls.answers(params.text_document.uri).file
        return None if file.name.endswith(MAPPINGS) else outline.folds(file, outline.outline_of(file))

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def formatted(ls: Server, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        file = ls.answers(params.text_document.uri).file
        return editing.formatting(file) if file.name.endswith(PROGRAM) else []

    @server.feature(types.TEXT_DOCUMENT_INLAY_HINT)
    def hinted(ls: Server, params: types.InlayHintParams) -> list[types.InlayHint]:
        answers = ls.answers(params.text_document.uri)
        if not answers.file.name.endswith(PROGRAM):
            return []
        first, last = params.range.start.line + 1, params.range.end.line + 1
        found = hints(ls.index_of(params.text_document.uri), answers.file, first, last)
        return [answers.hint(each) for each in found]

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions([types.CodeActionKind.QuickFix]))
    def fixed(ls: Server, params: types.CodeActionParams) -> list[types.CodeAction]:
        uri = params.text_document.uri
        answers, codec = ls.answers(uri), ls.workspace.position_codec
        return [
            action
            for each in ls.found_in(uri, answers.file)
            if _touches(as_shown(each, codec).range, params.range)
            for action in fixes.actions(each, uri, codec, uri.endswith(PROGRAM))
        ]


def _touches(place: types.Range, wanted: types.Range) -> bool:
    return place.start.line <= wanted.end.line and wanted.start.line <= place.end.line


def _commands(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def lensed(ls: Server, params: types.CodeLensParams) -> list[types.CodeLens]:
        answers = ls.answers(params.text_document.uri)
        path = path_of(params.text_document.uri)
        if path is None or not answers.file.name.endswith((PROGRAM, *PROJECTS)):
            return []
        recording, entries = await ls.last_recording(path), outline.outline_of(answers.file)
        return list(lenses.lenses(path, entries, answers.positions, recording is not None))

    @server.command(lenses.EXPLAIN)
    async def explained(ls: Server, uri: str, line: int) -> str:
        """Return why the plan at a line did not run in the last recording."""
        path = path_of(uri)
        recording = await ls.last_recording(path) if path is not None else None
        if path is None or recording is None:
            return "no recording found; `jacaros run FILE --record run.jsonl` makes one"
        return await asyncio.to_thread(lenses.explain_plan, recording, path, line)
