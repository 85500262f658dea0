//! Requests completion in tests.

use expect_test::Expect;

use super::{CompletionTrigger, completions};
use crate::fixture::{PARTS, at_cursor, at_cursor_in};

/// Compares the list that the user asks for with the expected one.
pub(super) fn check(fixture: &str, expected: &Expect) {
    let (database, position) = at_cursor(fixture);
    let rendered =
        completions(&database, position, CompletionTrigger::Invoked, 9.0).into_iter().map(|item| {
            let replaced = database.slice(position.file, item.replace);
            format!("{} [{}] {replaced:?} -> {:?}\n", item.label, item.detail, item.insert)
        });
    expected.assert_eq(&rendered.collect::<String>());
}

/// The same in the last of several files, with the imports that items add.
pub(super) fn check_in(files: &[(&str, &str)], expected: &Expect) {
    let (database, position) = at_cursor_in(files);
    let rendered =
        completions(&database, position, CompletionTrigger::Invoked, 9.0).into_iter().map(|item| {
            let replaced = database.slice(position.file, item.replace);
            let import = item.import_edit.map(|edit| format!(" and {:?} at {}", edit.text, edit.span.start));
            let import = import.unwrap_or_default();
            format!("{} [{}] {replaced:?} -> {:?}{import}\n", item.label, item.detail, item.insert)
        });
    expected.assert_eq(&rendered.collect::<String>());
}

/// The list that opens automatically after the character before the cursor.
pub(super) fn opens(fixture: &str) -> Vec<String> {
    let (database, position) = at_cursor(fixture);
    let typed = fixture[..position.offset as usize].chars().last().unwrap();
    let is_letter = typed.is_alphanumeric() || typed == '_';
    let trigger = if is_letter { CompletionTrigger::Letter } else { CompletionTrigger::Character(typed) };
    completions(&database, position, trigger, 9.0).into_iter().map(|item| item.label).collect()
}

/// The list that the user asks for.
pub(super) fn asked(fixture: &str) -> Vec<String> {
    let (database, position) = at_cursor(fixture);
    let found = completions(&database, position, CompletionTrigger::Invoked, 9.0);
    found.into_iter().map(|item| item.label).collect()
}

/// The labels of the items in a movement of `rover`.
pub(super) fn labels_in(action: &str) -> Vec<String> {
    asked(&format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{\n  {action}"))
}
