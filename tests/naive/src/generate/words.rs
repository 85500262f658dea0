//! Names and numbers, both usual and problematic ones.

use super::choices::Choices;

/// Plain names, escaped keywords, contextual keywords, and names with a meaning in Python.
pub(super) const NAMES: [&str; 40] = [
    "a",
    "wheelL",
    "wheelR",
    "wheelL0",
    "wheelR0",
    "left_1",
    "robot_1",
    "sensor_1",
    "mov_1",
    "area_1",
    "b",
    "_",
    "x9",
    "Wheel",
    "distance",
    "bumper",
    "import",
    "^robots",
    "^moves",
    "^wheel",
    "^parallel",
    "^ip",
    "class",
    "None",
    "print",
    "self",
    "sim",
    "math",
    "time",
    "len",
    "lambda",
    "robot",
    "__init__",
    "async",
    "fRight",
    "fLeft",
    "rRight",
    "lRight",
    "A",
    "AREA_1",
];

/// Half of them are words of the statements that blocks came with, which are names, too.
pub(super) const NEW_NAMES: [&str; 32] = [
    "a", "wait", "wheelL", "repeat", "left_1", "if", "robot_1", "else", "mov_1", "do", "b", "times", "x9",
    "seconds", "distance", "clear", "bumper", "detect", "^robots", "within", "^moves", "in", "^wheel",
    "reverse", "import", "^wait", "class", "^if", "rounds", "^else", "time", "Repeat",
];

/// Names of the wheels of one robot, by their sides: `wheelL`, or `wheelL0` if there are several on a side.
pub(super) fn by_sides(wheels: usize) -> Vec<String> {
    let number = |index: usize| if wheels == 2 { String::new() } else { index.to_string() };
    let side = |side: &'static str| (0..wheels / 2).map(move |index| format!("wheel{side}{}", number(index)));
    side("L").chain(side("R")).collect()
}

/// Names whose script would shadow a module, or almost.
pub(super) const SCRIPTS: [&str; 12] =
    ["json", "Json", "zmq", "con", "COM1", "nul", "cbor", "threading", "json_env", "com10", "aux_1", "vrep"];

/// Keywords in the list above, which need an escape.
const MUST_ESCAPE: [&str; 1] = ["robot"];

pub(super) fn name(choices: &mut Choices, from: &[&str]) -> String {
    let name = choices.pick(from);
    if MUST_ESCAPE.contains(&name) { format!("^{name}") } else { name.to_owned() }
}

pub(super) struct Numbers {
    pub(super) usual: &'static [&'static str],
    /// Invalid or borderline.
    pub(super) doubtful: &'static [&'static str],
}

/// A placeholder for a number with more digits than any float.
pub(super) const ENDLESS: &str = "endless";

pub(super) const RADII: Numbers = Numbers {
    usual: &["4.5", "4.5", "4.5", "5", "12.25", "99.9"],
    doubtful: &[
        "0",
        "-4.5",
        "-0.0",
        "100",
        "100.01",
        "450",
        "0.5",
        "0.499",
        "0.045",
        "0.0000000001",
        ENDLESS,
    ],
};

pub(super) const DISTANCES: Numbers = Numbers {
    usual: &["4", "1.5", "-2", "400", "-0.25", "33.3"],
    doubtful: &["0", "-0", "0.000", "1000000", "1000000.01", "-1000001", "100000000", "100000001", ENDLESS],
};

pub(super) const SPEEDS: Numbers =
    Numbers { usual: &["9.0", "12", "4.75", "0.5"], doubtful: &["0", "-9", "-0.0", "0.001", ENDLESS] };

pub(super) const ANGLES: Numbers = Numbers {
    usual: &["90", "45", "30.5", "180", "360"],
    doubtful: &["0", "-90", "360.01", "720", "-400", "-0.0", ENDLESS],
};

pub(super) const SHORT_DISTANCES: Numbers =
    Numbers { usual: &["1", "0.5", "-2", "1.5", "-0.25", "0.333"], doubtful: DISTANCES.doubtful };

/// Without speeds that take days.
pub(super) const ROUND_SPEEDS: Numbers =
    Numbers { usual: &["9.0", "12", "4.75", "20"], doubtful: SPEEDS.doubtful };

/// Metres.
pub(super) const CIRCLES: Numbers = Numbers {
    usual: &["1", "0.5", "1.5", "0.1", "5"],
    doubtful: &["0", "-0.5", "1000000", "1000000.5", "-0.0", ENDLESS],
};

pub(super) const ANGLES_ON_CIRCLES: Numbers = Numbers {
    usual: &["90", "45", "6", "180", "360", "720"],
    doubtful: &["0", "-90", "36000", "36000.5", "-0.0", ENDLESS],
};

pub(super) const COUNTS: Numbers = Numbers {
    usual: &["2", "3", "4", "5", "10", "7"],
    doubtful: &["0", "1", "-2", "2.5", "10000", "10001", "3.0", "99999999999999999999", ENDLESS],
};

/// Seconds.
pub(super) const TIMES: Numbers = Numbers {
    usual: &["2", "1", "0.5", "10", "60"],
    doubtful: &["0", "-1", "86400", "86400.5", "-0.0", ENDLESS],
};

/// Metres.
pub(super) const NEAR: Numbers = Numbers {
    usual: &["0.4", "1", "0.25", "2"],
    doubtful: &["0", "-1", "-0.0", "1000000", "1000001", ENDLESS],
};

pub(super) const PORTS: Numbers = Numbers {
    usual: &["23000", "20000", "19997", "23001", "1", "65535"],
    doubtful: &["0", "65536", "70000", "99999999999999999999999", "00000"],
};

pub(super) const ADDRESSES: Numbers = Numbers {
    usual: &["127.0.0.1", "10.0.0.12", "192.168.1.255", "0.0.0.0"],
    doubtful: &["256.0.0.1", "127.0.0.999", "1.2.3.99999999999999999999", "127.000.000.001"],
};

/// The same number in another format.
pub(super) fn rewritten(choices: &mut Choices, number: &str) -> String {
    let sign = if number.starts_with('-') { "-" } else { "" };
    let digits = number.trim_start_matches('-');
    let zeros = choices.pick(&["", "", "0", "00"]);
    let point = if digits.contains('.') { "" } else { "." };
    let fraction = choices.pick(&["", "0", "00000"]);
    let tail = if fraction.is_empty() { String::new() } else { format!("{point}{fraction}") };
    format!("{sign}{zeros}{digits}{tail}")
}
