//! Programs for the pages of rules, most of which are about one movement. All but its actions is always the same.

/// A program whose robot makes one trip, with these actions in their braces.
macro_rules! trip {
    ($actions:literal) => {
        concat!(
            "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5\n",
            "robot rover with port 23000 has { wheelL wheelR } wheels\n\n",
            "movement trip of rover ",
            $actions,
            "\n\nenvironment yard has { rover } robots with { trip } moves",
        )
    };
}

/// The same of a robot with a sensor, which is called `front`.
macro_rules! sensing_trip {
    ($actions:literal) => {
        concat!(
            "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5\nsensor front\n",
            "robot rover with port 23000 has { wheelL wheelR } wheels with sensors { front }\n\n",
            "movement trip of rover ",
            $actions,
            "\n\nenvironment yard has { rover } robots with { trip } moves",
        )
    };
}

pub(super) use {sensing_trip, trip};
