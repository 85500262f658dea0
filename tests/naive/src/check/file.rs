//! Group "file", and what else takes imports.

use crate::Finding;
use crate::project::Scope;

pub(super) fn check(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    for (path, file) in scope.imports() {
        if file.is_none() {
            findings.push(Finding::new("unresolved-import", path));
        }
    }
    for (kind, name) in scope.program().references() {
        let is_own =
            scope.find(kind, &name.text).is_some_and(|found| std::ptr::eq(found.home.file(), scope.file()));
        if !is_own && scope.imported(kind, &name.text).len() > 1 {
            findings.push(Finding::new("ambiguous-import", &name.range));
        }
    }
    no_environment(scope, findings);
}

/// Robots and movements but no environment, and nobody imports the file; reported at the last entity.
fn no_environment(scope: Scope<'_>, findings: &mut Vec<Finding>) {
    let program = scope.program();
    let has_parts = program.has_any("robot") && program.has_any("movement");
    if has_parts && !program.has_any("environment") && !scope.is_imported() {
        let last = program.entities.last();
        findings.extend(last.map(|entity| Finding::new("no-environment", &entity.name.range)));
    }
}
