//! `random-programs COUNT LINES [tidy] [flat | known] [mutated]`: prints reproducible random programs for tests that are not
//! in Rust, each followed by NUL. All are grammatical; every third has imports. `tidy` ones have no errors, imports or unusual
//! layout. `flat` ones have only the statements of language 0.2, `known` ones only those whose planned path is known. `mutated`
//! ones have one wrong token, and need not be grammatical.

use std::io::{Result, Write};
use std::process::ExitCode;

use pydslrep_naive::{Recipe, Statements, mutated};

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, lines, options @ ..] = &arguments[..] else { return usage() };
    let (Ok(count), Ok(lines)) = (count.parse::<u32>(), lines.parse()) else { return usage() };
    let mut recipe = Recipe { lines, ..Recipe::default() };
    let (mut is_tidy, mut is_mutated) = (false, false);
    for option in options {
        match option.as_str() {
            "tidy" => is_tidy = true,
            "flat" => recipe.statements = Statements::Flat,
            "known" => recipe.statements = Statements::Known,
            "mutated" => is_mutated = true,
            _ => return usage(),
        }
    }
    if is_tidy {
        recipe = Recipe { mistakes: false, odd_layout: false, older_spellings: false, ..recipe };
    }
    let mut output = std::io::stdout().lock();
    for seed in 0..u64::from(count) {
        recipe.imports = !is_tidy && seed % 3 == 0;
        let program = recipe.seeded(seed);
        let program = if is_mutated { mutated(&program, seed, 1) } else { program };
        write!(output, "{program}\0")?;
    }
    Ok(ExitCode::SUCCESS)
}

fn usage() -> Result<ExitCode> {
    writeln!(std::io::stderr(), "usage: random-programs COUNT LINES [tidy] [flat | known] [mutated]")?;
    Ok(ExitCode::from(2))
}
