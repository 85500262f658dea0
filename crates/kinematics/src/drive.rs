//! How a robot's wheels are laid out.

/// The layout of a robot's driven wheels; decides which kinematic model applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Drive {
    /// Two-wheel differential (`tw`); wheels in the order left, right.
    TwoWheel,
    /// Four standard wheels, skid-steer (`fw`); order left-front, left-rear, right-front, right-rear.
    FourWheel,
    /// Four mecanum wheels whose rollers form an X seen from above (`fwh`); order as [`Drive::FourWheel`].
    FourMecanum,
}

impl Drive {
    /// How many driven wheels the layout has.
    pub fn wheel_count(self) -> usize {
        match self {
            Self::TwoWheel => 2,
            Self::FourWheel | Self::FourMecanum => 4,
        }
    }
}
