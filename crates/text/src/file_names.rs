//! The names of a project's files.

/// The extension of programs.
pub const PROGRAM_EXTENSION: &str = "pyr";

/// The suffix of the names of scene files, after the name of the environment.
pub const SCENE_SUFFIX: &str = ".scene.toml";

/// The name of the settings file.
pub const SETTINGS_FILE: &str = "pydslrep.toml";

/// Returns whether a name without its extension means a device on Windows, whatever its extension.
pub fn is_reserved_on_windows(stem: &str) -> bool {
    let name = stem.to_ascii_lowercase();
    let is_port = |prefix| {
        name.strip_prefix(prefix).is_some_and(|n| matches!(n.as_bytes(), [digit] if digit.is_ascii_digit()))
    };
    ["con", "prn", "aux", "nul"].contains(&name.as_str()) || is_port("com") || is_port("lpt")
}
