"""The description of a scene, as `pydslrep` passes it on."""

import json

from pydslrep_runtime.scene.description import SceneDescription, read_scene
from pydslrep_runtime.scene.push import standstill

ROBOT = {
    "name": "robot_1",
    "type": "tw",
    "x": 1.0,
    "y": -2.0,
    "heading": 0.5,
    "length": 0.3,
    "width": 0.25,
    "grip": 1.0,
    "rim_speed": None,
    "rim_acceleration": 1.0,
    "wheels": [
        {"name": "l", "radius": 0.045, "x": 0.0, "y": 0.15, "mirrored": False},
        {"name": "r", "radius": 0.045, "x": 0.0, "y": -0.15, "mirrored": True},
    ],
    "sensors": [
        {
            "name": "eye",
            "kind": "bumper",
            "x": 0.15,
            "y": 0.0,
            "bearing": 0.0,
            "range": 0.05,
            "cone": 0.35,
        }
    ],
}
OBSTACLES = [
    {"name": "wall_1", "x": 0.0, "y": 1.0, "heading": 0.0, "size": [4.0, 0.1]},
    {"name": "post", "x": 2.0, "y": 1.0, "heading": 0.0, "radius": 0.2},
    {
        "name": "wedge",
        "x": 2.0,
        "y": 1.0,
        "heading": 0.0,
        "corners": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        "triangles": [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]],
    },
]


def described() -> SceneDescription:
    return read_scene(
        {"environment": "area_1", "robots": [ROBOT], "obstacles": OBSTACLES}
    )


def test_a_description_is_read() -> None:
    scene = described()
    (robot,) = scene.robots
    assert (robot.start.x, robot.start.theta) == (1.0, 0.5)
    assert [(wheel.name, wheel.mirrored) for wheel in robot.wheels] == [
        ("l", False),
        ("r", True),
    ]
    assert robot.sensors[0].kind == "bumper"
    wall, post, wedge = scene.obstacles
    assert (wall.size, post.radius, len(wedge.triangles)) == ((4.0, 0.1), 0.2, 1)


def test_what_is_written_is_read() -> None:
    scene = described()
    assert read_scene(json.loads(json.dumps(scene.as_json()))) == scene


def test_what_moves_stays_at_its_first_point_and_says_so() -> None:
    person = {"name": "person", "x": 2.0, "y": -0.5, "heading": 0.0, "radius": 0.2}
    obstacles = [*OBSTACLES, {**person, "moves": True}]
    scene = read_scene({"environment": "e", "robots": [], "obstacles": obstacles})
    assert [each.moves for each in scene.obstacles] == [False, False, False, True]
    assert standstill(scene.obstacles[-1]) == (
        "obstacle `person` has a path, but does not move here: it stays at its first point, x 2 m, y -0.5 m"
    )
