"""Where objects are: positions and axes as CoppeliaSim's matrices, rows of rotation and translation."""

import math

Vector = tuple[float, float, float]
Frame = list[float]

X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)


def cross(a: Vector, b: Vector) -> Vector:
    """The cross product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def frame(position: Vector, x: Vector = X, z: Vector = Z) -> Frame:
    """A frame by its origin and two of its axes, which are perpendicular and of unit length."""
    y = cross(z, x)
    rows = zip(x, y, z, position, strict=True)
    return [number for row in rows for number in row]


def planar(x: float, y: float, height: float, heading: float) -> Frame:
    """An upright frame."""
    ahead = (math.cos(heading), math.sin(heading), 0.0)
    return frame((x, y, height), x=ahead)


def product(a: Frame, b: Frame) -> Frame:
    """The frame `b` is relative to `a`; this is where it is in what `a` is relative to."""
    return [
        sum(a[row + k] * b[column + 4 * k] for k in range(3))
        + (a[row + 3] if column == 3 else 0.0)
        for row in (0, 4, 8)
        for column in range(4)
    ]


def inverse(a: Frame) -> Frame:
    """The opposite of a frame: their product is the origin."""
    turned = [[a[row + 4 * column] for column in range(3)] for row in range(3)]
    rows = ([*axis, -sum(axis[k] * a[4 * k + 3] for k in range(3))] for axis in turned)
    return [number for row in rows for number in row]
