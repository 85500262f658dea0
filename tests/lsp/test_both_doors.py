"""The command and the server report the same diagnostics, in the same order, for generated workspaces.

Each workspace has nested settings, imports across folders and out of them, scenes with and without programs, ignored
folders, and files that cannot be read.
"""

from __future__ import annotations

import json
import pathlib
import random
import re
import subprocess
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest
from raw import RawServer, answer, notification, request

SEEDS = range(60)
SETTINGS = "pydslrep.toml"
FOLDERS = ["", "a", "a/b", "r", "ignored"]
NAMES = ["main.pyr", "parts.pyr", "über.pyr"]
ENVIRONMENTS = ["yard", "hall"]
NOT_TEXT = b"wheel a\n\xff\n"
SEVERITIES = {1: "error", 2: "warning", 3: "information", 4: "hint"}
CLIENT = {
    # The command counts characters, too.
    "general": {"positionEncodings": ["utf-32"]},
    "window": {"workDoneProgress": True},
    "textDocument": {
        "publishDiagnostics": {"relatedInformation": True},
        "diagnostic": {"relatedInformation": True},
    },
}

WHEELS = "wheel a with radius 4\nwheel b with radius 4\n"
PARTS = [
    WHEELS,
    "robot r type tw with port 23000 has { a b } wheels\n",
    "robot s with port 23000 has { a c } wheels with sensors { eye }\n",
    "movement m of r { move 2 meters turn left }\n",
    "parallel movement n of s { move 1 meters }\n",
    "sensor eye\n",
    "wheel unused with radius 300\n",
    "wheel c with radius -1 /* ° 🤖 */ wheel d\n",
    "movement { move }\n",
    "wheel a with radius 5 // again\n",
]
SCENES = [
    "[[box]]\nname = 'crate'\nat = [1, 0]\nsize = [0.4, 0.4]\n",
    "[robots.r]\nstart = [0, 0, 90]\n",
    "[robots.s]\nstart = [1, 'x']\n[robots.t]\n",
    "# 机\n[robots.r.sensors.eye]\nrnage = 1\n",
    "[[box]\n",
]
TOMLS = [
    "",
    "target = 'vrep'\n",
    "[severity]\nunused-declaration = 'error'\nplanned-collision = 'off'\n",
    "output = 'scripts'\n[severity]\nunresolved-import = 'hint'\nno-environment = 'warning'\n",
]
WRONG_TOMLS = ["sevrity = 1\n", "[severity]\nwheel-count = 'warn'\nx = 2\n", "target ="]


@dataclass
class Corpus:
    """One generated workspace. Its folder is in another one, which may have settings and programs of its own."""

    root: pathlib.Path
    random: random.Random
    files: dict[str, bytes] = field(default_factory=dict)

    def generate(self) -> None:
        for folder in FOLDERS:
            for name in NAMES:
                if self.random.random() < 0.6:
                    self.files[join(folder, name)] = self.program(folder)
            for name in [*ENVIRONMENTS, "lone"]:
                if self.random.random() < 0.3:
                    scene = self.or_unreadable(self.random.choice(SCENES), 0.1)
                    self.files[join(folder, f"{name}.scene.toml")] = scene
            if self.random.random() < 0.4:
                self.files[join(folder, SETTINGS)] = self.settings()
        if self.random.random() < 0.3:
            self.files["../" + SETTINGS] = b""
        self.files["../outside.pyr"] = WHEELS.encode()
        self.files["../other/outside.pyr"] = b'import "../outside.pyr"\nsensor eye\n'
        self.files[".gitignore"] = b"ignored/\n"
        self.files.setdefault("main.pyr", self.program(""))
        for name, content in self.files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def program(self, folder: str) -> bytes:
        imports = [
            self.import_from(folder)
            for _ in range(self.random.choice([0, 0, 1, 1, 2, 3]))
        ]
        parts = self.random.sample(PARTS, self.random.randint(0, 5))
        if self.random.random() < 0.6:
            name = self.random.choice(ENVIRONMENTS)
            parts = [*PARTS[:2], PARTS[3], *parts]
            parts.append(f"environment {name} has {{ r }} robots with {{ m }} moves\n")
        return self.or_unreadable("".join([*imports, *parts]), 0.07)

    def import_from(self, folder: str) -> str:
        up = "../" * len(pathlib.PurePosixPath(folder).parts)
        target = self.random.choice(
            [
                up + join(self.random.choice(FOLDERS), self.random.choice(NAMES)),
                up + join(self.random.choice(FOLDERS), self.random.choice(NAMES)),
                self.random.choice(NAMES),
                up + "../outside.pyr",
                up + "../other/outside.pyr",
                "gone.pyr",
                "yard.scene.toml",
            ]
        )
        return f'import "{target}"\n'

    def settings(self) -> bytes:
        if self.random.random() < 0.05:
            return NOT_TEXT
        wrong = self.random.random() < 0.1
        return self.random.choice(WRONG_TOMLS if wrong else TOMLS).encode()

    def or_unreadable(self, text: str, probability: float) -> bytes:
        return NOT_TEXT if self.random.random() < probability else text.encode()

    def listed(self) -> list[str]:
        """What a search in the folder finds."""
        inside = [
            name for name in self.files if not name.startswith(("../", "ignored/", "."))
        ]
        return sorted(name for name in inside if name.endswith((".pyr", ".scene.toml")))

    def is_readable(self, name: str) -> bool:
        return self.files[name] != NOT_TEXT

    def settings_of(self, program: str) -> str | None:
        """The settings that hold for a program: the nearest."""
        for folder in [*pathlib.PurePosixPath(program).parents]:
            if (name := join(str(folder).removeprefix("."), SETTINGS)) in self.files:
                return name
        return "../" + SETTINGS if "../" + SETTINGS in self.files else None


def join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name


class Door:
    """A server, and a client that asks it for everything."""

    def __init__(self, server: RawServer, root: pathlib.Path) -> None:
        self.server = server
        self.root = root

    def start(self, *folders: pathlib.Path) -> None:
        open_folders = [{"uri": folder.as_uri(), "name": "it"} for folder in folders]
        params = {"capabilities": CLIENT, "workspaceFolders": open_folders}
        self.server.send(
            request(0, "initialize", params), notification("initialized", {})
        )
        self.until(lambda message: message.get("id") == 0)
        if folders:
            self.until(
                lambda message: (
                    message.get("params", {}).get("value", {}).get("kind") == "end"
                )
            )

    def until(self, is_wanted: Any) -> dict[str, Any]:
        while (message := self.server.read()) is not None:
            if "id" in message and "method" in message:
                self.server.send(answer(message["id"], None))
            elif is_wanted(message):
                return message
        raise AssertionError("the server left")

    def open(self, name: str) -> None:
        text = (self.root / name).read_text(encoding="utf-8")
        uri = (self.root / name).as_uri()
        document = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
        self.server.send(
            notification("textDocument/didOpen", {"textDocument": document})
        )

    def diagnostics(self) -> dict[str, list[dict[str, Any]]]:
        """Those of each document, in the order in which the server reports documents."""
        self.server.send(request(1, "workspace/diagnostic", {"previousResultIds": []}))
        items = self.until(lambda message: message.get("id") == 1)["result"]["items"]
        return {
            self.name(item["uri"]): [
                self.convert(self.name(item["uri"]), found) for found in item["items"]
            ]
            for item in items
        }

    def name(self, uri: str) -> str:
        path = pathlib.Path(unquote(urlsplit(uri).path))
        return (
            str(path.relative_to(self.root))
            if path.is_relative_to(self.root)
            else str(path)
        )

    def convert(self, name: str, found: dict[str, Any]) -> dict[str, Any]:
        related = [
            {
                "message": other["message"],
                "file": self.name(other["location"]["uri"]),
                "range": from_one(other["location"]["range"]),
            }
            for other in found.get("relatedInformation", [])
        ]
        return {
            "file": name,
            "code": found["code"],
            "severity": SEVERITIES[found["severity"]],
            "message": re.split(r"\n(?:help|note): ", found["message"])[0],
            "range": from_one(found["range"]),
            "related": related,
        }


def from_one(span: dict[str, dict[str, int]]) -> dict[str, dict[str, int]]:
    return {
        end: {"line": at["line"] + 1, "column": at["character"] + 1}
        for end, at in span.items()
    }


def check(
    command: str, root: pathlib.Path, *paths: str
) -> tuple[int, list[dict[str, Any]] | None, str]:
    """The exit code, the diagnostics if there are any to print, and the errors of `pydslrep check`."""
    done = subprocess.run(
        [command, "check", "--format", "json", *paths],
        cwd=root,
        capture_output=True,
        text=True,
        check=False,
        encoding="utf-8",
    )
    if not done.stdout:
        return done.returncode, None, done.stderr
    found = json.loads(done.stdout)
    for diagnostic in found:
        del diagnostic["fix"]
    return done.returncode, found, done.stderr


@pytest.fixture(params=SEEDS)
def corpus(request: pytest.FixtureRequest, tmp_path: pathlib.Path) -> Corpus:
    root = tmp_path / "root"
    root.mkdir()
    corpus = Corpus(root, random.Random(request.param))
    corpus.generate()
    return corpus


def test_a_folder_has_the_same_diagnostics_through_both_doors(
    corpus: Corpus, server: str, command: str
) -> None:
    with RawServer(server, "--stdio") as running:
        door = Door(running, corpus.root)
        door.start(corpus.root)
        served = door.diagnostics()
    code, found, errors = check(command, corpus.root)
    listed = corpus.listed()
    of_programs = {
        corpus.settings_of(name)
        for name in listed
        if name.endswith(".pyr") and corpus.is_readable(name)
    }
    settings = sorted(name for name in of_programs if name is not None)
    if unreadable := [name for name in settings if not corpus.is_readable(name)]:
        assert (code, found) == (2, None)
        assert f"cannot read {unreadable[0]}" in errors
        return
    if wrong := [
        problem["message"] for name in settings for problem in served.get(name, [])
    ]:
        assert (code, found) == (2, None)
        assert re.findall(r"^error: (.*)", errors, re.MULTILINE) == wrong
        return
    assert found is not None, errors
    assert found == [
        problem
        for name, problems in served.items()
        if name in listed
        for problem in problems
    ]
    assert re.findall(r"cannot read ([^:]*):", errors) == [
        name
        for name in sorted(listed, key=lambda name: (name.endswith(".toml"), name))
        if not corpus.is_readable(name)
    ]
    has_errors = any(problem["severity"] == "error" for problem in found)
    assert code == (2 if errors else int(has_errors))


def test_a_file_has_the_same_diagnostics_through_both_doors(
    corpus: Corpus, server: str, command: str
) -> None:
    programs = [
        name
        for name in corpus.listed()
        if name.endswith(".pyr") and corpus.is_readable(name)
    ]
    if not programs:
        return
    program = corpus.random.choice(programs)
    with RawServer(server, "--stdio") as running:
        door = Door(running, corpus.root)
        door.start()
        door.open(program)
        served = door.diagnostics()
    _, found, errors = check(command, corpus.root, program)
    if found is None:
        settings = corpus.settings_of(program)
        assert settings is not None, errors
        assert served.get(settings) or not corpus.is_readable(settings), errors
        return
    assert [problem for problem in found if problem["file"] == program] == served[
        program
    ]
