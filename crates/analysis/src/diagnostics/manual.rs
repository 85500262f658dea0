//! The page of each rule: what it finds, why that matters, a program that has the problem and one that has not.
//!
//! The files in `docs/diagnostics` are written from here, and tests hold every page to what the checks do.

use pydslrep_scene::ENDING;

use super::catalogue::CATALOGUE;
use super::not_in_article;
use super::rule::{Page, Rule};
use crate::{Absence, Database, Diagnostic, Edition, Target};

impl Rule {
    /// The page in Markdown, with what the example gives rise to.
    pub fn manual(&self) -> String {
        let Page { what, why, imports, example, fixed } = &self.page;
        let says: String =
            example_diagnostics(self, example).iter().map(|diagnostic| said(example, diagnostic)).collect();
        let mut files = String::new();
        for (name, text) in *imports {
            let block = if name.ends_with(ENDING) { block("toml", text) } else { code(text) };
            files += &format!("`{name}`:\n\n{block}\n");
        }
        if !files.is_empty() {
            files += "The program:\n\n";
        }
        format!(
            "# {}\n\n{} · quick fix: {}\n\n{what}\n\n## Why it matters\n\n{why}\n\n## Example\n\n{files}{}\n\
             This says:\n\n```text\n{says}```\n\n## Write instead\n\n{}",
            self.code,
            capitalised(self.severity.word()),
            self.applicability.word(),
            code(example),
            code(fixed),
        )
    }
}

/// The list of all pages in Markdown.
pub fn index() -> String {
    let mut out = "# Every message, explained\n\n\
        Each message of PyDSLRep has a code, such as `invalid-radius`. Its page says what is wrong, why that matters, and\n\
        how to write it instead.\n\n\
        An **error** keeps scripts from being made. A **warning** is probably a slip. An **information** or a **hint** is\n\
        worth a look. Many editors offer quick fixes: a *safe* one leaves nothing to decide, and a *suggested* one is\n\
        worth reading before you take it. Not every case has one.\n\n\
        | code | severity | what it finds | quick fix |\n|---|---|---|---|\n"
        .to_owned();
    for rule in CATALOGUE {
        let (code, summary) = (rule.code, rule.summary);
        let (severity, applicability) = (rule.severity.word(), rule.applicability.word());
        out += &format!("| [{code}]({code}.md) | {severity} | {summary} | {applicability} |\n");
    }
    out
}

/// The problems that one of the programs of a rule's page has. There are no other files than those of the page. Where it
/// has none with the usual target, those with the other one: some rules are of one target alone.
fn example_diagnostics(rule: &Rule, program: &str) -> Vec<Diagnostic> {
    let for_target = |target| target_diagnostics(rule, program, target);
    Target::ALL.into_iter().map(for_target).find(|found| !found.is_empty()).unwrap_or_default()
}

fn target_diagnostics(rule: &Rule, program: &str, target: Target) -> Vec<Diagnostic> {
    let of_article = rule.code == not_in_article::RULE.code;
    let mut database = Database::new();
    let file = database.open("program.pyr", program);
    for (name, text) in rule.page.imports {
        match name.strip_suffix(ENDING) {
            Some(environment) => database.set_scene(file, environment, Some(text)),
            None => {
                database.open(name, text);
            }
        }
    }
    database.set_target(file, target);
    database.set_edition(file, if of_article { Edition::Article } else { Edition::default() });
    for path in database.imports(file).to_vec() {
        if database.file(&path).is_none() {
            database.set_absence(file, &path, Some(Absence::Missing));
        }
    }
    database.diagnostics(file)
}

fn said(program: &str, diagnostic: &Diagnostic) -> String {
    let before = program.get(..diagnostic.span.start as usize).unwrap_or(program);
    let line = before.matches('\n').count() + 1;
    let mut out = format!("line {line}: {}: {}\n", diagnostic.severity.word(), diagnostic.message);
    for (word, text) in [("help", &diagnostic.help), ("note", &diagnostic.note)] {
        if let Some(text) = text {
            out += &format!("  {word}: {text}\n");
        }
    }
    for fix in &diagnostic.fixes {
        out += &format!("  quick fix: {}\n", fix.title);
    }
    out
}

fn code(program: &str) -> String {
    block("pydslrep", program)
}

fn block(language: &str, text: &str) -> String {
    format!("```{language}\n{text}\n```\n")
}

fn capitalised(word: &str) -> String {
    let (first, rest) = word.split_at(word.len().min(1));
    first.to_uppercase() + rest
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::{Path, PathBuf};

    use expect_test::expect_file;

    use super::super::rule::Applicability;
    use super::*;
    use crate::diagnostics::testing::{applicability, apply};

    #[test]
    fn every_example_has_its_problem_and_no_other() {
        for rule in CATALOGUE {
            let found = example_diagnostics(rule, rule.page.example);
            let codes: Vec<&str> = found.iter().map(Diagnostic::code).collect();
            assert_eq!(codes, [rule.code], "{}", rule.page.example);
            assert_eq!(found[0].severity, rule.severity, "{}", rule.code);
            let fixed = example_diagnostics(rule, rule.page.fixed);
            assert!(fixed.is_empty(), "{}: {fixed:#?}", rule.code);
        }
    }

    #[test]
    fn every_fix_of_an_example_mends_it() {
        for rule in CATALOGUE {
            for diagnostic in example_diagnostics(rule, rule.page.example) {
                let best = diagnostic.fixes.iter().map(applicability).max();
                assert_eq!(best.unwrap_or(Applicability::Never), rule.applicability, "{}", rule.code);
                for fix in &diagnostic.fixes {
                    let fixed = apply(rule.page.example, diagnostic.file, &fix.edits);
                    let left = example_diagnostics(rule, &fixed);
                    assert!(left.is_empty(), "{}: {}\n{fixed}\n{left:#?}", rule.code, fix.title);
                }
            }
        }
    }

    #[test]
    fn the_pages_are_those_of_the_catalogue() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/diagnostics");
        let mut written = BTreeSet::from([folder.join("README.md")]);
        expect_file![folder.join("README.md")].assert_eq(&index());
        for rule in CATALOGUE {
            let path = folder.join(format!("{}.md", rule.code));
            expect_file![&path].assert_eq(&rule.manual());
            written.insert(path);
        }
        let there: BTreeSet<PathBuf> =
            folder.read_dir().expect("the folder").map(|entry| entry.expect("a file").path()).collect();
        assert_eq!(there, written);
    }
}
