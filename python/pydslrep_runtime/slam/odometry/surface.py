"""Points on the surfaces around a robot, as arrays.

Positions are complex numbers, x + iy in metres, and directions are complex numbers of length 1: multiplying by a
direction rotates.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ...pose import Pose

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]

GRID_SIZE = 0.04  # m within which points with similar normals are merged


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on surfaces, in the frame of a scan or in the world's."""

    position: Complex
    normal: Complex  # the direction that the surface faces
    phase: Array  # when in the scan: -0.5 at its start, 0.5 at its end

    def __len__(self) -> int:
        return len(self.phase)

    def transformed_by(self, origin: Pose) -> "SurfacePoints":
        """Transforms points relative to `origin` into the frame that `origin` is in."""
        turn = np.exp(1j * origin.theta)
        position = complex(origin.x, origin.y) + turn * self.position
        return SurfacePoints(position, turn * self.normal, self.phase)

    def undistorted(self, drift: float) -> "SurfacePoints":
        """Corrects for the radians that the robot turned further than its wheels report."""
        turn = np.exp(1j * drift * self.phase)
        return SurfacePoints(turn * self.position, turn * self.normal, self.phase)

    def downsampled(self) -> "SurfacePoints":
        """Merges points that are close in position, normal and time."""
        cell = self.position / GRID_SIZE
        facing = np.round(4.0 * np.angle(self.normal) / np.pi) % 8
        keys = np.round([cell.real, cell.imag, facing, 4.0 * self.phase])
        _, first, group, count = np.unique(
            keys, axis=1, return_index=True, return_inverse=True, return_counts=True
        )

        def mean(values: Array) -> Array:
            return np.bincount(group, values, len(count)) / count

        position = mean(self.position.real) + 1j * mean(self.position.imag)
        turned = mean(np.angle(self.normal / self.normal[first][group]))
        normal = self.normal[first] * np.exp(1j * turned)
        return SurfacePoints(position, normal, mean(self.phase))


def joined(parts: Iterable[SurfacePoints]) -> SurfacePoints:
    """All points of several arrays."""
    known = [NOTHING, *parts]
    return SurfacePoints(
        np.concatenate([part.position for part in known]),
        np.concatenate([part.normal for part in known]),
        np.concatenate([part.phase for part in known]),
    )


NOTHING = SurfacePoints(np.empty(0, complex), np.empty(0, complex), np.empty(0))
