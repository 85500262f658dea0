//! The names of a program in the scenes of its environments: what each refers to, where scenes mention a name, and what
//! a rename changes in them.
//!
//! A scene is known by its program and its environment: which file that is, the caller knows.

use pydslrep_analysis::{Database, EntityId, FileId};
use pydslrep_schema::{NamePart, as_key, name_parts};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::SmolStr;

use crate::FilePosition;
use crate::cursor::{Referent, referent_at};
use crate::references::declaration;
use crate::rename::{RenameError, parse_name};

/// A place in the scene of an environment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenePlace {
    /// The program.
    pub program: FileId,
    /// The environment in it.
    pub environment: SmolStr,
    /// Where in the scene's text; empty and at its start if the whole file is meant.
    pub span: Span,
}

/// A name in a scene, and what it refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NameInScene {
    /// Where it is in the scene's text, including quotes.
    pub span: Span,
    /// Its declaration in a program.
    pub declared: FilePosition,
}

/// The changes of a rename outside of programs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SceneChanges {
    /// Places in scenes, with their new text.
    pub edits: Vec<(ScenePlace, String)>,
    /// The environment whose scene gets another name, and its new name; the span says nothing.
    pub renamed: Option<(ScenePlace, SmolStr)>,
}

/// A name of the program, as a scene writes it.
#[derive(Debug)]
pub(super) struct Written {
    pub(super) kind: EntityKind,
    pub(super) name: SmolStr,
    /// The robot that the scene says it belongs to: itself, for a robot.
    pub(super) robot: SmolStr,
    pub(super) span: Span,
}

/// The name at an offset of the scene of an environment. The table `robots` stands for the environment.
pub fn name_in_scene(
    database: &Database,
    environment: EntityId,
    text: &str,
    offset: u32,
) -> Option<NameInScene> {
    if let Some(written) = written_names(text).into_iter().find(|written| written.span.touches(offset)) {
        let declared = declaration(database, target(database, environment, &written)?)?;
        return Some(NameInScene { span: written.span, declared });
    }
    let of_robots = |part: &NamePart| part.name == "robots" && part.span.touches(offset);
    let span = name_parts(text).into_iter().find(of_robots)?.span;
    Some(NameInScene { span, declared: declaration(database, environment)? })
}

/// All places in the text of a scene that mean the same as the one at an offset.
pub fn highlights_in_scene(database: &Database, environment: EntityId, text: &str, offset: u32) -> Vec<Span> {
    let names = written_names(text);
    let Some(at) = names.iter().find(|written| written.span.touches(offset)) else { return Vec::new() };
    let intended = target(database, environment, at);
    let is_same = |other: &&Written| {
        (other.kind, &other.name) == (at.kind, &at.name) && target(database, environment, other) == intended
    };
    names.iter().filter(is_same).map(|written| written.span).collect()
}

/// Where scenes mention the name at a position of a program; of an environment, its scene.
pub fn mentions_in_scenes(database: &Database, position: FilePosition) -> Vec<ScenePlace> {
    referent_at(database, position).map_or_else(Vec::new, |referent| mentions(database, &referent))
}

/// Returns the changes in scenes when the name at a position of a program is renamed.
///
/// # Errors
///
/// If the new name is not valid, or a scene would then mean something else.
pub fn rename_in_scenes(
    database: &Database,
    position: FilePosition,
    new: &str,
) -> Result<SceneChanges, RenameError> {
    let Some(referent) = referent_at(database, position) else { return Ok(SceneChanges::default()) };
    let new = parse_name(new)?;
    let mut changes = SceneChanges::default();
    if new == referent.name {
        return Ok(changes);
    }
    for place in mentions(database, &referent) {
        if referent.kind == EntityKind::Environment {
            changes.renamed = Some((place, new.clone()));
            continue;
        }
        check_scene(database, &referent, &place, &new)?;
        changes.edits.push((place, as_key(&new)));
    }
    Ok(changes)
}

/// Refuses to rename where a scene has the new name already, or means the old one for another program, too.
fn check_scene(
    database: &Database,
    referent: &Referent,
    place: &ScenePlace,
    new: &SmolStr,
) -> Result<(), RenameError> {
    let is_own = |file: FileId| file == place.program;
    let folder = |file| database.path(file).rsplit_once('/').map_or("", |(folder, _)| folder);
    let scenes = database.scenes().filter(|(file, environment, _)| {
        *environment == place.environment && folder(*file) == folder(place.program)
    });
    for (file, environment, text) in scenes {
        let Some(id) = environment_called(database, file, environment) else { continue };
        let scene = format!("the scene of `{environment}`");
        let names = written_names(text);
        let renamed = names.iter().find(|written| written.span == place.span);
        for written in &names {
            let is_beside = written.kind == EntityKind::Robot
                || renamed.is_some_and(|renamed| renamed.robot == written.robot);
            if is_own(file) && (written.kind, &written.name) == (referent.kind, new) && is_beside {
                let reason = format!("{scene} already has {} `{new}`", referent.kind.a_noun());
                return Err(RenameError::Impossible(reason));
            }
            if written.span == place.span && !is_own(file) && !means(database, id, written, referent) {
                let other = database.path(file).rsplit('/').next().unwrap_or_default();
                let reason =
                    format!("{scene} is shared with {other}, whose `{}` would not be renamed", referent.name);
                return Err(RenameError::Impossible(reason));
            }
        }
    }
    Ok(())
}

fn mentions(database: &Database, referent: &Referent) -> Vec<ScenePlace> {
    let mut places = Vec::new();
    for (program, environment, text) in database.scenes() {
        let place = |span| ScenePlace { program, environment: environment.into(), span };
        if referent.kind == EntityKind::Environment {
            if program == referent.home && referent.name == *environment {
                places.push(place(Span::at(0)));
            }
            continue;
        }
        // Most scenes do not mention it and are not read.
        if !text.contains(referent.name.as_str()) {
            continue;
        }
        let Some(id) = environment_called(database, program, environment) else { continue };
        let mentions =
            written_names(text).into_iter().filter(|written| means(database, id, written, referent));
        places.extend(mentions.map(|written| place(written.span)));
    }
    places
}

/// Returns whether a name in the scene of an environment has the same declaration as a name of a program.
fn means(database: &Database, environment: EntityId, written: &Written, referent: &Referent) -> bool {
    let is_home = |id| database.file_of(id) == Some(referent.home);
    written.kind == referent.kind
        && written.name == referent.name
        && target(database, environment, written).is_some_and(is_home)
}

/// Returns the declaration of a name in the scene of an environment.
fn target(database: &Database, environment: EntityId, written: &Written) -> Option<EntityId> {
    let home = database.file_of(environment)?;
    let robot = database.resolve(home, EntityKind::Robot, &written.robot).entity()?;
    if written.kind == EntityKind::Robot {
        return Some(robot);
    }
    database.resolve(database.file_of(robot)?, written.kind, &written.name).entity()
}

/// The names of a program in the text of a scene.
pub(super) fn written_names(text: &str) -> Vec<Written> {
    let parts = name_parts(text).into_iter().filter_map(|part| {
        let path: Vec<&str> = part.name.split('.').collect();
        let (kind, robot, name) = match path[..] {
            ["robots", robot] => (EntityKind::Robot, robot, robot),
            ["robots", robot, "sensors", sensor] => (EntityKind::Sensor, robot, sensor),
            ["robots", robot, "wheels", wheel] => (EntityKind::Wheel, robot, wheel),
            _ => return None,
        };
        // A key in quotes can have dots, a name cannot.
        let is_one_part = !part.span.text(text).contains('.');
        is_one_part.then(|| Written { kind, name: name.into(), robot: robot.into(), span: part.span })
    });
    parts.collect()
}

fn environment_called(database: &Database, file: FileId, name: &str) -> Option<EntityId> {
    database.definitions(file, EntityKind::Environment, &name.into()).first().copied()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::fixture::{PARTS, at_cursor_in};
    use crate::{goto_definition, references};

    const YARD: &str = "environment yard has { rover } robots with { } moves";
    const SCENE: &str = "[robots]\nrover.start = [0, 1]\n[robots.rover.sensors.front]\nrange = 2\n\
                         [robots.\"rover\".wheels]\nwheelL = { object = '/a' }\n";

    /// A database of the given files, in which the environment `yard` of the last one has a scene.
    fn with_scene(files: &[(&str, &str)], scene: &str) -> (Database, FilePosition) {
        let (mut database, position) = at_cursor_in(files);
        let home = database.file(files[files.len() - 1].0).unwrap();
        database.set_scene(home, "yard", Some(scene));
        (database, position)
    }

    fn bracketed(text: &str, mut spans: Vec<Span>) -> String {
        spans.sort_unstable();
        let mut text = text.to_owned();
        for span in spans.into_iter().rev() {
            text.insert(span.end as usize, '>');
            text.insert(span.start as usize, '<');
        }
        text
    }

    fn check_mentions(program: &str, expected: &Expect) {
        let (database, position) = with_scene(&[("/w/a.pyr", program)], SCENE);
        let found = mentions_in_scenes(&database, position).into_iter().map(|place| place.span).collect();
        expected.assert_eq(&bracketed(SCENE, found));
    }

    #[test]
    fn scenes_mention_robots_sensors_and_wheels() {
        check_mentions(
            &format!("{}{YARD}", PARTS.replace("robot rover", "robot $0rover")),
            &expect![[r#"
                [robots]
                <rover>.start = [0, 1]
                [robots.<rover>.sensors.front]
                range = 2
                [robots.<"rover">.wheels]
                wheelL = { object = '/a' }
            "#]],
        );
        check_mentions(
            &format!("{}{YARD}", PARTS.replace("{ front", "{ $0front")),
            &expect![[r#"
                [robots]
                rover.start = [0, 1]
                [robots.rover.sensors.<front>]
                range = 2
                [robots."rover".wheels]
                wheelL = { object = '/a' }
            "#]],
        );
        check_mentions(
            &format!("{}{YARD}", PARTS.replace("wheel wheelL", "wheel $0wheelL")),
            &expect![[r#"
                [robots]
                rover.start = [0, 1]
                [robots.rover.sensors.front]
                range = 2
                [robots."rover".wheels]
                <wheelL> = { object = '/a' }
            "#]],
        );
        check_mentions(
            &format!("{PARTS}{}", YARD.replace("yard", "$0yard")),
            &expect![[r#"
                <>[robots]
                rover.start = [0, 1]
                [robots.rover.sensors.front]
                range = 2
                [robots."rover".wheels]
                wheelL = { object = '/a' }
            "#]],
        );
    }

    #[test]
    fn names_of_other_files_and_kinds_are_others() {
        let importing = format!("import \"parts.pyr\"\n{YARD}");
        let other = PARTS.replace("robot rover", "robot $0rover");
        let mention = |files: &[(&str, &str)]| {
            let (database, position) = with_scene(files, SCENE);
            mentions_in_scenes(&database, position).len()
        };
        assert_eq!(mention(&[("/w/parts.pyr", &other), ("/w/a.pyr", &importing)]), 3);
        assert_eq!(mention(&[("/w/else.pyr", &other), ("/w/a.pyr", &importing)]), 0);
        let movement = format!("{PARTS}movement $0rover of rover {{ slam }} {YARD}");
        assert_eq!(mention(&[("/w/a.pyr", &movement)]), 0);
    }

    /// Describes the declaration of the name at `$0` in a scene, and the number of its references.
    fn declared(scene: &str) -> String {
        let program = format!("{PARTS}$0{YARD}");
        let (database, position) = with_scene(&[("/w/a.pyr", &program)], "");
        let environment = environment_called(&database, position.file, "yard").unwrap();
        let offset = u32::try_from(scene.find("$0").unwrap()).unwrap();
        let text = scene.replace("$0", "");
        let Some(found) = name_in_scene(&database, environment, &text, offset) else {
            return "nothing".to_owned();
        };
        let target = goto_definition(&database, found.declared).unwrap().targets[0].full;
        let count = references(&database, found.declared, false).unwrap().len();
        let declaration = database.slice(position.file, target);
        format!("{}: {count} of {declaration}", found.span.text(&text))
    }

    #[test]
    fn names_in_scenes_refer_to_declarations() {
        for (scene, expected) in [
            (
                "[robots.rov$0er]",
                "rover: 1 of robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }",
            ),
            ("[robots.rover.sensors]\n$0front.range = 2", "front: 1 of sensor front"),
            // It need not be on the robot: that is a mistake of its own.
            (
                "robots = { rover = { sensors = { ba$0ck = { range = 2 } } } }",
                "back: 0 of sensor back : bumper",
            ),
            ("[robots.rover.wheels.$0wheelR]", "wheelR: 1 of wheel wheelR with radius 4.5"),
            ("[$0robots.rover]", "robots: 0 of environment yard has { rover } robots with { } moves"),
            ("[robots.sco$0ut]", "nothing"),
            ("[robots.rover]\nst$0art = 1", "nothing"),
            ("[[box]]\nname = \"ro$0ver\"", "nothing"),
        ] {
            assert_eq!(declared(scene), expected, "{scene}");
        }
    }

    #[test]
    fn highlights_are_of_one_scene() {
        let program = format!("{PARTS}$0{YARD}");
        let (database, position) = with_scene(&[("/w/a.pyr", &program)], SCENE);
        let environment = environment_called(&database, position.file, "yard").unwrap();
        let offset = u32::try_from(SCENE.find("rover").unwrap()).unwrap();
        let found = highlights_in_scene(&database, environment, SCENE, offset);
        assert_eq!(bracketed(SCENE, found).matches('<').count(), 3);
        assert!(highlights_in_scene(&database, environment, SCENE, 1).is_empty());
    }

    #[test]
    fn a_rename_reaches_scenes() {
        let program = format!("{}{YARD}", PARTS.replace("robot rover", "robot $0rover"));
        let (database, position) = with_scene(&[("/w/a.pyr", &program)], SCENE);
        let changes = rename_in_scenes(&database, position, "^robots").unwrap();
        assert_eq!(changes.edits.len(), 3);
        assert!(changes.edits.iter().all(|(_, text)| text == "robots"));
        assert_eq!(changes.renamed, None);
        assert_eq!(rename_in_scenes(&database, position, "rover"), Ok(SceneChanges::default()));

        let program = format!("{PARTS}{}", YARD.replace("yard", "$0yard"));
        let (database, position) = with_scene(&[("/w/a.pyr", &program)], SCENE);
        let changes = rename_in_scenes(&database, position, "hall").unwrap();
        let (place, name) = changes.renamed.unwrap();
        assert_eq!((place.environment.as_str(), name.as_str()), ("yard", "hall"));
        assert!(changes.edits.is_empty());
    }

    #[test]
    fn a_rename_that_would_change_what_a_scene_means_is_refused() {
        let program = format!("{}{YARD}", PARTS.replace("robot rover", "robot $0rover"));
        let scene = format!("{SCENE}[robots.scout]\n");
        let (database, position) = with_scene(&[("/w/a.pyr", &program)], &scene);
        let refusal = rename_in_scenes(&database, position, "scout").unwrap_err().to_string();
        assert_eq!(refusal, "the scene of `yard` already has a robot `scout`");

        let (mut database, position) = with_scene(&[("/w/a.pyr", &program)], SCENE);
        let other = database.open("/w/b.pyr", &format!("{PARTS}{YARD}"));
        database.set_scene(other, "yard", Some(SCENE));
        let refusal = rename_in_scenes(&database, position, "scout").unwrap_err().to_string();
        assert_eq!(refusal, "the scene of `yard` is shared with b.pyr, whose `rover` would not be renamed");
    }
}
