//! The context of a rule: the entity it checks, and what it may read of others.

use std::cell::{OnceCell, RefCell};

use pydslrep_kinematics::Drive;
use pydslrep_syntax::ast::{Action, Entity, Name, Robot, Wheel};
use pydslrep_syntax::{EntityKind, Parse, Span, SyntaxError, Token};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::rewritten::Rewrite;
use crate::defaults::drive;
use crate::facts::script_name::ScriptName;
use crate::reads::Reads;
use crate::signature::{MovementSignature, Signature};
use crate::summary::Summary;
use crate::{Absence, Edition, EntityId, Facts, FileId, Resolution, Target};

/// The entity that is checked, and all that a rule may look at beside it.
///
/// An entity is checked again when something changes that its rules looked at. So rules do not see the facts, which are
/// private to this file, and every accessor belongs to one of three kinds:
///
/// 1. It looks at the entity alone, or at a fact of its file that invalidates the whole file when it changes.
/// 2. It takes a name, and notes it unless the entity itself declares or uses it: those the index of names knows.
/// 3. It takes another entity and notes it, or looks through all names of a kind and notes the kind.
pub(super) struct Context<'a> {
    facts: &'a Facts,
    file: FileId,
    pub(super) id: EntityId,
    pub(super) parse: &'a Parse,
    /// `None` for the text before the first entity.
    pub(super) tree: Option<&'a Entity>,
    pub(super) errors: &'a [SyntaxError],
    pub(super) tokens: &'a [Token],
    /// Its text, once a rule has asked for a part of it.
    text: OnceCell<String>,
    /// The actions of a movement, those in blocks too: many rules look at all of them.
    actions: Vec<&'a Action>,
    /// The names that it uses, in the order of the text.
    pub(super) references: Vec<(EntityKind, &'a Name)>,
    /// The statements that are one problem each, whatever their syntax errors are.
    pub(super) rewrites: Vec<Rewrite>,
    reads: RefCell<Reads>,
}

fn all_actions(entity: &Entity) -> Vec<&Action> {
    match entity {
        Entity::Movement(movement) => movement.all_actions().collect(),
        _ => Vec::new(),
    }
}

// The entity itself.
impl<'a> Context<'a> {
    pub(super) fn new(facts: &'a Facts, id: EntityId) -> Option<Self> {
        let parse = facts.parse(id)?;
        Some(Self {
            facts,
            file: facts.file_of(id)?,
            id,
            parse,
            tree: parse.entity.as_ref(),
            errors: &parse.errors,
            tokens: &parse.tokens,
            text: OnceCell::new(),
            actions: parse.entity.as_ref().map(all_actions).unwrap_or_default(),
            references: parse.entity.as_ref().map(Entity::references).unwrap_or_default(),
            rewrites: Vec::new(),
            reads: RefCell::default(),
        })
    }

    /// The actions of a movement, those in blocks too, in the order of the text; none of what is not a movement.
    pub(super) fn actions(&self) -> impl Iterator<Item = &'a Action> {
        self.actions.iter().copied()
    }

    /// Returns the names and entities that were read beside the entity.
    pub(super) fn into_reads(self) -> Reads {
        self.reads.into_inner().settled()
    }

    /// Returns whether a span is in a statement that is reported as a whole.
    pub(super) fn is_rewritten(&self, span: Span) -> bool {
        self.rewrites.iter().any(|rewrite| rewrite.covers(span))
    }

    /// The text of a range of this entity.
    pub(super) fn text(&self, span: Span) -> &str {
        let all = self.text.get_or_init(|| {
            let entity = self.facts.entity(self.id);
            entity.map_or_else(String::new, |entity| self.facts.slice(self.file, entity.span))
        });
        let end = (span.end as usize).min(all.len());
        all.get((span.start as usize).min(end)..end).unwrap_or_default()
    }

    /// The text of a number for a message: not all of hundreds of digits.
    pub(super) fn short_text(&self, span: Span) -> String {
        const MAX_CHARACTERS: usize = 20;
        let text = self.text(span);
        let mut short: String = text.chars().take(MAX_CHARACTERS).collect();
        if short.len() < text.len() {
            short.push('…');
        }
        short
    }

    /// Returns the length of its text, in bytes.
    pub(super) fn len(&self) -> Option<u32> {
        self.facts.entity(self.id).map(|entity| entity.span.len())
    }

    /// The kind and name that it declares.
    pub(super) fn declared(&self) -> Option<(EntityKind, &'a Name)> {
        self.tree?.kind().zip(self.tree?.name())
    }
}

// Its file.
impl Context<'_> {
    /// Returns the target of the file's scripts.
    pub(super) fn target(&self) -> Target {
        self.facts.target(self.file)
    }

    /// Which statements the file may have.
    pub(super) fn edition(&self) -> Edition {
        self.facts.edition(self.file)
    }

    /// Returns whether the file has environments.
    pub(super) fn has_environments(&self) -> bool {
        self.facts.count(self.file, EntityKind::Environment) > 0
    }

    /// Returns whether another file imports this one.
    pub(super) fn is_imported(&self) -> bool {
        self.facts.is_imported(self.file)
    }

    /// Why the file that this import names is not there.
    pub(super) fn absence(&self) -> Option<&Absence> {
        self.facts.absence(self.file, &self.facts.import_path(self.id)?)
    }

    /// Where an import belongs that comes after other entities: before this one.
    pub(super) fn place_of_late_import(&self) -> Option<EntityId> {
        if !self.facts.is_late_import(self.id) {
            return None;
        }
        let mut entities = self.facts.entities(self.file);
        entities.find(|entity| entity.parse.entity.is_some()).map(|entity| entity.id)
    }
}

// Names.
impl<'a> Context<'a> {
    /// Resolves a name in this file.
    pub(super) fn resolve(&self, kind: EntityKind, name: &Name) -> Resolution {
        self.note_name(self.file, kind, name);
        self.facts.resolve(self.file, kind, &name.text)
    }

    /// Resolves a name of another entity in the file of that entity.
    fn resolve_in(&self, id: EntityId, kind: EntityKind, name: &Name) -> Option<EntityId> {
        let file = self.facts.file_of(id)?;
        self.note_name(file, kind, name);
        self.facts.resolve(file, kind, &name.text).entity()
    }

    /// The entities of this file that declare a name, in the order of the text.
    pub(super) fn declarations(&self, kind: EntityKind, name: &Name) -> &'a [EntityId] {
        self.note_name(self.file, kind, name);
        self.facts.definitions(self.file, kind, &name.text)
    }

    /// The first declaration of a name in each file that this one imports.
    pub(super) fn imported_declarations(&self, kind: EntityKind, name: &Name) -> Vec<EntityId> {
        self.note_name(self.file, kind, name);
        // A file may be imported twice.
        let mut seen = FxHashSet::default();
        let files = self.facts.imported_files(self.file).filter(|file| seen.insert(*file));
        files.filter_map(|file| self.facts.definitions(file, kind, &name.text).first().copied()).collect()
    }

    /// The entities of this file that use a name that this one declares. When they change, those that declare it are
    /// checked again.
    pub(super) fn users_of_own(&self) -> &'a [EntityId] {
        let Some((kind, name)) = self.declared() else { return &[] };
        self.facts.users(self.file, kind, &name.text)
    }

    /// Returns whether this entity uses a name that others use, too. When the answer changes, those that use it are
    /// checked again.
    pub(super) fn shares_use(&self, kind: EntityKind, name: &Name) -> bool {
        debug_assert!(self.is_own(kind, name), "of a name that the entity does not use nobody tells it");
        self.facts.users(self.file, kind, &name.text).iter().any(|user| *user != self.id)
    }

    /// Returns whether a name is in text of this file that had to be skipped, where it may be a use or a declaration.
    pub(super) fn is_skipped(&self, kind: EntityKind, name: &Name) -> bool {
        self.note_name(self.file, kind, name);
        self.facts.is_skipped(self.file, &name.text)
    }

    /// Returns whether this file sees a declaration of a name, which need not be in any text.
    pub(super) fn is_declared(&self, kind: EntityKind, name: &str) -> bool {
        let name = SmolStr::new(name);
        self.reads.borrow_mut().add_name((self.file, kind, name.clone()));
        self.facts.is_in_sight(self.file, kind, &name)
    }

    /// Every name of a kind that this file sees, in no order, some perhaps more than once.
    pub(super) fn names_in_sight(&self, kind: EntityKind) -> impl Iterator<Item = &'a SmolStr> {
        self.reads.borrow_mut().add_kind(kind);
        self.facts.names_in_sight(self.file, kind)
    }

    /// Returns whether another environment of the file has this one's name except for case. Environments whose names
    /// are so alike invalidate each other.
    pub(super) fn has_twin(&self, environment: &Name) -> bool {
        self.note_name(self.file, EntityKind::Environment, environment);
        self.facts.environments_but_for_case(self.file, &environment.text).len() > 1
    }

    /// Returns the name of an environment's script, and the other environment that is why.
    pub(super) fn script_name(&self, environment: &Name) -> Option<(ScriptName, Option<EntityId>)> {
        self.reads.borrow_mut().add_kind(EntityKind::Environment);
        self.facts.script_name(self.file, &environment.text)
    }

    fn note_name(&self, file: FileId, kind: EntityKind, name: &Name) {
        if file != self.file || !self.is_own(kind, name) {
            self.reads.borrow_mut().add_name((file, kind, name.text.clone()));
        }
    }

    /// Returns whether the entity declares or uses a name.
    fn is_own(&self, kind: EntityKind, name: &Name) -> bool {
        let is_it = |(own_kind, own): (EntityKind, &Name)| own_kind == kind && own.text == name.text;
        let found = self.references.binary_search_by_key(&name.span.start, |(_, own)| own.span.start);
        self.declared().is_some_and(is_it) || found.is_ok_and(|index| is_it(self.references[index]))
    }
}

// Other entities.
impl<'a> Context<'a> {
    /// Returns the signature of an entity.
    pub(super) fn signature(&self, id: EntityId) -> Option<Signature<'a>> {
        if id != self.id {
            self.reads.borrow_mut().add_entity(id);
        }
        self.facts.parse(id).map(Signature::of)
    }

    /// Returns the summary of a movement.
    pub(super) fn summary(&self, id: EntityId) -> Option<Summary> {
        if id != self.id {
            self.reads.borrow_mut().add_summary(id);
        }
        Summary::of(self.facts.parse(id)?.entity.as_ref()?)
    }

    /// The movement that another one calls by a name.
    pub(super) fn movement_of(&self, id: EntityId, name: &SmolStr) -> Option<EntityId> {
        let file = self.facts.file_of(id)?;
        self.reads.borrow_mut().add_name((file, EntityKind::Movement, name.clone()));
        self.facts.resolve(file, EntityKind::Movement, name).entity()
    }

    /// The name that an entity declares.
    pub(super) fn name_of(&self, id: EntityId) -> Option<&'a Name> {
        self.signature(id)?.name()
    }

    /// Returns whether an entity was read without a syntax error, so that something may be concluded from what it
    /// lacks.
    pub(super) fn is_sound(&self, id: EntityId) -> bool {
        self.signature(id).is_some_and(Signature::is_sound)
    }

    /// Returns whether one robot is declared before another: in the same file, or by the names of their files.
    pub(super) fn is_before(&self, one: EntityId, other: EntityId) -> bool {
        let place = |id: EntityId| {
            self.reads.borrow_mut().add_entity(id);
            (self.facts.file_of(id).map(|file| self.facts.path(file)), self.facts.order(id))
        };
        place(one) < place(other)
    }

    /// The wheel that a name means in this file.
    pub(super) fn wheel(&self, name: &Name) -> Option<(EntityId, &'a Wheel)> {
        let id = self.resolve(EntityKind::Wheel, name).entity()?;
        Some((id, self.signature(id)?.wheel()?))
    }

    /// The robot that a name means in this file.
    pub(super) fn robot(&self, name: &Name) -> Option<(EntityId, &'a Robot)> {
        let id = self.resolve(EntityKind::Robot, name).entity()?;
        Some((id, self.signature(id)?.robot()?))
    }

    /// The movement that a name means in this file.
    pub(super) fn movement(&self, name: &Name) -> Option<(EntityId, MovementSignature<'a>)> {
        let id = self.resolve(EntityKind::Movement, name).entity()?;
        Some((id, self.signature(id)?.movement()?))
    }

    /// The robot of a movement that may be in another file.
    pub(super) fn robot_of(&self, id: EntityId, movement: MovementSignature<'_>) -> Option<EntityId> {
        self.resolve_in(id, EntityKind::Robot, movement.robot?)
    }

    /// The sensor that a robot calls by a name.
    pub(super) fn sensor_of(&self, robot: EntityId, name: &Name) -> Option<Signature<'a>> {
        self.signature(self.resolve_in(robot, EntityKind::Sensor, name)?)
    }

    /// The wheel layout of a robot.
    pub(super) fn drive(&self, id: EntityId) -> Option<Drive> {
        drive(self.signature(id)?.robot()?, |name| {
            let wheel = self.resolve_in(id, EntityKind::Wheel, name).and_then(|id| self.signature(id));
            wheel.and_then(Signature::wheel)
        })
    }
}
