//! `pydslrep explain`: the page of a diagnostic.

use std::process::ExitCode;

use clap::Args;
use clap::builder::styling::{AnsiColor, Effects, Style};
use pydslrep_analysis::Severity;
use pydslrep_analysis::diagnostics::{CATALOGUE, Rule};
use pydslrep_config::find_rule;

use crate::failure::Failure;
use crate::help::{self, Help};
use crate::report::output;

const HELP: Help = Help {
    examples: &[
        ("pydslrep explain", "all diagnostics"),
        ("pydslrep explain invalid-radius", "one of them, with an example"),
    ],
    notes: &[],
};

/// Explain a diagnostic: what it finds, why that matters, and what to write instead
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// The code of a diagnostic, such as `wheel-count` [default: list all]
    code: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// If there is no such diagnostic, or nothing can be printed.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let columns = help::columns();
    output::print(&match &arguments.code {
        Some(code) => page(&find_rule(code)?.manual(), columns),
        None => list(columns),
    })?;
    Ok(ExitCode::SUCCESS)
}

/// All diagnostics, one per line if the terminal is wide enough.
fn list(columns: usize) -> String {
    let length =
        |word: fn(&Rule) -> &str| CATALOGUE.into_iter().map(|rule| word(rule).len()).max().unwrap_or(0);
    let (codes, severities) = (length(|rule| rule.code), length(|rule| rule.severity.word()));
    let indentation = " ".repeat(codes + severities + 4);
    let options = textwrap::Options::new(columns).subsequent_indent(&indentation);
    let bold = Style::new().effects(Effects::BOLD);
    let mut out = String::new();
    for rule in CATALOGUE {
        let (code, severity) = (rule.code, rule.severity.word());
        let plain = format!("{code:codes$}  {severity:severities$}  {}", rule.summary);
        let wrapped = textwrap::fill(&plain, &options);
        // Colours are added last: they have no width.
        let rest = wrapped.get(codes + 2 + severities..).unwrap_or_default();
        let colour = colour(rule.severity);
        out += &format!("{bold}{code:codes$}{bold:#}  {colour}{severity:severities$}{colour:#}{rest}\n");
    }
    out
}

/// The colour of a severity.
fn colour(severity: Severity) -> Style {
    match severity {
        Severity::Error => AnsiColor::BrightRed.on_default(),
        Severity::Warning => AnsiColor::Yellow.on_default(),
        Severity::Information => AnsiColor::BrightBlue.on_default(),
        Severity::Hint => AnsiColor::BrightGreen.on_default(),
    }
}

/// A page of the catalogue, which is in Markdown, for a terminal: headings bold, programs indented, text wrapped.
fn page(markdown: &str, columns: usize) -> String {
    let heading = Style::new().effects(Effects::BOLD);
    let mut out = String::new();
    let mut is_program = false;
    for line in markdown.lines() {
        if line.starts_with("```") {
            is_program = !is_program;
        } else if line.is_empty() {
            out.push('\n');
        } else if is_program {
            out += &format!("    {line}\n");
        } else if let Some(title) = line.strip_prefix("# ").or_else(|| line.strip_prefix("## ")) {
            out += &format!("{heading}{title}{heading:#}\n");
        } else {
            out += &format!("{}\n", textwrap::fill(line, columns));
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;

    #[test]
    fn programs_keep_their_lines_and_text_does_not() {
        let markdown =
            "# a-code\n\nWhat `it` finds here.\n\n```pydslrep\n# far too long for a line\n\nb\n```\n";
        expect![[r#"
            ESC[1ma-codeESC[0m

            What `it`
            finds
            here.

                # far too long for a line

                b
        "#]]
        .assert_eq(&page(markdown, 10).replace('\u{1b}', "ESC"));
    }

    #[test]
    fn every_page_is_readable_on_a_narrow_terminal() {
        for rule in CATALOGUE {
            let page = page(&rule.manual(), 72);
            assert!(!page.contains("```") && !page.contains("\n#"), "{page}");
            assert!(
                page.lines().all(|line| line.starts_with("    ") || line.chars().count() <= 72),
                "{page}"
            );
        }
    }
}
