"""Navigation from names to their declarations and references, across files."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, position
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

# Columns after the comments differ in bytes, UTF-16 code units and characters.
PARTS = "/* 🤖é */ wheel a with radius 4\n/* 🤖é */ wheel b with radius 4\n"
MAIN = (
    'import "parts.pyr"\n'
    "/* 🤖é */ robot rover with port 1 has { a b } wheels\n"
    "/* 🤖é */ movement lap of rover { move 1 meters }\n"
    "/* 🤖é */ environment yard has { rover } robots with { lap lap } moves\n"
)


class Program:
    """`main.pyr` and `parts.pyr`, open in an editor."""

    def __init__(self, client: LanguageClient, folder: pathlib.Path) -> None:
        self.editor = Editor(client, folder)
        self.parts = self.editor.open("parts.pyr", PARTS)
        self.main = self.editor.open("main.pyr", MAIN)

    def at(self, uri: str, before: str, following: str = "") -> types.Position:
        """The position between two texts that follow each other once."""
        text = self.editor.text(uri)
        assert text.count(before + following) == 1
        return position(text, text.index(before + following) + len(before))

    def where(
        self, uri: str, before: str, following: str = ""
    ) -> tuple[types.TextDocumentIdentifier, types.Position]:
        """The position as parameters of most requests."""
        return types.TextDocumentIdentifier(uri), self.at(uri, before, following)

    def shown(self, uri: str, span: types.Range) -> str:
        """The document and line of a location."""
        line = self.editor.text(uri).splitlines()[span.start.line]
        units = line.encode("utf-16-le")
        start, end = 2 * span.start.character, 2 * span.end.character
        name = uri.rsplit("/", 1)[1]
        return f"{name}:{span.start.line} {units[start:end].decode('utf-16-le')}"


@pytest.fixture
def program(client: LanguageClient, tmp_path: pathlib.Path) -> Program:
    return Program(client, tmp_path)


async def test_declarations_and_types(client: LanguageClient, program: Program) -> None:
    uri = program.main
    declared = await client.text_document_declaration_async(
        types.DeclarationParams(*program.where(uri, "{ a"))
    )
    assert isinstance(declared, list)
    [link] = declared
    assert isinstance(link, types.LocationLink)
    assert program.shown(link.target_uri, link.target_selection_range) == (
        "parts.pyr:0 a"
    )

    robots = await client.text_document_type_definition_async(
        types.TypeDefinitionParams(*program.where(uri, "{ lap"))
    )
    assert isinstance(robots, list)
    [robot] = robots
    assert isinstance(robot, types.Location), "no links were asked for"
    assert program.shown(robot.uri, robot.range) == "main.pyr:1 rover"


async def test_references_and_highlights(
    client: LanguageClient, program: Program
) -> None:
    async def references(*, declaration: bool) -> list[str]:
        found = await client.text_document_references_async(
            types.ReferenceParams(
                types.ReferenceContext(include_declaration=declaration),
                *program.where(program.parts, "wheel a"),
            )
        )
        return [program.shown(place.uri, place.range) for place in found or []]

    assert await references(declaration=True) == ["parts.pyr:0 a", "main.pyr:1 a"]
    assert await references(declaration=False) == ["main.pyr:1 a"]

    found = await client.text_document_document_highlight_async(
        types.DocumentHighlightParams(*program.where(program.main, "movement lap"))
    )
    write, read = types.DocumentHighlightKind.Write, types.DocumentHighlightKind.Read
    assert [
        (program.shown(program.main, place.range), place.kind) for place in found or []
    ] == [("main.pyr:2 lap", write), ("main.pyr:3 lap", read), ("main.pyr:3 lap", read)]


async def test_a_rename_across_files(client: LanguageClient, program: Program) -> None:
    prepared = await client.text_document_prepare_rename_async(
        types.PrepareRenameParams(*program.where(program.main, "{ a"))
    )
    assert isinstance(prepared, types.PrepareRenamePlaceholder)
    assert prepared.placeholder == "a"
    assert program.shown(program.main, prepared.range) == "main.pyr:1 a"

    # The editor checks that each edit is for its version.
    edit = await client.text_document_rename_async(
        types.RenameParams(*program.where(program.main, "{ a"), new_name="left_1")
    )
    assert edit
    assert edit.document_changes
    program.editor.apply(edit)
    assert program.editor.text(program.parts) == PARTS.replace(
        "wheel a", "wheel left_1"
    )
    assert program.editor.text(program.main) == MAIN.replace("{ a", "{ left_1")


@pytest.mark.parametrize(
    ("new", "code", "word"),
    [
        ("b", types.LSPErrorCodes.RequestFailed, "there is already a wheel"),
        ("robots", types.ErrorCodes.InvalidParams, "^robots"),
        ("two words", types.ErrorCodes.InvalidParams, "not a valid name"),
    ],
)
async def test_a_rename_that_is_refused_says_why(
    client: LanguageClient, program: Program, new: str, code: int, word: str
) -> None:
    with pytest.raises(JsonRpcException) as refused:
        await client.text_document_rename_async(
            types.RenameParams(*program.where(program.main, "{ a"), new_name=new)
        )
    assert refused.value.code == code
    assert word in refused.value.message
    with pytest.raises(JsonRpcException, match="no name to rename here"):
        await client.text_document_prepare_rename_async(
            types.PrepareRenameParams(*program.where(program.main, "ro", "bot rover"))
        )


async def test_names_of_one_file_are_edited_together(
    client: LanguageClient, program: Program
) -> None:
    linked = await client.text_document_linked_editing_range_async(
        types.LinkedEditingRangeParams(*program.where(program.main, "{ lap"))
    )
    assert linked
    assert [program.shown(program.main, place) for place in linked.ranges] == [
        "main.pyr:2 lap",
        "main.pyr:3 lap",
        "main.pyr:3 lap",
    ]
    shared = types.LinkedEditingRangeParams(*program.where(program.parts, "wheel a"))
    assert not await client.text_document_linked_editing_range_async(shared)


async def test_symbols_of_all_files(client: LanguageClient, program: Program) -> None:
    async def found(query: str) -> list[tuple[str, str | None]]:
        symbols = await client.workspace_symbol_async(
            types.WorkspaceSymbolParams(query)
        )
        result = []
        for symbol in symbols or []:
            place = symbol.location
            assert isinstance(place, types.Location)
            assert program.shown(place.uri, place.range).endswith(f" {symbol.name}")
            result.append((symbol.name, symbol.container_name))
        return result

    assert await found("RVR") == [("rover", None)]
    assert await found("lp") == [("lap", "rover")]
    assert [name for name, _ in await found("")] == ["a", "b", "rover", "lap", "yard"]


async def test_from_an_environment_to_its_robots_and_back(
    client: LanguageClient, program: Program
) -> None:
    async def prepared(before: str) -> types.CallHierarchyItem:
        where = program.where(program.main, before)
        items = await client.text_document_prepare_call_hierarchy_async(
            types.CallHierarchyPrepareParams(*where)
        )
        assert items
        [item] = items
        return item

    yard = await prepared("environment yard")
    runs = await client.call_hierarchy_outgoing_calls_async(
        types.CallHierarchyOutgoingCallsParams(yard)
    )
    assert runs
    [run] = runs
    assert run.to.name == "lap"
    assert [program.shown(program.main, place) for place in run.from_ranges] == [
        "main.pyr:3 lap",
        "main.pyr:3 lap",
    ]

    rover = await prepared("of rover")
    drivers = await client.call_hierarchy_incoming_calls_async(
        types.CallHierarchyIncomingCallsParams(rover)
    )
    assert drivers
    [driver] = drivers
    assert driver.from_.name == "lap"
    assert program.shown(program.main, driver.from_.selection_range) == "main.pyr:2 lap"
    [use] = driver.from_ranges
    assert program.shown(program.main, use) == "main.pyr:2 rover"


async def test_imports_are_links(client: LanguageClient, program: Program) -> None:
    links = await client.text_document_document_link_async(
        types.DocumentLinkParams(types.TextDocumentIdentifier(program.main))
    )
    assert links
    [link] = links
    assert program.shown(program.main, link.range) == "main.pyr:0 parts.pyr"
    assert (link.target, link.tooltip) == (program.parts, "Open parts.pyr: 2 wheels")
