//! `random-programs COUNT LINES [tidy]`: prints reproducible random programs for tests that are not in Rust, each followed
//! by NUL. All are grammatical; every third has imports. `tidy` ones have no errors, imports or unusual layout.

use std::io::{Result, Write};
use std::process::ExitCode;

use pydslrep_naive::Recipe;

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let (count, lines, is_tidy) = match arguments[..] {
        [count, lines] => (count.parse::<u32>(), lines.parse(), false),
        [count, lines, "tidy"] => (count.parse(), lines.parse(), true),
        _ => return usage(),
    };
    let (Ok(count), Ok(lines)) = (count, lines) else { return usage() };
    let mut output = std::io::stdout().lock();
    for seed in 0..count {
        let recipe = if is_tidy {
            Recipe { lines, mistakes: false, odd_layout: false, older_spellings: false, imports: false }
        } else {
            Recipe { lines, imports: seed % 3 == 0, ..Recipe::default() }
        };
        write!(output, "{}\0", recipe.seeded(u64::from(seed)))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn usage() -> Result<ExitCode> {
    writeln!(std::io::stderr(), "usage: random-programs COUNT LINES [tidy]")?;
    Ok(ExitCode::from(2))
}
