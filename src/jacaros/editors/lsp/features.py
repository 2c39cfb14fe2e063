"""What the language server can do, by the requests of the protocol."""

import asyncio
from collections.abc import Iterator
from typing import Any, Final

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from jacaros.agents.language.diagnostics import Span
from jacaros.editors import symbols
from jacaros.editors.lsp import editing, fixes, lenses
from jacaros.editors.lsp.answers import Answers
from jacaros.editors.lsp.colours import LEGEND, colours
from jacaros.editors.lsp.membership import PROGRAM
from jacaros.editors.lsp.outline import folds, outline_of
from jacaros.editors.lsp.outline import symbols as outline
from jacaros.editors.lsp.positions import path_of
from jacaros.editors.lsp.search import search
from jacaros.editors.lsp.server import Server
from jacaros.editors.symbols import RenameRefused
from jacaros.runtime.mas.checks.files import MAPPINGS, PROJECTS

_TRIGGERS: Final = ["!", "?", "+", "-", ".", "@", "(", "[", ":", " "]


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
    def opened(ls: Server, params: types.DidOpenTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def edited(ls: Server, params: types.DidChangeTextDocumentParams) -> None:
        ls.changed(path_of(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(ls: Server, params: types.DidCloseTextDocumentParams) -> None:
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
        answers, at = ls.asked(params.text_document.uri, params.position)
        if answers.file.name.endswith(PROGRAM):
            found = symbols.completions(ls.index_of(params.text_document.uri), answers.file, at)
        else:
            found = symbols.yaml_completions(answers.file, at)
        return types.CompletionList(False, [answers.completion(each) for each in found])

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def hover(ls: Server, params: types.HoverParams) -> types.Hover | None:
        answers, at = ls.asked(params.text_document.uri, params.position)
        found = None
        if not answers.file.name.endswith(MAPPINGS):
            found = symbols.hover(ls.index_of(params.text_document.uri), answers.file, at)
        if found is None and not answers.file.name.endswith(PROGRAM):
            found = symbols.yaml_hover(answers.file, at)
        return None if found is None else answers.hover(found)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def definition(ls: Server, params: types.DefinitionParams) -> list[types.Location]:
        answers, at = ls.asked(params.text_document.uri, params.position)
        return answers.places(symbols.definitions(ls.index_of(params.text_document.uri), answers.file, at))

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def references(ls: Server, params: types.ReferenceParams) -> list[types.Location]:
        answers, at = ls.asked(params.text_document.uri, params.position)
        index = ls.index_of(params.text_document.uri)
        found = symbols.references(index, answers.file, at, params.context.include_declaration)
        return answers.places(each.span for each in found)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlight(ls: Server, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        answers, at = ls.asked(params.text_document.uri, params.position)
        found = symbols.highlights(ls.index_of(params.text_document.uri), answers.file, at)
        return [answers.highlight(each) for each in found]


def _names(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare(ls: Server, params: types.PrepareRenameParams) -> types.Range:
        answers, at = ls.asked(params.text_document.uri, params.position)
        try:
            span = symbols.renamable(ls.index_of(params.text_document.uri), answers.file, at)
        except RenameRefused as refused:
            raise _refused(refused) from None
        return answers.positions.range(span)

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename(ls: Server, params: types.RenameParams) -> types.WorkspaceEdit:
        answers, at = ls.asked(params.text_document.uri, params.position)
        try:
            edits = symbols.rename(ls.index_of(params.text_document.uri), answers.file, at, params.new_name)
        except RenameRefused as refused:
            raise _refused(refused) from None
        return answers.edit(edits)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def in_document(ls: Server, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        answers = ls.answers(params.text_document.uri)
        return outline(outline_of(answers.file), answers.positions)

    @server.feature(types.WORKSPACE_SYMBOL)
    async def in_workspace(ls: Server, params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        codec = ls.workspace.position_codec
        return await asyncio.to_thread(search, ls.projects.roots, params.query, ls.texts(), codec)


def _refused(refused: RenameRefused) -> _Refused:
    return _Refused(f"{refused.message}\nhelp: {refused.help}" if refused.help else refused.message)


def _texts(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    def coloured(ls: Server, params: types.SemanticTokensParams) -> types.SemanticTokens:
        answers = ls.answers(params.text_document.uri)
        is_program = answers.file.name.endswith(PROGRAM)
        return types.SemanticTokens(colours(answers.file, answers.positions) if is_program else [])

    @server.feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
    def folded(ls: Server, params: types.FoldingRangeParams) -> list[types.FoldingRange] | None:
        file = ls.answers(params.text_document.uri).file
        return None if file.name.endswith(MAPPINGS) else folds(file, outline_of(file))

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
        found = symbols.hints(ls.index_of(params.text_document.uri), answers.file, first, last)
        return [answers.hint(each) for each in found]

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions([types.CodeActionKind.QuickFix]))
    def fixed(ls: Server, params: types.CodeActionParams) -> list[types.CodeAction]:
        uri = params.text_document.uri
        answers = ls.answers(uri)
        found = ls.found_in(uri, answers.file)
        wanted = [
            each for each in found if each.span is not None and _touches(answers, each.span, params.range)
        ]
        return list(_actions(ls, uri, wanted))


def _touches(answers: Answers, span: Span, wanted: types.Range) -> bool:
    place = answers.positions.range(span)
    return place.start.line <= wanted.end.line and wanted.start.line <= place.end.line


def _actions(ls: Server, uri: str, found: list[Any]) -> Iterator[types.CodeAction]:
    for each in found:
        yield from fixes.actions(each, uri, ls.workspace.position_codec, uri.endswith(PROGRAM))


def _commands(server: Server) -> None:
    @server.feature(types.TEXT_DOCUMENT_CODE_LENS)
    async def lensed(ls: Server, params: types.CodeLensParams) -> list[types.CodeLens]:
        answers = ls.answers(params.text_document.uri)
        path = path_of(params.text_document.uri)
        if path is None or not answers.file.name.endswith((PROGRAM, *PROJECTS)):
            return []
        recording = await ls.last_recording(path)
        return list(lenses.lenses(path, outline_of(answers.file), answers.positions, recording is not None))

    @server.command(lenses.EXPLAIN)
    async def explained(ls: Server, uri: str, line: int) -> str:
        """Return why the plan at a line did not run in the last recording."""
        path = path_of(uri)
        recording = await ls.last_recording(path) if path is not None else None
        if path is None or recording is None:
            return "no recording found; `jacaros run FILE --record run.jsonl` makes one"
        return await asyncio.to_thread(lenses.explain_plan, recording, path, line)
