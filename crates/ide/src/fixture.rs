//! Programs with a cursor for tests: `$0` marks it.

use pydslrep_analysis::Database;

use crate::FilePosition;

/// A database with one file, and the place of `$0` in it.
pub(crate) fn at_cursor(fixture: &str) -> (Database, FilePosition) {
    let offset = fixture.find("$0").expect("the fixture has no `$0`");
    let mut database = Database::new();
    let file = database.open("test.pyr", &fixture.replacen("$0", "", 1));
    (database, FilePosition { file, offset: u32::try_from(offset).unwrap() })
}

/// The parts of a program that most fixtures need.
pub(crate) const PARTS: &str = "wheel wheelL with radius 4.5\nwheel wheelR with radius 4.5\nsensor front\nsensor back : bumper\n\
     robot rover type tw with port 19999 has { wheelL wheelR } wheels with sensors { front }\n";
