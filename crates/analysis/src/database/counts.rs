//! Tests of the cost of edits, in counts: the same in a long file as in a short one.

use pydslrep_syntax::Span;

use super::EditCounts;
use crate::Database;

/// A file of many cells, each with its own wheels, robot, movement and environment.
fn large(cells: usize) -> String {
    (0..cells).map(cell).collect()
}

fn cell(number: usize) -> String {
    format!(
        "wheel l{number} with radius 4\nwheel r{number} with radius 4\n\
         robot robot{number} type tw with port 1 has {{ l{number} r{number} }} wheels\n\
         movement m{number} of robot{number} {{\n  move 4.0 meters\n  turn left 30\n}}\n\
         environment e{number} has {{ robot{number} }} robots with {{ m{number} }} moves\n"
    )
}

/// Returns the cost of replacing `old`, which is in a file of many cells once, by `new`; checks that it is the same in
/// a file a hundred times as long.
fn cost(old: &str, new: &str) -> EditCounts {
    let [short, long] = [10, 1000].map(|cells| {
        let mut database = Database::new();
        let file = database.open("large.pyr", &large(cells));
        replace(&mut database, file, old, new)
    });
    assert_eq!(short, long);
    short
}

fn replace(database: &mut Database, file: crate::FileId, old: &str, new: &str) -> EditCounts {
    let text = database.text(file).unwrap().to_string();
    assert_eq!(text.matches(old).count(), 1, "{old}");
    // Their common beginning and end are not typed again.
    let head = old.bytes().zip(new.bytes()).take_while(|(a, b)| a == b).count();
    let (gone, come) = (&old[head..], &new[head..]);
    let tail = gone.bytes().rev().zip(come.bytes().rev()).take_while(|(a, b)| a == b).count();
    let at = u32::try_from(text.find(old).unwrap() + head).unwrap();
    let span = Span::new(at, at + u32::try_from(gone.len() - tail).unwrap());
    database.edit(file, span, &come[..come.len() - tail]);
    database.last_edit()
}

fn counts(relexed: usize, reparsed: usize, revalidated: usize) -> EditCounts {
    EditCounts { relexed, reparsed, revalidated }
}

#[test]
fn an_edit_inside_a_movement_asks_nobody_else() {
    let movement = |angle: &str| format!("movement m5 of robot5 {{\n  move 4.0 meters\n  turn left {angle}");
    assert_eq!(cost(&movement("30"), &movement("36")), counts(27, 1, 1));
    assert_eq!(cost(&movement("30"), &movement("")), counts(25, 1, 1));
}

#[test]
fn a_radius_is_of_interest_to_the_robots_that_have_the_wheel() {
    assert_eq!(cost("wheel l5 with radius 4\n", "wheel l5 with radius 45\n"), counts(13, 1, 2));
}

/// Where the next entity begins depends on its first words: the others are not read, however many there are.
#[test]
fn a_long_neighbour_costs_nothing() {
    for turns in [3, 300] {
        let mut database = Database::new();
        let long = "  turn left\n".repeat(turns);
        let text = format!("wheel w with radius 4\nmovement m of r {{\n{long}}}\n");
        let file = database.open("a.pyr", &text);
        assert_eq!(replace(&mut database, file, "radius 4", "radius 45").relexed, 13, "{turns} turns");
    }
}

#[test]
fn a_port_is_of_interest_to_the_movements_of_the_robot() {
    assert_eq!(cost("robot5 type tw with port 1 ", "robot5 type tw with port 12 "), counts(29, 1, 2));
}

#[test]
fn renaming_a_robot_asks_only_those_who_use_it() {
    assert_eq!(cost("robot robot5 ", "robot robot5x "), counts(39, 2, 3));
    let mut database = Database::new();
    let file = database.open("large.pyr", &large(10));
    replace(&mut database, file, "robot robot5 ", "robot robot5x ");
    let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
    assert_eq!(codes, ["unused-declaration", "unresolved-reference", "unresolved-reference"]);
}

#[test]
fn one_use_more_or_less_is_of_no_interest_to_the_other_users() {
    for users in [3, 300] {
        let movement = |number| format!("movement m{number} of r {{ turn left until {{ front }} }}\n");
        let program = "wheel a with radius 4\nsensor front : distance\n\
                       robot r with port 1 has { a a } wheels with sensors { front }\n";
        let text = program.to_owned() + &(0..users).map(movement).collect::<String>();
        let mut database = Database::new();
        let file = database.open("a.pyr", &text);
        let (whole, cut) = ("m1 of r { turn left until { front", "m1 of r { turn left until { fron");
        // The movement, and the sensor, which nothing might use now.
        assert_eq!(replace(&mut database, file, whole, cut).revalidated, 2, "{users} users");
        assert_eq!(replace(&mut database, file, &format!("{cut} "), &format!("{whole} ")).revalidated, 2);
    }
}

#[test]
fn an_entity_is_split_in_two() {
    let split = "environment e5 has { robot5 } robots\nenvironment x with { m5 } moves";
    assert_eq!(cost("environment e5 has { robot5 } robots with { m5 } moves", split), counts(31, 2, 4));
}

/// A comment that is begun reaches to the end of the next one; what it hides is what comes back.
#[test]
fn a_comment_is_begun_and_taken_back() {
    for cells in [10, 1000] {
        let mut database = Database::new();
        let following: String = (6..cells).map(cell).collect();
        let text = large(6) + "/* a comment */\n" + &following;
        let file = database.open("large.pyr", &text);
        let (plain, begun) = ("wheel r5 with radius 4\n", "wheel r5 /*with radius 4\n");
        assert_eq!(replace(&mut database, file, plain, begun), counts(35, 2, 2), "{cells} cells");
        assert_eq!(replace(&mut database, file, begun, plain), counts(99, 5, 5), "{cells} cells");
    }
}

#[test]
fn an_edit_in_an_imported_file_asks_who_uses_the_name() {
    for cells in [10, 1000] {
        let mut database = Database::new();
        let lib = database.open("lib.pyr", "wheel a with radius 4\nwheel b with radius 4\nsensor s\n");
        let text =
            "import \"lib.pyr\"\nrobot far with port 1 has { a b } wheels\n".to_owned() + &large(cells);
        let main = database.open("main.pyr", &text);
        assert_eq!(replace(&mut database, lib, "a with radius 4", "a with radius 5"), counts(13, 1, 2));
        let codes: Vec<_> = database.diagnostics(main).iter().map(crate::Diagnostic::code).collect();
        assert_eq!(codes, ["unused-declaration", "mixed-radii"], "{cells} cells");
        // And the other way round: nobody in a file asks what it imports again.
        assert_eq!(
            replace(&mut database, main, "m5 of robot5 {\n  move 4.0", "m5 of robot5 {\n  move 41.0"),
            counts(27, 1, 1)
        );
    }
}

/// An import that comes too late goes to the top: an edit there changes the place, though not the text, of the import.
#[test]
fn files_that_come_together_are_asked_once() {
    let open_chain = |database: &mut Database, length: usize| {
        let mut asked = 0;
        for number in 0..length {
            let text = format!("import \"{}.pyr\"\nwheel w{number} with radius 4", number + 1);
            database.open(&format!("{number}.pyr"), &text);
            asked += database.last_edit().revalidated;
        }
        asked
    };
    let (mut one_by_one, mut batched) = (Database::new(), Database::new());
    open_chain(&mut one_by_one, 20);
    batched.begin_batch();
    assert_eq!(open_chain(&mut batched, 20), 0);
    batched.end_batch();
    assert_eq!(batched.last_edit().revalidated, 20 * 2, "each entity once");
    for file in one_by_one.files() {
        assert_eq!(batched.diagnostics(file), one_by_one.diagnostics(file));
    }
}

#[test]
fn a_late_import_is_asked_when_the_top_of_its_file_changes() {
    let mut database = Database::new();
    let file = database.open("main.pyr", "movement\nimport \"lib.pyr\"\n");
    database.edit(file, Span::at(0), "/");
    let mut fresh = Database::new();
    let fresh_file = fresh.open("main.pyr", "/movement\nimport \"lib.pyr\"\n");
    assert_eq!(database.diagnostics(file), fresh.diagnostics(fresh_file));
}
