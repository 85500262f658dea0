//! Half-typed statements: a program cut off after each of its tokens, at the end of the file and with all
//! later entities after it.

use expect_test::expect_file;
use pydslrep_syntax::{lex, parse};

use crate::command::{Folder, Problem};
use crate::{GROUPS, by_file};

/// Something of everything.
const PROGRAM: &str = "\
wheel a with radius 4.5
wheelH b with radius 4.5
wheel c with radius 4.5
sensor s
sensor t : bumper
ip home 127.0.0.1
robot r type tw with port 23000 has { a, c } wheels with sensors { s, t }
movement m of r { move 4.0 meters at 9 turn left 90 turn right until { s t } }
parallel movement n of r { turn left }
environment e with ip home has { r } robots with { m n } moves
";

/// An entity's text up to one of its tokens, and the two programs it makes.
struct Cut {
    written: String,
    last: String,
    amid: String,
}

fn cuts() -> Vec<Cut> {
    let mut cuts = Vec::new();
    for (span, _) in parse(PROGRAM) {
        let entity = span.text(PROGRAM);
        let (before, following) = (&PROGRAM[..span.start as usize], &PROGRAM[span.end as usize..]);
        for (_, token) in lex(entity) {
            let written = entity[..token.end as usize].to_owned();
            let last = format!("{before}{written}");
            let amid = format!("{last}\n{following}");
            cuts.push(Cut { written, last, amid });
        }
    }
    cuts
}

fn errors(problems: &[Problem]) -> Vec<&str> {
    problems.iter().filter(|problem| problem.severity == "error").map(|problem| &*problem.message).collect()
}

fn listed(errors: &[&str]) -> String {
    if errors.is_empty() { "-".to_owned() } else { errors.join("\n        ") }
}

#[test]
fn a_program_can_be_cut_off_anywhere() {
    let folder = Folder::new();
    let cuts = cuts();
    for (number, cut) in cuts.iter().enumerate() {
        folder.write(&format!("{number:03}-last.pyr"), &cut.last);
        folder.write(&format!("{number:03}-amid.pyr"), &cut.amid);
    }
    let problems = by_file(folder.problems(&[]));
    let mut table = String::new();
    for (number, cut) in cuts.iter().enumerate() {
        let of =
            |place: &str| problems.get(&format!("{number:03}-{place}.pyr")).map_or(&[][..], Vec::as_slice);
        let (last, amid) = (errors(of("last")), errors(of("amid")));
        table += &format!("{}\n  last: {}\n", cut.written, listed(&last));
        if amid != last {
            table += &format!("  amid: {}\n", listed(&amid));
        }
        // A robot that is complete without its sensors does not have them.
        let consequences = if last.is_empty() { 2 } else { 1 };
        assert!(last.len() <= 1 && amid.len() <= consequences, "{}\n{last:#?}\n{amid:#?}", cut.written);
    }
    expect_file![format!("{GROUPS}/cut_off.txt")].assert_eq(&table);
}
