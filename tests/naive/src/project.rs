//! Files that import each other, and what a name means in each of them.

use std::ops::Deref;

use crate::program::{Body, Entity, Movement, Program, Robot, Sensor, Wheel};

/// The files of a project.
pub(crate) struct Project {
    pub(crate) files: Vec<File>,
}

/// One of its files.
pub(crate) struct File {
    pub(crate) path: String,
    /// Whether its scripts are for V-REP.
    pub(crate) for_vrep: bool,
    pub(crate) program: Program,
}

impl Project {
    /// The file that an import leads to.
    fn imported(&self, from: &File, path: &str) -> Option<usize> {
        let path = joined(&from.path, path);
        self.files.iter().position(|file| file.path == path)
    }
}

/// A path relative to the folder of a file.
fn joined(file: &str, path: &str) -> String {
    let mut parts: Vec<&str> = file.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        if part == ".." {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    parts.join("/")
}

/// A file, to look up names as it sees them: its own first, then those of the files that it imports.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'a> {
    project: &'a Project,
    file: usize,
}

impl<'a> Scope<'a> {
    pub(crate) fn new(project: &'a Project, file: usize) -> Self {
        Self { project, file }
    }

    pub(crate) fn file(self) -> &'a File {
        &self.project.files[self.file]
    }

    pub(crate) fn program(self) -> &'a Program {
        &self.file().program
    }

    /// Each import: the range of its path, and the file that it leads to.
    pub(crate) fn imports(self) -> impl Iterator<Item = (&'a std::ops::Range<usize>, Option<Self>)> {
        self.program().imports.iter().map(move |path| {
            let file = self.project.imported(self.file(), &path.text);
            (&path.range, file.map(|file| Self { file, ..self }))
        })
    }

    /// Whether another file, or it itself, imports it.
    pub(crate) fn is_imported(self) -> bool {
        let mut files = (0..self.project.files.len()).map(|file| Self { file, ..self });
        files.any(|other| other.imports().any(|(_, to)| to.is_some_and(|to| to.file == self.file)))
    }

    /// Whether an import leads nowhere: then any name may be declared there.
    pub(crate) fn lacks_imports(self) -> bool {
        self.imports().any(|(_, to)| to.is_none())
    }

    /// The declarations of a name in the files that it imports, one of each.
    pub(crate) fn imported(self, kind: &str, name: &str) -> Vec<Declared<'a, Entity>> {
        let mut found: Vec<Declared<'a, Entity>> = Vec::new();
        for scope in self.imports().filter_map(|(_, to)| to) {
            if found.iter().all(|other| other.home.file != scope.file)
                && let Some(entity) = scope.program().declaration(kind, name)
            {
                found.push(Declared { home: scope, entity, body: entity });
            }
        }
        found
    }

    /// What a reference means: the first declaration in this file, else in the first imported one that has any.
    pub(crate) fn find(self, kind: &str, name: &str) -> Option<Declared<'a, Entity>> {
        match self.program().declaration(kind, name) {
            Some(entity) => Some(Declared { home: self, entity, body: entity }),
            None => self.imported(kind, name).into_iter().next(),
        }
    }

    pub(crate) fn wheel(self, name: &str) -> Option<&'a Wheel> {
        match &self.find("wheel", name)?.entity.body {
            Body::Wheel(wheel) => Some(wheel),
            _ => None,
        }
    }

    pub(crate) fn sensor(self, name: &str) -> Option<&'a Sensor> {
        match &self.find("sensor", name)?.entity.body {
            Body::Sensor(sensor) => Some(sensor),
            _ => None,
        }
    }

    pub(crate) fn robot(self, name: &str) -> Option<Declared<'a, Robot>> {
        let Declared { home, entity, .. } = self.find("robot", name)?;
        match &entity.body {
            Body::Robot(body) => Some(Declared { home, entity, body }),
            _ => None,
        }
    }

    pub(crate) fn movement(self, name: &str) -> Option<Declared<'a, Movement>> {
        let Declared { home, entity, .. } = self.find("movement", name)?;
        match &entity.body {
            Body::Movement(body) => Some(Declared { home, entity, body }),
            _ => None,
        }
    }
}

/// A declaration, with the file in which its own references are looked up.
pub(crate) struct Declared<'a, T> {
    pub(crate) home: Scope<'a>,
    entity: &'a Entity,
    body: &'a T,
}

impl<T> Declared<'_, T> {
    /// Whether it is this entity.
    pub(crate) fn is_entity(&self, entity: &Entity) -> bool {
        std::ptr::eq(self.entity, entity)
    }

    /// Whether two references mean the same declaration.
    pub(crate) fn is(&self, other: &Self) -> bool {
        std::ptr::eq(self.entity, other.entity)
    }
}

impl<T> Deref for Declared<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.body
    }
}
