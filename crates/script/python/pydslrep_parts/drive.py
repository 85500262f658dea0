"""The union of all drives; a script has only those that it uses."""

from .drive_four_mecanum import FourMecanumDrive
from .drive_four_wheel import FourWheelDrive
from .drive_two_wheel import TwoWheelDrive

Drive = TwoWheelDrive | FourWheelDrive | FourMecanumDrive
