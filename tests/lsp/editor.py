"""An editor's side of the protocol: documents with versions, and edits applied to buffers and files.

Applying edits follows the protocol's words, not this server's habits: positions are clamped to the text, resource
operations happen in order, and a file that is open is edited in its buffer.
"""

from __future__ import annotations

import pathlib
import re
import subprocess
from typing import TYPE_CHECKING, Any, Union
from urllib.parse import unquote, urlsplit

from lsprotocol import types

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pytest_lsp import LanguageClient

LINE_ENDING = re.compile(r"\r\n|\n|\r")


def capabilities(editor: str) -> types.ClientCapabilities:
    """Capabilities of a client: `complete` (all known ones, pushed diagnostics), `pulling` (pulled diagnostics),
    `eager` (without resolving edits later), or `lines` (folding of whole lines only)."""
    resolve = types.ClientCodeActionResolveOptions(properties=["edit"])
    document = types.TextDocumentClientCapabilities(
        publish_diagnostics=types.PublishDiagnosticsClientCapabilities(
            related_information=True,
            version_support=True,
            code_description_support=True,
        ),
        diagnostic=types.DiagnosticClientCapabilities()
        if editor == "pulling"
        else None,
        completion=types.CompletionClientCapabilities(
            completion_item=types.ClientCompletionItemOptions(
                snippet_support=True,
                documentation_format=[types.MarkupKind.Markdown],
                resolve_support=None
                if editor == "eager"
                else types.ClientCompletionItemResolveOptions(["documentation"]),
            )
        ),
        hover=types.HoverClientCapabilities(content_format=[types.MarkupKind.Markdown]),
        definition=types.DefinitionClientCapabilities(link_support=True),
        declaration=types.DeclarationClientCapabilities(link_support=True),
        document_link=types.DocumentLinkClientCapabilities(tooltip_support=True),
        rename=types.RenameClientCapabilities(prepare_support=True),
        document_symbol=types.DocumentSymbolClientCapabilities(
            hierarchical_document_symbol_support=True
        ),
        signature_help=types.SignatureHelpClientCapabilities(
            signature_information=types.ClientSignatureInformationOptions(
                documentation_format=[types.MarkupKind.Markdown],
                parameter_information=types.ClientSignatureParameterInformationOptions(
                    label_offset_support=True
                ),
            )
        ),
        semantic_tokens=types.SemanticTokensClientCapabilities(
            requests=types.ClientSemanticTokensRequestOptions(
                range=True, full=types.ClientSemanticTokensRequestFullDelta(delta=True)
            ),
            token_types=[],
            token_modifiers=[],
            formats=[types.TokenFormat.Relative],
        ),
        folding_range=types.FoldingRangeClientCapabilities(
            line_folding_only=editor == "lines"
        ),
        code_action=types.CodeActionClientCapabilities(
            code_action_literal_support=types.ClientCodeActionLiteralOptions(
                code_action_kind=types.ClientCodeActionKindOptions(value_set=[])
            ),
            disabled_support=True,
            data_support=editor != "eager",
            resolve_support=None if editor == "eager" else resolve,
        ),
    )
    workspace = types.WorkspaceClientCapabilities(
        workspace_edit=types.WorkspaceEditClientCapabilities(
            document_changes=True,
            resource_operations=[types.ResourceOperationKind.Create],
        )
    )
    return types.ClientCapabilities(text_document=document, workspace=workspace)


def offset(text: str, position: types.Position) -> int:
    """Index of a position, counted in UTF-16, in a Python string."""
    lines = [0, *(match.end() for match in LINE_ENDING.finditer(text))]
    if position.line >= len(lines):
        return len(text)
    start = lines[position.line]
    ending = LINE_ENDING.search(text, start)
    line = text[start : ending.start() if ending else len(text)]
    units = line.encode("utf-16-le")[: 2 * position.character]
    return start + len(units.decode("utf-16-le", errors="ignore"))


def position(text: str, index: int) -> types.Position:
    """Position, counted in UTF-16, of an index into a Python string."""
    lines = [0, *(match.end() for match in LINE_ENDING.finditer(text, 0, index))]
    return types.Position(
        len(lines) - 1, len(text[lines[-1] : index].encode("utf-16-le")) // 2
    )


def apply_edits(text: str, edits: Sequence[types.TextEdit]) -> str:
    """Applies edits that all refer to the original text."""
    spans = sorted(
        (
            (
                offset(text, edit.range.start),
                offset(text, edit.range.end),
                edit.new_text,
            )
            for edit in edits
        ),
        reverse=True,
    )
    for start, end, new_text in spans:
        text = text[:start] + new_text + text[end:]
    return text


def tell_actions_from_commands(client: LanguageClient) -> None:
    """The client's library takes every action that has a command for one."""

    def structure(answer: Any, _: object) -> types.Command | types.CodeAction:
        if isinstance(answer.get("command"), str):
            return converter.structure(answer, types.Command)
        return converter.structure(answer, types.CodeAction)

    converter = client.protocol._converter
    either = Union[types.Command, types.CodeAction]  # noqa: UP007 (as in the library)
    converter.register_structure_hook(either, structure)


def built(command: str, folder: pathlib.Path, text: str) -> str:
    """The script of the program `table2.pyr` as the command builds it."""
    program = folder / "built" / "table2.pyr"
    program.parent.mkdir(exist_ok=True)
    program.write_text(text, encoding="utf-8")
    done = subprocess.run(
        [command, "build", "--stdout", program],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout


def to_path(uri: str) -> pathlib.Path:
    """The path of a file's URI."""
    return pathlib.Path(unquote(urlsplit(uri).path))


class Editor:
    """Open buffers over files; those of the server's languages are synchronised with the server."""

    def __init__(self, client: LanguageClient, folder: pathlib.Path) -> None:
        self.client = client
        self.folder = folder
        self.buffers: dict[str, str] = {}
        self.versions: dict[str, int] = {}

    def uri(self, name: str) -> str:
        """The URI of a file in the folder."""
        return (self.folder / name).as_uri()

    def open(self, name: str, text: str) -> str:
        """Opens a buffer, and notifies the server if it is a program."""
        uri = self.uri(name)
        self.buffers[uri] = text
        if name.endswith(".pyr"):
            self.versions[uri] = 1
            document = types.TextDocumentItem(uri, "pydslrep", 1, text)
            self.client.text_document_did_open(
                types.DidOpenTextDocumentParams(document)
            )
        return uri

    def replace(self, uri: str, old: str, new: str) -> None:
        """Types `new` over the only occurrence of `old`."""
        text = self.buffers[uri]
        assert text.count(old) == 1, f"{old!r} in {text!r}"
        at = text.index(old)
        self.edit(
            uri,
            types.TextEdit(
                types.Range(position(text, at), position(text, at + len(old))), new
            ),
        )

    def edit(self, uri: str, edit: types.TextEdit) -> None:
        """Makes one edit."""
        self.buffers[uri] = apply_edits(self.buffers[uri], [edit])
        if uri in self.versions:
            self.versions[uri] += 1
            document = types.VersionedTextDocumentIdentifier(self.versions[uri], uri)
            change = types.TextDocumentContentChangePartial(edit.range, edit.new_text)
            self.client.text_document_did_change(
                types.DidChangeTextDocumentParams(document, [change])
            )

    async def diagnostics(self, uri: str) -> list[types.Diagnostic]:
        """The next diagnostics published for a document, which must be for its current text."""
        pushed = await self.client.wait_for_notification(
            types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS
        )
        assert pushed.uri == uri
        assert pushed.version == self.versions[uri]
        return list(pushed.diagnostics)

    def apply(self, edit: types.WorkspaceEdit) -> None:
        """Applies an edit to open buffers, or else to files."""
        for uri, edits in (edit.changes or {}).items():
            self._change(uri, edits)
        for change in edit.document_changes or []:
            if isinstance(change, types.CreateFile):
                self._create(change)
            else:
                assert isinstance(change, types.TextDocumentEdit)
                expected = change.text_document.version
                assert (
                    expected is None
                    or expected == self.versions[change.text_document.uri]
                )
                self._change(
                    change.text_document.uri,
                    [e for e in change.edits if isinstance(e, types.TextEdit)],
                )

    def text(self, uri: str) -> str:
        """The text that the user sees: the buffer, or else the file."""
        return (
            self.buffers[uri]
            if uri in self.buffers
            else to_path(uri).read_text(encoding="utf-8")
        )

    def _create(self, change: types.CreateFile) -> None:
        path, options = to_path(change.uri), change.options or types.CreateFileOptions()
        if path.exists() and not options.overwrite:
            assert options.ignore_if_exists, f"{path} exists"
            return
        # As Neovim and Helix do: this empties the file, but not its buffer.
        path.write_text("", encoding="utf-8")

    def _change(self, uri: str, edits: Sequence[types.TextEdit]) -> None:
        if uri in self.versions:
            for edit in sorted(
                edits,
                key=lambda e: (e.range.start.line, e.range.start.character),
                reverse=True,
            ):
                self.edit(uri, edit)
        elif uri in self.buffers:
            self.buffers[uri] = apply_edits(self.buffers[uri], edits)
        else:
            path = to_path(uri)
            path.write_text(
                apply_edits(path.read_text(encoding="utf-8"), edits), encoding="utf-8"
            )
