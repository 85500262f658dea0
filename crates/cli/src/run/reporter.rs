//! Reports of a run: to people on the terminal, and to programs as events (`docs/run-events.md`).

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

use pydslrep_output::{Kind, open_output};
use pydslrep_trace::{FailureClass, FileKind, RunEvent, RunFailure};

use crate::failure::Failure;
use crate::report::output;
use crate::run::outcome::Figures;

/// The name of standard output, in place of a file's.
pub(crate) const STANDARD_OUTPUT: &str = "-";

/// Returns whether a path stands for standard output.
pub(crate) fn is_standard_output(path: &Path) -> bool {
    path.as_os_str() == STANDARD_OUTPUT
}

/// Reports a run.
pub(crate) struct Reporter {
    sink: RefCell<Sink>,
}

/// Where events go.
enum Sink {
    Nowhere,
    /// Standard output, which has nothing else then.
    StandardOutput,
    File(File),
}

impl Reporter {
    /// Reports to people and, if a target is given, to a program: it is a file, or `-` for standard output.
    ///
    /// # Errors
    /// If the file holds anything but events of an earlier run, or cannot be written.
    pub(crate) fn open(target: Option<&Path>) -> Result<Self, Failure> {
        let sink = match target {
            None => Sink::Nowhere,
            Some(path) if is_standard_output(path) => Sink::StandardOutput,
            Some(path) => Sink::File(open_output(path, Kind::Events)?),
        };
        Ok(Self { sink: RefCell::new(sink) })
    }

    /// Reports to people alone.
    pub(crate) fn for_people() -> Self {
        Self { sink: RefCell::new(Sink::Nowhere) }
    }

    /// Writes an event for programs. Like people's messages, it may have no reader any more.
    pub(crate) fn write(&self, event: &RunEvent) {
        let line = event.line();
        let _ = match &mut *self.sink.borrow_mut() {
            Sink::Nowhere => Ok(()),
            Sink::StandardOutput => {
                let mut out = io::stdout().lock();
                out.write_all(line.as_bytes()).and_then(|()| out.flush())
            }
            Sink::File(file) => file.write_all(line.as_bytes()),
        };
    }

    /// A step of the preparations; people see it elsewhere.
    pub(crate) fn progress(&self, text: &str) {
        self.write(&RunEvent::Progress { t: None, robot: None, text: text.to_owned() });
    }

    /// Reports a warning: the run continues.
    pub(crate) fn warn(&self, text: &str, help: Option<&str>) {
        output::warning(text, help);
        self.write(&RunEvent::Warning { text: text.to_owned(), help: help.map(str::to_owned) });
    }

    /// Reports a failure to programs only; people read of it elsewhere.
    pub(crate) fn fail(&self, failure: &Failure) {
        if let Failure::Message { message, help, .. } = failure {
            let failure = RunFailure::new(FailureClass::Setup, message);
            self.write(&RunEvent::Failed(RunFailure { help: help.clone(), ..failure }));
        }
    }

    /// Reports errors of the program to programs only; people read them on standard error.
    pub(crate) fn refuse(&self, message: &str) {
        self.write(&RunEvent::Failed(RunFailure::new(FailureClass::Program, message)));
    }

    /// Reports why a script ended.
    pub(crate) fn report_failure(&self, failure: &RunFailure) {
        let message = &failure.message;
        if let Some(text) = &failure.output {
            output::say(&format!("{text}\n"));
        }
        match failure.class {
            FailureClass::Interrupted => output::say("interrupted\n"),
            // Python's traceback says more.
            FailureClass::Crash if failure.output.is_some() => {}
            _ if message.contains('\n') => output::say(&format!("error: {message}\n")),
            _ => output::error(message, None),
        }
        self.write(&RunEvent::Failed(failure.clone()));
    }

    /// Reports the result: its table is on standard output unless events are there.
    ///
    /// # Errors
    /// If it cannot be printed.
    pub(crate) fn report_figures(&self, figures: &Figures<'_>) -> Result<(), Failure> {
        let table = figures.table();
        if !matches!(*self.sink.borrow(), Sink::StandardOutput) {
            output::print(&table)?;
        }
        // Numbers and names can always be written.
        let figures = serde_json::to_value(figures).unwrap_or_default();
        self.write(&RunEvent::Figures { figures, table });
        Ok(())
    }

    /// Reports a file of results.
    pub(crate) fn report_file(&self, kind: FileKind, path: &Path) {
        let what = match kind {
            FileKind::Trace => "trace",
            FileKind::Map => "map",
            FileKind::MapPicture => "picture of the map",
            FileKind::Figures => "figures",
            FileKind::Picture => "picture",
            FileKind::Replay => "replay",
        };
        output::say(&format!("{what}: {}\n", path.display()));
        self.write(&RunEvent::File { kind, path: path.display().to_string() });
    }
}
