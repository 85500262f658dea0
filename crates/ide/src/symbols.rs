//! Document symbols: the outline of a file, with the actions in their blocks.

use pydslrep_analysis::{EntityRef, Snapshot};
use pydslrep_syntax::ast::{Action, Entity, References};
use pydslrep_syntax::{EntityKind, Span};
use smol_str::{SmolStr, SmolStrBuilder};

use crate::cursor::body;

/// An item of the outline.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Symbol {
    /// Its name.
    pub name: SmolStr,
    /// A one-line summary.
    pub detail: SmolStr,
    /// Its kind.
    pub kind: SymbolKind,
    /// The range of the declaration or action.
    pub full: Span,
    /// The range of its name.
    pub focus: Span,
    /// Its nested symbols.
    pub children: Vec<Symbol>,
}

/// The kind of a symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SymbolKind {
    /// A declared entity.
    Entity(EntityKind),
    /// An action of a movement.
    Action,
    /// An obstacle of a scene.
    Obstacle,
    /// Any other table of a TOML file.
    Table,
}

/// The named entities of a file in text order, movements with their actions.
pub fn document_symbols(snapshot: &Snapshot) -> impl Iterator<Item = Symbol> {
    snapshot.entities().filter_map(|entity| symbol(snapshot, &entity))
}

fn symbol(snapshot: &Snapshot, entity: &EntityRef<'_>) -> Option<Symbol> {
    let tree = entity.parse.entity.as_ref()?;
    let name = tree.name()?;
    Some(Symbol {
        name: name.text.clone(),
        detail: detail(tree).into(),
        kind: SymbolKind::Entity(tree.kind()?),
        full: body(entity),
        focus: name.span.shifted(entity.span.start),
        children: children(snapshot, entity, tree),
    })
}

/// A one-line summary of an entity.
pub(crate) fn detail(tree: &Entity) -> String {
    match tree {
        Entity::Wheel(wheel) => {
            let kind = if wheel.mecanum { "mecanum, " } else { "" };
            let radius = wheel.radius.as_ref().and_then(|radius| radius.value);
            radius.map_or_else(String::new, |radius| format!("{kind}radius {radius} cm"))
        }
        Entity::Sensor(sensor) => match sensor.kind {
            Some((pydslrep_syntax::ast::SensorKeyword::Bumper, _)) => "bumper".to_owned(),
            _ => "distance".to_owned(),
        },
        Entity::Ip(ip) => ip.address.as_ref().map(|(address, _)| address.to_string()).unwrap_or_default(),
        Entity::Robot(robot) => {
            let drive = robot.drive.and_then(|clause| clause.word).map(|drive| format!("{}, ", drive.word()));
            let port = robot.port.as_ref().and_then(|port| port.value).map(|port| format!("port {port}"));
            format!("{}{}", drive.unwrap_or_default(), port.unwrap_or_default())
        }
        Entity::Movement(movement) => {
            let parallel = if movement.parallel.is_some() { "parallel, " } else { "" };
            let robot = movement.robot.as_ref().map_or("", |robot| robot.text.as_str());
            format!("{parallel}of {robot}, {}", counted(movement.all_actions().count(), "action"))
        }
        Entity::Environment(environment) => {
            let count = |list: &Option<References>| list.as_ref().map_or(0, |list| list.names.len());
            let robots = counted(count(&environment.robots), "robot");
            format!("{robots}, {}", counted(count(&environment.movements), "movement"))
        }
        Entity::Import(_) => String::new(),
    }
}

/// A count with a noun: `1 wheel`, `2 wheels`.
pub(crate) fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn children(snapshot: &Snapshot, entity: &EntityRef<'_>, tree: &Entity) -> Vec<Symbol> {
    let Entity::Movement(movement) = tree else { return Vec::new() };
    // One slice for all actions: slicing the file for each would dominate the cost.
    let text = snapshot.slice(entity.span);
    outline(entity, &text, &movement.actions)
}

/// Actions, with those in their blocks as children.
fn outline(entity: &EntityRef<'_>, text: &str, actions: &[Action]) -> Vec<Symbol> {
    let child = |action: &Action| {
        let full = action.span.shifted(entity.span.start);
        let end = action.blocks().next().map_or(action.span.end, |block| block.span.start);
        let mut words = Span::new(action.span.start, end).text(text).split_whitespace();
        let name = words.next().unwrap_or_default().into();
        let mut detail = SmolStrBuilder::new();
        for (index, word) in words.enumerate() {
            if index > 0 {
                detail.push(' ');
            }
            detail.push_str(word);
        }
        Symbol {
            name,
            detail: detail.finish(),
            kind: SymbolKind::Action,
            full,
            focus: keyword(entity, action).shifted(entity.span.start),
            children: action.blocks().flat_map(|block| outline(entity, text, &block.actions)).collect(),
        }
    };
    actions.iter().map(child).collect()
}

/// Where the keyword of an action is in its entity.
fn keyword(entity: &EntityRef<'_>, action: &Action) -> Span {
    let tokens = &entity.parse.tokens;
    let first = tokens.partition_point(|(_, span)| span.start < action.span.start);
    tokens.get(first).map_or(action.span, |(_, span)| *span)
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::*;
    use crate::fixture::PARTS;

    fn render(symbols: &[Symbol], depth: usize, out: &mut String) {
        for symbol in symbols {
            let kind = match symbol.kind {
                SymbolKind::Entity(kind) => kind.noun(),
                SymbolKind::Action => "action",
                SymbolKind::Obstacle | SymbolKind::Table => unreachable!("a program has none"),
            };
            let (full, focus) = (symbol.full, symbol.focus);
            *out += &format!(
                "{}{kind} {} ({}) {}..{} {}..{}\n",
                "  ".repeat(depth),
                symbol.name,
                symbol.detail,
                full.start,
                full.end,
                focus.start,
                focus.end
            );
            render(&symbol.children, depth + 1, out);
        }
    }

    #[test]
    fn the_outline_has_every_entity_and_action() {
        let mut database = pydslrep_analysis::Database::new();
        let text = format!(
            "{PARTS}ip here 127.0.0.1 // home\nwheel\nparallel movement m of rover {{ move 4  meters\n at 9 slam }}\nenvironment e has {{ rover }} robots"
        );
        let file = database.open("a.pyr", &text);
        let mut out = String::new();
        let snapshot = database.snapshot(file, None).unwrap();
        render(&document_symbols(&snapshot).collect::<Vec<_>>(), 0, &mut out);
        expect![[r#"
            wheel wheelL (radius 4.5 cm) 0..28 6..12
            wheel wheelR (radius 4.5 cm) 29..57 35..41
            sensor front (distance) 58..70 65..70
            sensor back (bumper) 71..91 78..82
            robot rover (tw, port 23000) 92..179 98..103
            ip here (127.0.0.1) 180..197 183..187
            movement m (parallel, of rover, 2 actions) 212..270 230..231
              action move (4 meters at 9) 243..263 243..247
              action slam () 264..268 264..268
            environment e (1 robot, 0 movements) 271..305 283..284
        "#]]
        .assert_eq(&out);
    }

    #[test]
    fn the_outline_nests_blocks() {
        let mut database = pydslrep_analysis::Database::new();
        let text = "movement m of r { repeat 2 times { if { a } clear { slam } else { do n wait 2 seconds } } turn left }";
        let file = database.open("a.pyr", text);
        let mut out = String::new();
        let snapshot = database.snapshot(file, None).unwrap();
        render(&document_symbols(&snapshot).collect::<Vec<_>>(), 0, &mut out);
        expect![[r#"
            movement m (of r, 6 actions) 0..101 9..10
              action repeat (2 times) 18..89 18..24
                action if ({ a } clear) 35..87 35..37
                  action slam () 52..56 52..56
                  action do (n) 66..70 66..68
                  action wait (2 seconds) 71..85 71..75
              action turn (left) 90..99 90..94
        "#]]
        .assert_eq(&out);
    }
}
