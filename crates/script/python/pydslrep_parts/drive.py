"""Any of the drives, as the modules use them; a script names those that it has."""

from .drive_four_mecanum import FourMecanumDrive
from .drive_four_wheel import FourWheelDrive
from .drive_two_wheel import TwoWheelDrive

Drive = TwoWheelDrive | FourWheelDrive | FourMecanumDrive
