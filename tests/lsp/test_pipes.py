"""Pipes and devices in a folder: the server neither waits for them nor loses its input to them."""

from __future__ import annotations

import os
import pathlib

from raw import RawServer, notification, request


def test_no_pipe_or_device_is_read(
    server: str, tmp_path: pathlib.Path, table_2: str
) -> None:
    (tmp_path / "input.pyr").symlink_to("/dev/stdin")
    (tmp_path / "device.pyr").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "pipe.pyr")
    os.mkfifo(tmp_path / "area_1.scene.toml")
    os.mkfifo(tmp_path / "pydslrep.toml")
    program = 'import "pipe.pyr"\nimport "input.pyr"\n' + table_2
    uri = (tmp_path / "p.pyr").as_uri()
    with RawServer(server, "--stdio") as raw:
        folders = [{"uri": tmp_path.as_uri(), "name": "it"}]
        asked = {"capabilities": {}, "workspaceFolders": folders}
        raw.send(request(0, "initialize", asked), notification("initialized", {}))
        raw.answer(0)
        item = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": program}
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))
        place = {"textDocument": {"uri": uri}, "position": {"line": 2, "character": 1}}
        for ident in range(1, 20):
            raw.send(request(ident, "textDocument/hover", place))
            assert "result" in raw.answer(ident)
        raw.send(request(20, "shutdown", None))
        raw.answer(20)
        raw.send(notification("exit", None))
        assert raw.leave() == 0
