"""What commands write: never over something else, whole or not at all, and nothing left of a killed one."""

from __future__ import annotations

import json
import pathlib
import resource
import signal
import subprocess
import tempfile

import pytest

PROGRAM = """\
wheel a with radius 4
wheel b with radius 4
robot r with port 18361 has { a b } wheels
movement m of r { move 10 centimeters }
environment yard has { r } robots with { m } moves
"""
SLAM = """\
sensor s1 sensor s2 sensor s3 sensor s4 sensor s5
wheel a with radius 4
wheel b with radius 4
robot r with port 18362 has { a b } wheels with sensors { s1 s2 s3 s4 s5 }
movement m of r { slam }
environment cave has { r } robots with { m } moves
"""


class Place:
    """A folder with a program, and the command in it."""

    def __init__(self, command: str, folder: pathlib.Path) -> None:
        self.command, self.folder = command, folder
        (folder / "p.pyr").write_text(PROGRAM, encoding="utf-8")

    def run(
        self, *arguments: str, largest_file: int | None = None
    ) -> subprocess.CompletedProcess[str]:
        """Runs it; a process that writes more than that into a file is killed."""

        def limit() -> None:
            if largest_file is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        return subprocess.run(
            [self.command, *arguments],
            cwd=self.folder,
            check=False,
            capture_output=True,
            text=True,
            timeout=60,
            preexec_fn=limit,
        )

    def refuses(self, reason: str, *arguments: str) -> None:
        """The command does nothing, and says why."""
        before = files(self.folder)
        done = self.run(*arguments)
        assert (done.returncode, done.stdout) == (2, ""), done.stderr
        assert reason in done.stderr
        assert "= help: " in done.stderr
        assert files(self.folder) == before


def files(folder: pathlib.Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.fixture
def place(command: str, tmp_path: pathlib.Path) -> Place:
    return Place(command, tmp_path)


def test_a_changed_script_is_replaced_only_by_force(place: Place) -> None:
    assert place.run("build", "--no-runtime").returncode == 0
    script = place.folder / "yard.py"
    generated = script.read_text(encoding="utf-8")
    changed = generated.replace("0.1)", "0.2)")
    assert changed != generated
    script.write_text(changed, encoding="utf-8")
    place.refuses("yard.py was changed since it was generated", "build")
    assert place.run("build", "--force", "--no-runtime").returncode == 0
    assert script.read_text(encoding="utf-8") == generated
    script.write_text("print('mine')\n", encoding="utf-8")
    place.refuses("yard.py exists and is not a generated script", "build", "--force")


@pytest.mark.parametrize(
    "options",
    [
        ("run", "p.pyr", "--trace", "p.pyr"),
        ("run", "p.pyr", "--figures", "p.pyr"),
        ("run", "p.pyr", "--replay", "notes.svg"),
        ("run", "p.pyr", "--picture", "notes.svg"),
        ("plan", "p.pyr", "--picture", "notes.svg"),
        ("plan", "p.pyr", "--replay", "notes.svg"),
        ("sim", "p.pyr", "--trace", "p.pyr"),
        ("sim", "p.pyr", "--trace", "notes.svg"),
    ],
    ids=" ".join,
)
def test_other_files_are_not_replaced(place: Place, options: tuple[str, ...]) -> None:
    (place.folder / "notes.svg").write_text("<svg>mine</svg>", encoding="utf-8")
    # A program is both something else and an input, which says more.
    what = "is read by the same command" if options[-1] == "p.pyr" else "exists and is"
    place.refuses(f"{options[-1]} {what}", *options)


def test_inputs_are_not_replaced(place: Place) -> None:
    (place.folder / "s.toml").touch()
    read = "s.toml is read by the same command"
    place.refuses(read, "run", "p.pyr", "--scene", "s.toml", "--trace", "./s.toml")
    (place.folder / "yard.scene.toml").touch()
    place.refuses("is read by", "sim", "p.pyr", "--trace", "yard.scene.toml")
    both = ("--picture", "a.svg", "--replay", "./a.svg")
    place.refuses("a.svg would be written twice", "plan", "p.pyr", *both)


def test_a_map_that_nobody_asked_for_replaces_maps_only(place: Place) -> None:
    (place.folder / "p.pyr").write_text(SLAM, encoding="utf-8")
    (place.folder / "cave_map.json").write_text('{"mine": 1}', encoding="utf-8")
    place.refuses("cave_map.json exists and is not a map", "run", "p.pyr")


@pytest.mark.parametrize("name", ["a.svg", "a.png"])
def test_pictures_replace_pictures(place: Place, name: str) -> None:
    for _ in range(2):
        done = place.run("plan", "p.pyr", "--picture", name)
        assert done.returncode == 0, done.stderr
    (place.folder / name).write_bytes(b"\x89PNG\r\n\x1a\n a photograph")
    place.refuses("is not a picture by PyDSLRep", "plan", "p.pyr", "--picture", name)


def test_links_out_of_the_folder_are_not_followed(place: Place) -> None:
    elsewhere = place.folder / "elsewhere"
    elsewhere.mkdir()
    (place.folder / "here").mkdir()
    (elsewhere / "yard.py").touch()
    (place.folder / "here" / "yard.py").symlink_to(elsewhere / "yard.py")
    place.refuses("yard.py is a link to", "build", "p.pyr", "-o", "here", "--force")
    (place.folder / "null.svg").symlink_to("/dev/null")
    place.refuses("is a link to /dev/null", "plan", "p.pyr", "--picture", "null.svg")


def test_a_folder_of_the_settings_is_in_the_project(place: Place) -> None:
    project = place.folder / "project"
    project.mkdir()
    (place.folder / "elsewhere").mkdir()
    (project / "p.pyr").write_text(PROGRAM, encoding="utf-8")
    (project / "pydslrep.toml").write_text('output = "out/deep"\n', encoding="utf-8")
    (project / "out").symlink_to(place.folder / "elsewhere")
    place.refuses("out/deep is a link to", "build", "project/p.pyr")
    assert place.run("build", "project/p.pyr", "-o", "project/out").returncode == 0
    assert (place.folder / "elsewhere" / "yard.py").exists()


def test_a_killed_build_leaves_the_old_script(place: Place) -> None:
    assert place.run("build", "--no-runtime").returncode == 0
    old = files(place.folder)
    (place.folder / "p.pyr").write_text(
        PROGRAM.replace("{ move", "{ turn left move"), encoding="utf-8"
    )
    killed = place.run("build", "--no-runtime", largest_file=100)
    assert killed.returncode == -signal.SIGXFSZ
    assert files(place.folder)["yard.py"] == old["yard.py"]
    assert place.run("build", "--no-runtime").returncode == 0
    assert files(place.folder)["yard.py"] != old["yard.py"]
    assert set(files(place.folder)) == {"p.pyr", "yard.py"}, "nothing is left"


@pytest.mark.parametrize(
    ("option", "name"), [("--picture", "a.svg"), ("--picture", "a.png")]
)
def test_a_killed_drawing_leaves_the_old_one(
    place: Place, option: str, name: str
) -> None:
    assert place.run("plan", "p.pyr", option, name).returncode == 0
    old = (place.folder / name).read_bytes()
    killed = place.run("plan", "p.pyr", option, name, largest_file=100)
    assert killed.returncode == -signal.SIGXFSZ
    assert (place.folder / name).read_bytes() == old


def test_a_new_program_is_whole(place: Place) -> None:
    assert place.run("new", "patrol", largest_file=100).returncode == -signal.SIGXFSZ
    assert not (place.folder / "patrol").exists()
    assert place.run("new", "patrol").returncode == 0
    assert {path.name for path in place.folder.iterdir()} == {"p.pyr", "patrol"}


def test_a_trace_is_partial_until_the_simulator_stops(place: Place) -> None:
    start = [place.command, "sim", "p.pyr", "--trace", "t.jsonl"]
    trace, partial = (place.folder / name for name in ("t.jsonl", "t.jsonl.partial"))
    for end in (signal.SIGKILL, signal.SIGINT):
        with subprocess.Popen(
            start, cwd=place.folder, stdout=subprocess.PIPE, text=True
        ) as running:
            assert running.stdout
            while "Ready" not in running.stdout.readline():
                assert running.poll() is None
            assert partial.exists()
            assert not trace.exists()
            running.send_signal(end)
    assert not partial.exists()
    for line in trace.read_text(encoding="utf-8").splitlines():
        assert json.loads(line)["robot"] == "r"


def test_temporary_folders_of_killed_processes_are_removed(
    place: Place, monkeypatch: pytest.MonkeyPatch
) -> None:
    with tempfile.TemporaryDirectory() as temporary:
        monkeypatch.setenv("TMPDIR", temporary)
        killed = pathlib.Path(temporary) / "pydslrep-run-killed"
        killed.mkdir()
        (killed / ".pydslrep-lock").touch()
        mine = pathlib.Path(temporary) / "pydslrep-mine"
        mine.mkdir()
        # It needs its folder, and then a Python that is not there for the rest.
        place.run("run", "p.pyr", "--target", "vrep", "--python", "/bin/true")
        place.run("run", "p.pyr", "--robot", "nothing:Nobody")
        assert [path.name for path in pathlib.Path(temporary).iterdir()] == [mine.name]
