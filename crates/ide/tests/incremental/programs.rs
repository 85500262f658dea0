//! The content of the files before the first edit.

use proptest::prelude::*;
use pydslrep_naive::Recipe;
use pydslrep_syntax::parse;

/// The files, in the order of opening.
pub(crate) const PATHS: [&str; 4] = ["main.pyr", "lib.pyr", "parts/more.pyr", "base.pyr"];

/// The possible import paths, relative to the main folder.
pub(crate) const IMPORTS: [&str; 6] =
    ["lib.pyr", "parts/more.pyr", "main.pyr", "base.pyr", "missing.pyr", "/else/where.pyr"];

/// The paper's programs, those of the contract, and other handwritten ones.
const WRITTEN: [&str; 14] = [
    include_str!("../../../../tests/paper/table2_two_wheels.pyr"),
    include_str!("../../../../tests/paper/table3_four_wheels.pyr"),
    include_str!("../../../../tests/paper/table4_holonomic.pyr"),
    include_str!("../../../../tests/paper/table5_angles_as_printed.pyr"),
    include_str!("../../../../tests/paper/table6_sensors.pyr"),
    include_str!("../../../../tests/paper/table7_slam.pyr"),
    include_str!("../../../../tests/programs/table5_with_wheels.pyr"),
    include_str!("../../../../tests/programs/0.3/02-nested.pyr"),
    include_str!("../../../../tests/programs/0.3/04-procedures.pyr"),
    include_str!("../../../../tests/programs/0.3/05-names.pyr"),
    include_str!("../../../../tests/programs/0.3/09-give-way.pyr"),
    include_str!("../../../../tests/programs/0.3/10-limits.pyr"),
    include_str!("../../../../tests/programs/0.3/11-recovery.pyr"),
    ROBOTS,
];

/// A program with many errors that depend on other entities.
const ROBOTS: &str = "\
// a robot
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot r type tw with port 23000 has { wheelL wheelR } wheels with sensors { s }
parallel movement m of r { move 4.0 meters at 9 turn left until { s, t } turn right }
movement n of q { move 1 meters turn left }
environment e has { r q p } robots with { m m n o } moves
environment E has { q } robots
sensor s
sensor t : bumper
ip here 10.0.0.7
wheelH a with radius 3 /* mecanum */
wheelH b with radius 3
robot q with port 2 has { a b a b } wheels
movement m of q { slam }
parallel movement o of p { turn right 30 }
wheel b with radius 3
wheel c with radius 3
robot p with port 2 has { b c } wheels
";

/// Programs of several files whose only problems are planned collisions, and ports with V-REP.
const DRIVING: [[&str; 4]; 2] = [TAKING_TURNS, SIDE_BY_SIDE];

const TAKING_TURNS: [&str; 4] = [
    "\
import \"lib.pyr\"
movement m of r { move 4 meters turn left move 3 meters }
environment e has { r q } robots with { m n } moves
",
    "\
wheel a with radius 4
wheel b with radius 4
robot r type tw with port 23000 has { a b } wheels
wheel c with radius 4
wheel d with radius 4
robot q type tw with port 23000 has { c d } wheels
movement n of q { move 2 meters }
",
    "",
    "\
import \"lib.pyr\"
environment e has { q } robots with { n } moves
",
];

const SIDE_BY_SIDE: [&str; 4] = [
    "\
import \"parts/more.pyr\"
environment e has { r q } robots with { m n o m } moves
",
    "\
import \"parts/more.pyr\"
environment f has { q p } robots with { n o } moves
",
    "\
import \"../base.pyr\"
robot r with port 20000 has { a b } wheels with sensors { s }
robot q with port 20000 has { a b } wheels
robot p type fw with port 20000 has { a b a2 b2 } wheels
parallel movement m of r { move 2 meters turn left until { s } }
parallel movement n of q { turn right move 1 meters }
movement o of q { move -30 centimeters at 4.5 }
wheel a with radius 4
wheel b with radius 4
wheel a2 with radius 4
wheel b2 with radius 4
sensor s
",
    "wheel a with radius 5\nwheel b with radius 5\nsensor s : bumper\n",
];

/// Their scenes, by file and environment.
const IN_THE_WAY: [(usize, &str, &str); 2] =
    [(0, "e", "[[wall]]\nfrom = [1, -9]\nto = [1, 9]\n"), (3, "e", "[world]\nsize = [2, 2]\n")];

/// The initial content of the files. Leaving parts out shrinks a failure.
#[derive(Debug, Clone)]
pub(crate) struct Start {
    /// The seed of the generator.
    seed: u64,
    /// A handwritten program instead of the first generated one.
    written: Option<usize>,
    /// True if one program is distributed over all files, so that they depend on each other.
    dealt: bool,
    /// Six bits per file: its imports.
    imports: u32,
    /// One bit per file except the first, which is always open: whether it is open.
    open: u8,
    /// The entities that are present.
    kept: Vec<bool>,
    /// One of the programs that have scenes and initially no errors.
    driving: Option<usize>,
    /// True if generated programs have errors.
    mistakes: bool,
}

pub(crate) fn starts() -> impl Strategy<Value = Start> {
    let written = proptest::option::of(0..WRITTEN.len());
    let kept = proptest::collection::vec(proptest::bool::weighted(0.97), 128);
    let imports = proptest::bits::u32::masked(0xff_ffff);
    let driving = proptest::option::weighted(0.3, 0..DRIVING.len());
    let open = proptest::bits::u8::masked(0b1110);
    (any::<u64>().no_shrink(), written, any::<bool>(), imports, open, kept, driving, any::<bool>()).prop_map(
        |(seed, written, dealt, imports, open, kept, driving, mistakes)| Start {
            seed,
            written,
            dealt,
            imports,
            open,
            kept,
            driving,
            mistakes,
        },
    )
}

impl Start {
    /// The text of each file.
    pub(crate) fn texts(&self) -> [String; 4] {
        if let Some(driving) = self.driving {
            return DRIVING[driving].map(str::to_owned);
        }
        let mut kept = self.kept.iter().copied().chain(std::iter::repeat(true));
        let mut programs: Vec<String> = (0..PATHS.len()).map(|index| self.program(index)).collect();
        for program in &mut programs {
            *program = keep(program, &mut kept);
        }
        let mut texts: [String; 4] = std::array::from_fn(|index| self.imports(index));
        if self.dealt {
            for (index, piece) in pieces(&programs[0]).chain(pieces(&programs[1])).enumerate() {
                // Neither in turn nor all to one.
                let file = (self.seed.rotate_right(u32::try_from(index).unwrap_or_default()) & 3) as usize;
                texts[file].push_str(piece);
            }
        } else {
            for (text, program) in texts.iter_mut().zip(programs) {
                text.push_str(&program);
            }
        }
        texts
    }

    /// The scenes there are: file, environment, and text.
    pub(crate) fn scenes(&self) -> &'static [(usize, &'static str, &'static str)] {
        if self.driving.is_some() { &IN_THE_WAY } else { &[] }
    }

    /// Returns whether a file is open before the first step.
    pub(crate) fn is_open(&self, file: usize) -> bool {
        self.driving.is_some() || file == 0 || self.open >> file & 1 == 1
    }

    fn program(&self, index: usize) -> String {
        let seed = self.seed.wrapping_add(index as u64);
        match self.written {
            Some(written) if index == 0 => WRITTEN[written].to_owned(),
            _ => {
                let lines = if self.dealt { 18 } else { 5 + (seed % 12) as usize };
                let odd_layout = seed.is_multiple_of(3);
                let (imports, mistakes) = (seed.is_multiple_of(4), self.mistakes);
                Recipe { lines, mistakes, odd_layout, imports, ..Recipe::default() }.seeded(seed)
            }
        }
    }

    fn imports(&self, file: usize) -> String {
        let from = if PATHS[file].contains('/') { "../" } else { "" };
        let chosen = IMPORTS.iter().enumerate().filter(|(bit, _)| self.imports >> (file * 6 + bit) & 1 == 1);
        chosen.flat_map(|(_, path)| ["import \"", from, path, "\"\n"]).collect()
    }
}

fn pieces(program: &str) -> impl Iterator<Item = &str> {
    parse(program).into_iter().map(|(span, _)| span.text(program))
}

fn keep(program: &str, kept: &mut impl Iterator<Item = bool>) -> String {
    pieces(program).zip(kept).filter(|(_, kept)| *kept).map(|(piece, _)| piece).collect()
}
