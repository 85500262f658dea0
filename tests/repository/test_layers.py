"""The dependencies between crates are those in docs/architecture.md."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# Lowest first. A crate may know those named here and nothing else of ours.
MAY_KNOW: dict[str, set[str]] = {
    "text": set(),
    "robots": set(),
    "syntax": {"text", "robots"},
    "schema": {"text"},
    "kinematics": {"robots"},
    "scene": {"text", "schema", "kinematics"},
    "analysis": {"text", "syntax", "schema", "kinematics", "scene"},
    "config": {"text", "schema", "kinematics", "analysis"},
    "ide": {"config", "analysis", "syntax", "schema", "kinematics", "scene"},
    "script": {"analysis", "kinematics"},
    "workspace": {"text", "syntax", "analysis", "config", "scene"},
    "files": {"text", "workspace"},
    "output": {"script", "workspace", "files"},
    "trace": {"kinematics"},
    "bag": {"kinematics", "trace"},
    "picture": {"kinematics", "scene", "trace"},
    "simulator": {"kinematics", "scene", "trace"},
    "server": {
        "text",
        "ide",
        "script",
        "config",
        "analysis",
        "syntax",
        "kinematics",
        "scene",
        "trace",
        "workspace",
        "output",
        "files",
    },
    "browser": {
        "analysis",
        "script",
        "workspace",
        "trace",
        "simulator",
        "server",
    },
    "cli": {
        "text",
        "syntax",
        "schema",
        "kinematics",
        "scene",
        "analysis",
        "bag",
        "config",
        "ide",
        "script",
        "workspace",
        "output",
        "files",
        "trace",
        "picture",
        "simulator",
        "server",
    },
}

# The reference checker for tests, independent of all other crates.
STANDALONE: dict[str, Path] = {"naive": ROOT / "tests" / "naive"}

# Who may know what of the world outside.
ONLY_IN: dict[str, set[str]] = {
    "tower-lsp": {"server"},
    "clap": {"cli", "server"},
    "tokio": {"server", "simulator", "cli"},
    "hyper": {"server"},
    "chumsky": {"text", "syntax"},
    "logos": {"syntax"},
    "ropey": {"text", "analysis", "workspace", "server", "browser", "cli"},
    "rust-embed": {"script"},
    "wasm-bindgen": {"browser"},
    "svg": {"picture"},
    "resvg": {"picture"},
    "toml": {"schema"},
    "toml_parser": {"schema"},
}

# Files, clocks, threads and sockets stay out of what is to run in a browser.
PURE = [
    "text",
    "robots",
    "syntax",
    "schema",
    "kinematics",
    "scene",
    "analysis",
    "config",
    "ide",
    "script",
    "workspace",
    "trace",
    "picture",
]
IMPURE = re.compile(
    r"\bstd::(fs|net::(Tcp|Udp)|thread|process|time::(Instant|SystemTime)|env)\b"
)


def manifest(crate: str) -> dict[str, dict[str, object]]:
    return tomllib.loads(
        (ROOT / "crates" / crate / "Cargo.toml").read_text(encoding="utf-8")
    )


def test_every_crate_is_on_the_map() -> None:
    assert {folder.name for folder in (ROOT / "crates").iterdir()} == set(MAY_KNOW)
    for crate in MAY_KNOW:
        assert manifest(crate)["package"]["name"] == f"pydslrep-{crate}"


@pytest.mark.parametrize("crate", MAY_KNOW)
def test_a_crate_knows_only_what_lies_below_it(crate: str) -> None:
    ours = {
        name.removeprefix("pydslrep-")
        for name in manifest(crate)["dependencies"]
        if name.startswith("pydslrep-")
    }
    assert ours <= MAY_KNOW[crate]


@pytest.mark.parametrize("crate", STANDALONE)
def test_what_checks_the_crates_knows_none_of_them(crate: str) -> None:
    text = (STANDALONE[crate] / "Cargo.toml").read_text(encoding="utf-8")
    own = tomllib.loads(text)
    assert own["package"]["name"] == f"pydslrep-{crate}"
    assert text.count("pydslrep-") == 1
    for user in MAY_KNOW:
        assert f"pydslrep-{crate}" not in manifest(user)["dependencies"]


@pytest.mark.parametrize("crate", MAY_KNOW)
def test_libraries_stay_in_their_layer(crate: str) -> None:
    for library in manifest(crate)["dependencies"]:
        assert crate in ONLY_IN.get(library, {crate}), (
            f"{library} does not belong into {crate}"
        )


def without_tests(text: str) -> str:
    return text.split("#[cfg(test)]\nmod tests", maxsplit=1)[0]


@pytest.mark.parametrize("crate", PURE)
def test_lower_crates_do_no_io(crate: str) -> None:
    for file in (ROOT / "crates" / crate / "src").rglob("*.rs"):
        if file.name in {"tests.rs", "testing.rs", "fixture.rs"}:
            continue
        found = IMPURE.search(without_tests(file.read_text(encoding="utf-8")))
        assert not found, (
            f"{file.relative_to(ROOT)} uses {found.group()}" if found else ""
        )


def modules(folder: Path) -> dict[str, str]:
    """The files of a crate by their paths in it, without tests and comments."""
    found = {}
    for file in folder.rglob("*.rs"):
        name = str(file.relative_to(folder).with_suffix(""))
        if name != "lib" and not name.endswith("tests"):
            text = without_tests(file.read_text(encoding="utf-8"))
            found[name] = re.sub(r"//.*", "", text)
    return found


def imported(name: str, files: dict[str, str]) -> set[str]:
    """The files that one of them imports by their paths in the crate."""
    found = set()
    for path, braces in re.findall(r"crate::([a-z_:]+)(?:\{([^}]*)\})?", files[name]):
        for last in re.findall(r"\w+", braces) or [""]:
            parts = [part for part in [*path.split("::"), last] if part]
            heads = ["/".join(parts[:end]) for end in range(len(parts), 0, -1)]
            found |= set([head for head in heads if head in files][:1])
    return found - {name}


def test_files_of_the_server_import_each_other_in_one_direction() -> None:
    """Taken away as long as there is one that imports none of the rest, all must go. A file and those in the folder
    of its name are one."""
    files = modules(ROOT / "crates" / "server" / "src")
    whole = {name: imported(name, files) for name in files}
    while free := {
        name
        for name, needed in whole.items()
        if not {n for n in needed & whole.keys() if not n.startswith(f"{name}/")}
    }:
        whole = {name: whole[name] for name in whole.keys() - free}
    assert whole == {}, "these import each other in a circle"


@pytest.mark.parametrize("crate", MAY_KNOW)
def test_every_crate_says_what_it_must_never_know(crate: str) -> None:
    top = ROOT / "crates" / crate / "src" / ("main.rs" if crate == "cli" else "lib.rs")
    head = [
        line
        for line in top.read_text(encoding="utf-8").splitlines()
        if line.startswith("//!")
    ]
    text = " ".join(head)
    assert re.search(r"\b[Kk]nows\b", text), (
        f"{top.relative_to(ROOT)} does not say what it knows"
    )
    assert re.search(r"[Mm]ust never", text), (
        f"{top.relative_to(ROOT)} does not say what it must never know"
    )
