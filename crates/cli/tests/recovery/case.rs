//! The files of cases: Markdown with a heading, a program and its messages for each.

/// A file of cases.
pub(crate) struct Group {
    parts: Vec<Part>,
    /// The text after every program, which makes sure that only the subject of the case is wrong.
    following: String,
}

enum Part {
    /// Passed on as it is.
    Prose(String),
    Case(Case),
}

/// A broken program.
pub(crate) struct Case {
    pub(crate) title: String,
    /// As the file has it, with its fences.
    source: String,
    program: String,
}

const PROGRAM: &str = "```pyr";
const ESCAPED: &str = "```pyr escaped";
const FOLLOWING: &str = "```pyr following";
const MESSAGE: &str = "```text";
const END: &str = "```";

impl Group {
    pub(crate) fn read(text: &str) -> Self {
        let (mut parts, mut following, mut title) = (Vec::new(), String::new(), String::new());
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            match line {
                PROGRAM | ESCAPED | FOLLOWING => {
                    let written: Vec<&str> = lines.by_ref().take_while(|line| *line != END).collect();
                    let program = written.join("\n") + "\n";
                    let source = format!("{line}\n{program}{END}\n");
                    match line {
                        FOLLOWING => {
                            following = program;
                            parts.push(Part::Prose(source));
                        }
                        ESCAPED => {
                            let program = unescape(program.trim_end_matches('\n'));
                            parts.push(Part::Case(Case { title: title.clone(), source, program }));
                        }
                        _ => parts.push(Part::Case(Case { title: title.clone(), source, program })),
                    }
                }
                MESSAGE => lines.by_ref().take_while(|line| *line != END).for_each(drop),
                _ => {
                    if let Some(heading) = line.strip_prefix("## ") {
                        heading.clone_into(&mut title);
                    }
                    parts.push(Part::Prose(format!("{line}\n")));
                }
            }
        }
        Self { parts, following }
    }

    pub(crate) fn cases(&self) -> impl Iterator<Item = &Case> {
        self.parts.iter().filter_map(|part| match part {
            Part::Case(case) => Some(case),
            Part::Prose(_) => None,
        })
    }

    /// The whole text of a case's file.
    pub(crate) fn program(&self, case: &Case) -> String {
        format!("{}{}", case.program, self.following)
    }

    /// The file with these messages, one for each case.
    pub(crate) fn with_messages(&self, messages: &[String]) -> String {
        let mut messages = messages.iter();
        let mut out = String::new();
        for part in &self.parts {
            match part {
                Part::Prose(text) => out += text,
                Part::Case(case) => {
                    let message = messages.next().unwrap();
                    out += &format!("{}{MESSAGE}\n{message}{END}\n", case.source);
                }
            }
        }
        out
    }
}

impl Case {
    /// The expected number of problems.
    pub(crate) fn problems(&self) -> usize {
        let counted = self.title.rsplit_once(" (").and_then(|(_, end)| end.strip_suffix(" problems)"));
        match counted {
            Some("no") => 0,
            Some(number) => number.parse().unwrap(),
            None => 1,
        }
    }
}

/// Signs that cannot be seen in a file.
fn unescape(text: &str) -> String {
    let signs = [("\\r", "\r"), ("\\n", "\n"), ("\\t", "\t"), ("\\u{feff}", "\u{feff}"), ("\\0", "\0")];
    signs.iter().fold(text.to_owned(), |text, (escape, sign)| text.replace(escape, sign))
}
