"""Obstacles are where the command says, crates/scene/src/trajectory.rs."""

import pytest
from pydslrep_runtime.obstacle_path import ObstaclePath

# It waits, moves, waits and moves on.
WAY = [(2.0, 1.0, 0.0), (4.0, 1.0, 4.0), (5.0, 1.0, 4.0), (6.0, 0.0, 4.0)]


@pytest.mark.parametrize(
    ("time", "place"),
    [
        (0.0, (1.0, 0.0)),
        (2.0, (1.0, 0.0)),
        (2.5, (1.0, 1.0)),
        (4.0, (1.0, 4.0)),
        (4.5, (1.0, 4.0)),
        (5.25, (0.75, 4.0)),
        (6.0, (0.0, 4.0)),
        (1e6, (0.0, 4.0)),
    ],
)
def test_it_stays_at_its_ends(time: float, place: tuple[float, float]) -> None:
    assert ObstaclePath(WAY, repeats=False).at(time) == place


@pytest.mark.parametrize(
    ("time", "place"),
    [
        (1.0, (1.0, 0.0)),
        (3.0, (1.0, 2.0)),
        (6.0, (0.0, 4.0)),
        (6.75, (0.75, 4.0)),
        (7.5, (1.0, 4.0)),
        (9.0, (1.0, 2.0)),
        (10.0, (1.0, 0.0)),
        (11.0, (1.0, 2.0)),
        (14.0, (0.0, 4.0)),
        (8018.0, (1.0, 0.0)),
    ],
)
def test_it_goes_there_and_back(time: float, place: tuple[float, float]) -> None:
    assert ObstaclePath(WAY, repeats=True).at(time) == place


def test_one_point_is_no_way() -> None:
    still = ObstaclePath([(3.0, 1.0, 2.0)], repeats=True)
    assert still.at(0.0) == still.at(9.0) == (1.0, 2.0)
