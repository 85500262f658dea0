//! What edits cost, counted: as much in a long file as in a short one.

use pydslrep_syntax::Span;

use crate::Database;

/// A file of many cells, each with its own wheels, robot and movement.
fn large(cells: usize) -> String {
    let cell = |number: usize| {
        format!(
            "wheel l{number} with radius 4\nwheel r{number} with radius 4\n\
             robot robot{number} type tw with port 1 has {{ l{number} r{number} }} wheels\n\
             movement m{number} of robot{number} {{\n  move 4.0 meters\n  turn left 30\n}}\n\
             environment e{number} has {{ robot{number} }} robots with {{ m{number} }} moves\n"
        )
    };
    (0..cells).map(cell).collect()
}

#[test]
fn an_edit_inside_a_movement_costs_the_same_in_any_file() {
    for cells in [10, 1000] {
        let mut database = Database::new();
        let text = large(cells);
        let file = database.open("large.pyr", &text);
        let at = text.find("turn left 30").unwrap() + "turn left 3".len();
        let at = u32::try_from(at).unwrap();
        database.edit(file, Span::at(at), "6");
        let counts = database.last_edit();
        assert_eq!((counts.reparsed, counts.revalidated), (1, 1), "{cells} cells");
    }
}

#[test]
fn renaming_a_robot_asks_only_those_who_use_it() {
    let mut database = Database::new();
    let text = large(1000);
    let file = database.open("large.pyr", &text);
    let at = u32::try_from(text.find("robot robot500 ").unwrap() + "robot robot500".len()).unwrap();
    database.edit(file, Span::at(at), "x");
    // The robot itself, its movement and its environment.
    assert_eq!(database.last_edit().revalidated, 3);
    let codes: Vec<_> = database.diagnostics(file).iter().map(crate::Diagnostic::code).collect();
    assert_eq!(codes, ["unused-declaration", "unresolved-reference", "unresolved-reference"]);
}
