//! `pydslrep preview`: the planned path of a saved program, as a page in a browser.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use pydslrep_config::Config;
use pydslrep_server::FilePreview;

use crate::failure::Failure;
use crate::help::Help;
use crate::inputs::Inputs;
use crate::inputs::paths::absolute;
use crate::inputs::watch::{Scope, Watch};
use crate::report::output;
use crate::run::interrupt::{self, Interrupts};

const HELP: Help = Help {
    examples: &[
        ("pydslrep preview patrol.pyr", "opens the page in a browser"),
        ("pydslrep preview patrol.pyr --no-open", "prints its address only"),
    ],
    notes: &[
        "The page follows the saved program, its imports, its scenes and its settings until Ctrl+C. It is \
         served to this machine only, under an address with a random secret.",
    ],
};

/// Show the planned path in a browser, and follow the saved program
#[derive(Debug, Args)]
#[command(after_help = HELP.text())]
pub(crate) struct Arguments {
    /// A program
    program: PathBuf,
    /// Print the page's address without opening a browser
    #[arg(long)]
    no_open: bool,
    /// The port of this machine to serve the page on; 0 is any free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
}

/// Runs the command.
///
/// # Errors
/// If the program cannot be read, the page not be served, or changes not be watched.
pub(crate) fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    if arguments.program == Path::new("-") {
        return Err(Failure::new("standard input cannot be followed").help("name a file"));
    }
    // The preview has a runtime of its own, which must not be dropped inside of another one.
    let mut preview = start(arguments)?;
    interrupt::run("start the preview", async |interrupts| {
        // Only now: a user who reads how to stop it may do so at once.
        output::print(&format!("Path preview: {}\nPress Ctrl+C to stop.\n", preview.address()))?;
        if !arguments.no_open
            && let Err(error) = opener::open_browser(preview.address())
        {
            output::say(&format!("cannot open a browser: {error}\n"));
        }
        follow(arguments, &mut preview, interrupts).await
    })
}

fn start(arguments: &Arguments) -> Result<FilePreview, Failure> {
    let (inputs, file) = Inputs::open_one(&arguments.program, &Config::default())?;
    let program = absolute(&arguments.program)?;
    FilePreview::start(&program, inputs.text(file), arguments.port).map_err(|error| {
        Failure::new(error.to_string()).help("choose another port, or leave out --port for any free one")
    })
}

/// Shows the program as it is saved until an interrupt.
async fn follow(
    arguments: &Arguments,
    preview: &mut FilePreview,
    mut interrupts: Interrupts,
) -> Result<ExitCode, Failure> {
    let mut watch = Watch::new();
    watch.look_at(scope(&arguments.program, &Inputs::default())?)?;
    loop {
        let scope = match Inputs::open_one(&arguments.program, &Config::default()) {
            Ok((inputs, file)) => {
                let scope = scope(&arguments.program, &inputs)?;
                preview.changed(inputs.text(file), scope.files.iter().map(PathBuf::as_path));
                scope
            }
            // The program is being replaced, or its settings are wrong: the last path stays.
            Err(_) => watch.scope().clone(),
        };
        if *watch.scope() != scope {
            // A file that is watched only from now on may have changed before.
            watch.look_at(scope)?;
            continue;
        }
        tokio::select! {
            () = watch.change() => {}
            () = interrupts.next() => return Ok(ExitCode::from(interrupt::EXIT_CODE)),
        }
        watch.look_at(scope)?;
    }
}

/// The files that the program depends on.
fn scope(program: &Path, inputs: &Inputs) -> Result<Scope, Failure> {
    let mut files = inputs.paths();
    files.insert(absolute(program)?);
    Ok(Scope { files, ..Scope::default() })
}
