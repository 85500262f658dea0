"""How `pydslrep run` starts Python: the package and the program's modules are found, nothing else changes."""

from __future__ import annotations

import json
import pathlib
import signal
import subprocess
import sys

import pytest

BOOT = pathlib.Path(__file__).parents[2] / "crates" / "cli" / "python" / "boot.py"
SCRIPT = '''"""What it does."""

import json
import sys

import __main__
import package

print(json.dumps({"doc": __main__.__doc__, "name": __name__, "argv": sys.argv, "path": sys.path, "of": package.__file__}))
'''


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    """A package, a program's folder with modules, and a script in a folder of its own."""
    for name, text in {
        "runtime/package.py": "",
        "program/package.py": "raise SystemExit('replaced')",
        "program/json.py": "raise SystemExit('replaced')",
        "program/own.py": "",
        "script/yard.py": SCRIPT,
        "here/json.py": "raise SystemExit('replaced')",
        "here/threading.py": "raise SystemExit('replaced')",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def boot(
    folder: pathlib.Path, *options: str, program: str = ""
) -> subprocess.CompletedProcess[str]:
    code = BOOT.read_text(encoding="utf-8")
    script = folder / "script" / "yard.py"
    own = [str(folder / "runtime"), program, str(script), "--map"]
    command = [sys.executable, *options, "-c", code, *own]
    with subprocess.Popen(
        command,
        cwd=folder / "here",
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as running:
        assert running.stdout
        assert running.stderr
        # Its input stays open until it ends.
        stdout, stderr = running.stdout.read(), running.stderr.read()
        status = running.wait()
    return subprocess.CompletedProcess(command, status, stdout, stderr)


@pytest.mark.parametrize("options", [["-I"], [], ["-P"]])
def test_a_script_is_the_main_program(folder: pathlib.Path, options: list[str]) -> None:
    done = boot(folder, *options, program=str(folder / "program"))
    assert done.returncode == 0, done.stderr
    seen = json.loads(done.stdout)
    script = folder / "script" / "yard.py"
    assert (seen["doc"], seen["name"]) == ("What it does.", "__main__")
    assert seen["argv"] == [str(script), "--map"]
    assert seen["of"] == str(folder / "runtime" / "package.py")
    assert seen["path"][0] == str(folder / "runtime")
    assert seen["path"][-1] == str(folder / "program")
    assert str(folder / "here") not in seen["path"]
    assert "" not in seen["path"]
    assert (str(script.parent) in seen["path"]) == (options != ["-I"])


def test_without_own_modules_no_folder_is_added(folder: pathlib.Path) -> None:
    path = json.loads(boot(folder, "-I").stdout)["path"]
    assert not {"", str(folder / "program")} & set(path)


def test_tracebacks_show_the_script(folder: pathlib.Path) -> None:
    script = folder / "script" / "yard.py"
    script.write_text("def drive():\n    1 / 0\n\ndrive()\n", encoding="utf-8")
    done = boot(folder, "-I")
    assert done.returncode == 1
    assert f'File "{script}", line 2, in drive\n    1 / 0\n' in done.stderr


def test_a_script_ends_with_whoever_started_it(folder: pathlib.Path) -> None:
    script = folder / "script" / "yard.py"
    script.write_text(
        "import sys, threading\ntry:\n    print(sys.stdin.read(), 'drives', flush=True)\n"
        "    threading.Event().wait()\nfinally:\n    print('stops', flush=True)\n",
        encoding="utf-8",
    )
    own = [str(folder / "runtime"), "", str(script)]
    command = [sys.executable, "-I", "-c", BOOT.read_text(encoding="utf-8"), *own]
    with subprocess.Popen(
        command,
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    ) as running:
        assert running.stdin
        assert running.stdout
        assert running.stdout.readline() == " drives\n", "its own input is empty"
        running.stdin.close()
        assert running.stdout.read() == "stops\n"
    assert running.returncode == -signal.SIGINT
