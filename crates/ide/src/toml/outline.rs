//! Document symbols of a TOML file: its tables, obstacles by their names, and robots with their sensors and wheels.

use pydslrep_schema::{Item, NamePart, Span, Table, TableKind, name_parts};
use pydslrep_syntax::EntityKind;

use super::TomlFile;
use super::statements::statement;
use crate::{Symbol, SymbolKind};

/// The outline of a settings file or a scene, in the order of the text.
pub fn toml_symbols(file: TomlFile<'_>, text: &str) -> Vec<Symbol> {
    let mut outline: Vec<Node> = Vec::new();
    let parts = name_parts(text);
    for part in &parts {
        let path: Vec<&str> = part.name.split('.').collect();
        let Some(Item::Table(table)) = file.schema().find(&path) else { continue };
        // `robots` is the name of what its tables have in common.
        if table.parts().len() != path.len() {
            continue;
        }
        let full = statement(text, part.span);
        let robot = ["robots", path.get(1).unwrap_or(&"")].join(".");
        let parent = outline.iter().rposition(|node| node.name == robot).filter(|_| path.len() > 2);
        let siblings = match parent {
            Some(parent) => &mut outline[parent].children,
            None => &mut outline,
        };
        let known = siblings.iter_mut().find(|node| node.name == part.name && table.kind != TableKind::Each);
        if let Some(known) = known {
            known.symbol.full = known.symbol.full.to(full);
            continue;
        }
        let symbol = symbol(text, &parts, part, table, full);
        siblings.push(Node { name: part.name.clone(), symbol, children: Vec::new() });
    }
    outline.into_iter().map(Node::finish).collect()
}

/// A symbol that is not complete.
struct Node {
    /// The whole name of its table.
    name: String,
    symbol: Symbol,
    children: Vec<Node>,
}

impl Node {
    fn finish(self) -> Symbol {
        let children: Vec<Symbol> = self.children.into_iter().map(Self::finish).collect();
        let full = children.iter().fold(self.symbol.full, |full, child| full.to(child.full));
        Symbol { full, children, ..self.symbol }
    }
}

fn symbol(text: &str, parts: &[NamePart], part: &NamePart, table: &Table, full: Span) -> Symbol {
    let key = part.name.rsplit('.').next().unwrap_or_default();
    let (name, detail, kind) = match table.kind {
        TableKind::Each => match name_of_obstacle(text, parts, part) {
            Some(name) => (name, key, SymbolKind::Obstacle),
            None => (key, "", SymbolKind::Obstacle),
        },
        TableKind::Named { noun: "robot", .. } => (key, "robot", SymbolKind::Entity(EntityKind::Robot)),
        TableKind::Named { noun: "sensor", .. } => (key, "sensor", SymbolKind::Entity(EntityKind::Sensor)),
        TableKind::Named { noun, .. } => (key, noun, SymbolKind::Entity(EntityKind::Wheel)),
        TableKind::Once | TableKind::Catalogue { .. } => (key, "", SymbolKind::Table),
    };
    Symbol { name: name.into(), detail: detail.into(), kind, full, focus: part.span, children: Vec::new() }
}

/// Returns the value of an obstacle's key `name`.
fn name_of_obstacle<'t>(text: &'t str, parts: &[NamePart], header: &NamePart) -> Option<&'t str> {
    let key = format!("{}.name", header.name);
    let key = parts.iter().find(|part| part.section == header.section && part.name == key)?;
    let value = text[key.span.end as usize..].lines().next()?.trim_start().strip_prefix('=')?.trim_start();
    let quote = value.chars().next().filter(|quote| matches!(quote, '"' | '\''))?;
    value[1..].split(quote).next().filter(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use expect_test::expect;
    use pydslrep_analysis::Database;

    use super::*;

    fn outline(file: TomlFile<'_>, text: &str) -> String {
        fn write(symbols: &[Symbol], depth: usize, text: &str, out: &mut String) {
            for symbol in symbols {
                let Symbol { name, detail, kind, full, focus, .. } = symbol;
                assert!(full.start <= focus.start && focus.end <= full.end);
                let lines = full.text(text).lines().count();
                *out += &format!(
                    "{}{name} ({detail}) {kind:?}, {lines} lines, at {}\n",
                    "  ".repeat(depth),
                    focus.text(text)
                );
                write(&symbol.children, depth + 1, text, out);
            }
        }
        let mut out = String::new();
        write(&toml_symbols(file, text), 0, text, &mut out);
        out
    }

    #[test]
    fn a_scene_has_obstacles_and_robots() {
        let database = Database::new();
        let text = "[world]\nsize = [5, 5]\n\n[[box]]\nname = \"crate\" # big\nat = [1, 1]\n[[box]]\nat = [\n 2, 2]\n\
                    [robots]\nrover.start = [0, 0]\nscout = { start = [1, 1] }\n\
                    [robots.rover.sensors.front]\nrange = 2\n[robots.rover.wheels]\na = { object = '/a' }\n[wrold]";
        expect![[r#"
            world () Table, 2 lines, at world
            crate (box) Obstacle, 3 lines, at box
            box () Obstacle, 3 lines, at box
            rover (robot) Entity(Robot), 6 lines, at rover
              front (sensor) Entity(Sensor), 2 lines, at front
              a (wheel) Entity(Wheel), 1 lines, at a
            scout (robot) Entity(Robot), 1 lines, at scout
        "#]]
        .assert_eq(&outline(TomlFile::Scene(&database, None), text));
        assert_eq!(
            outline(TomlFile::Settings, "target = 'vrep'\n[severity]\n"),
            "severity () Table, 1 lines, at severity\n"
        );
        assert_eq!(outline(TomlFile::Scene(&database, None), "[[box"), "box () Obstacle, 1 lines, at box\n");
    }
}
