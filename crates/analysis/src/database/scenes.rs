//! Scenes of environments: files beside programs, given by whoever can read them.

use super::{Database, FileId};

impl Database {
    /// Sets the text of the scene file of an environment by its name, or takes it away. Kept while a file is closed, and
    /// whether or not there is such an environment.
    pub fn set_scene(&mut self, file: FileId, environment: &str, text: Option<&str>) {
        let known = self.scenes.get(&file).and_then(|scenes| scenes.get(environment));
        if known.map(AsRef::as_ref) == text {
            return;
        }
        let scenes = self.scenes.entry(file).or_default();
        match text {
            Some(text) => scenes.insert(environment.to_owned(), text.into()),
            None => scenes.remove(environment),
        };
        // Also when it is the last one that goes.
        self.touched.insert(file);
        self.touch_in_scenes();
        self.scenes.retain(|_, scenes| !scenes.is_empty());
    }

    /// The scenes there are: of which file, of which environment, and their texts.
    pub fn scenes(&self) -> impl Iterator<Item = (FileId, &str, &str)> {
        self.scenes.iter().flat_map(|(file, scenes)| {
            scenes.iter().map(|(name, text)| (*file, name.as_str(), text.as_ref()))
        })
    }

    /// What a path meets depends on everything its environment sees.
    pub(super) fn touch_in_scenes(&mut self) {
        let mut concerned = Vec::new();
        for home in self.scenes.keys() {
            let seen: Vec<FileId> = std::iter::once(*home).chain(self.imported_files(*home)).collect();
            if seen.iter().any(|file| self.touched.contains(file)) {
                concerned.extend(seen);
            }
        }
        self.touched.extend(concerned);
    }
}
