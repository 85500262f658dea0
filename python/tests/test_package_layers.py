"""What the package's modules may import."""

import ast
import sys
from pathlib import Path

import pydslrep_runtime

PACKAGE = Path(pydslrep_runtime.__file__).parent

# Lowest first: a module imports only those above it in this list.
LAYERS = (
    "version",
    "api_calls",
    "settings",
    "facts",
    "interrupts",
    "places",
    "errors",
    "readings",
    "answers",
    "outputs",
    "ros2_topics",
    "pose",
    "events",
    "notes",
    "circles",
    "statements",
    "pace",
    "approach",
    "steering",
    "slip_compensation",
    "scrub",
    "drives",
    "mounting",
    "trace",
    "backend",
    "checked_backend",
    "noted_readings",
    "conditions",
    "remote_api",
    "wait_policy",
    "scene",
    "coppeliasim",
    "vrep",
    "obstacle_path",
    "mujoco_engine",
    "ros2_link",
    "ros2",
    "ros2_findings",
    "ros2_turn",
    "ros2_doctor",
    "ros2_tasks",
    "ros2_world",
    "event_loop",
    "motion",
    "movements",
    "loops",
    "slam",
    "robots",
    "command_line",
    "runner",
    "",  # the package itself
    "__main__",
)

# Everything else that is not Python's own is for these modules only.
LIBRARIES = {
    "remote_api": {"zmq", "coppeliasim_zmqremoteapi_client"},
    "mujoco_engine": {"mujoco", "numpy"},
    "slam/odometry": {"numpy", "scipy"},
    "ros2_link": {"rclpy"},
}


def name_of(file: Path) -> str:
    """A module's name in the list above: that of its file, or of its folder in the package."""
    parts = file.relative_to(PACKAGE).with_suffix("").parts
    return "" if parts == ("__init__",) else parts[0]


def imported(file: Path) -> set[str]:
    """The absolute names of all modules that a file imports."""
    package = ["pydslrep_runtime", *file.relative_to(PACKAGE).parent.parts]
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            names = [alias.name for alias in node.names]
            # `from . import x` imports the module x.
            found |= {module} if node.module else {f"{module}.{n}" for n in names}
    return found


def test_every_module_imports_lower_ones_only() -> None:
    files = sorted(PACKAGE.rglob("*.py"))
    assert {name_of(file) for file in files} == set(LAYERS)
    for file in files:
        own = name_of(file)
        for name in imported(file):
            if name.startswith("pydslrep_runtime"):
                other = f"{name}.".split(".")[1]
                is_lower = LAYERS.index(other) < LAYERS.index(own)
                assert is_lower or other == own, f"{file} imports {name}"


def test_libraries_are_imported_where_they_are_needed() -> None:
    for file in PACKAGE.rglob("*.py"):
        place = file.relative_to(PACKAGE).with_suffix("").as_posix()
        allowed: set[str] = set()
        for owner, libraries in LIBRARIES.items():
            allowed |= libraries if place.startswith(owner) else set()
        roots = {name.partition(".")[0] for name in imported(file)}
        others = roots - set(sys.stdlib_module_names) - {"pydslrep_runtime"}
        assert others <= allowed, f"{file} imports {others - allowed}"
