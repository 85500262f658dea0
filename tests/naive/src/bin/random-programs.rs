//! `random-programs COUNT LINES`: programs at random for tests that are not in Rust, the same ones every time, with a
//! NUL behind each. All are grammatical; every third has imports.

use std::io::{Result, Write};
use std::process::ExitCode;

use pydslrep_naive::Recipe;

fn main() -> Result<ExitCode> {
    let mut numbers = std::env::args().skip(1).map_while(|argument| argument.parse::<u32>().ok());
    let (Some(count), Some(lines)) = (numbers.next(), numbers.next()) else {
        writeln!(std::io::stderr(), "usage: random-programs COUNT LINES")?;
        return Ok(ExitCode::from(2));
    };
    let mut output = std::io::stdout().lock();
    for seed in 0..count {
        let recipe = Recipe { lines: lines as usize, imports: seed % 3 == 0, ..Recipe::default() };
        write!(output, "{}\0", recipe.seeded(u64::from(seed)))?;
    }
    Ok(ExitCode::SUCCESS)
}
