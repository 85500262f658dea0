//! The targets of scripts.

/// The system that moves the robots: a simulator, whose remote API a script speaks, or drivers of ROS 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Target {
    /// `CoppeliaSim` 4.6 or later with its `ZeroMQ` remote API: one connection serves all robots.
    #[default]
    CoppeliaSim,
    /// V-REP 3 with its legacy remote API: each robot has a connection of its own, on its port.
    VRep,
    /// ROS 2: topics of a robot's driver, through rclpy. There is no simulator, and ports have no meaning.
    Ros2,
}

impl Target {
    /// All of them, the usual one first.
    pub const ALL: [Self; 3] = [Self::CoppeliaSim, Self::VRep, Self::Ros2];

    /// The word it is chosen by.
    pub const fn word(self) -> &'static str {
        match self {
            Self::CoppeliaSim => "coppeliasim",
            Self::VRep => "vrep",
            Self::Ros2 => "ros2",
        }
    }

    /// Returns a description in a few words.
    pub const fn summary(self) -> &'static str {
        match self {
            Self::CoppeliaSim => "CoppeliaSim 4.6 or later, by its ZeroMQ remote API",
            Self::VRep => "V-REP 3, by its legacy remote API: each robot has a port of its own",
            Self::Ros2 => "ROS 2, by the topics of a robot's driver: Jazzy or Kilted, through rclpy",
        }
    }

    /// The port its simulator listens on unless somebody chose another one; further robots count on from it.
    pub const fn default_port(self) -> u16 {
        match self {
            Self::CoppeliaSim | Self::Ros2 => 23000,
            Self::VRep => 19999,
        }
    }

    /// The target of a word.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.word() == word)
    }
}
