//! How the files of a project are named.

/// The extension of programs.
pub const PROGRAM_EXTENSION: &str = "pyr";

/// What the names of scene files end in, after the name of the environment.
pub const SCENE_SUFFIX: &str = ".scene.toml";

/// The name of the settings file.
pub const SETTINGS_FILE: &str = "pydslrep.toml";
