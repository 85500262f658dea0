//! Wheels, sensors, ips and robots.

use std::f64::consts::TAU;

use pydslrep_analysis::environment::Robot;
use pydslrep_analysis::{Database, EntityId, FileId};
use pydslrep_kinematics::scrub_factor;
use pydslrep_scene::defaults;
use pydslrep_syntax::EntityKind;
use pydslrep_syntax::ast::{Entity, SensorKeyword};

use super::format::{names, number};

pub(super) fn wheel(database: &Database, id: EntityId) -> Option<String> {
    let Entity::Wheel(wheel) = database.tree(id)? else { return None };
    let radius = wheel.radius.as_ref()?.value?;
    let kind = if wheel.mecanum { "Mecanum wheel" } else { "Wheel" };
    let (radius, circumference) = (number(radius, 3), number(radius * TAU, 1));
    Some(format!(
        "{kind}: radius {radius} cm, {circumference} cm per revolution. {}",
        used_by(database, id, EntityKind::Wheel)
    ))
}

pub(super) fn sensor(database: &Database, id: EntityId) -> Option<String> {
    let Entity::Sensor(sensor) = database.tree(id)? else { return None };
    let kind = match sensor.kind {
        Some((SensorKeyword::Bumper, _)) => "Bumper: detects an obstacle on contact.",
        _ => "Distance sensor: detects obstacles ahead.",
    };
    Some(format!("{kind} {}", used_by(database, id, EntityKind::Sensor)))
}

pub(super) fn ip(database: &Database, id: EntityId) -> Option<String> {
    let Entity::Ip(ip) = database.tree(id)? else { return None };
    let (address, _) = ip.address.as_ref()?;
    Some(format!("The machine at {address}. {}", used_by(database, id, EntityKind::Ip)))
}

pub(super) fn robot(database: &Database, id: EntityId) -> Option<String> {
    let robot = database.robot(id)?;
    let row = robot.drive.row();
    let mut text = format!("{} (`{}`), port {}.\n\n", row.label, row.word, robot.port);
    text += "| wheel | position | radius |\n|---|---|---|\n";
    for (wheel, place) in robot.wheels.iter().zip(row.wheels) {
        text +=
            &format!("| `{}` | {} | {} cm |\n", wheel.name, place.words(), number(wheel.radius * 100.0, 3));
    }
    if !robot.sensors.is_empty() {
        text += &format!("\nSensors: {}.\n", names(robot.sensors.iter().map(|sensor| sensor.name.as_str())));
    }
    text += &equations(&robot);
    text += &format!("\n{}", used_by(database, id, EntityKind::Robot));
    Some(text)
}

/// The inverse kinematics with this robot's radius. Other lengths come from the scene, so they stay symbols.
pub(super) fn equations(robot: &Robot) -> String {
    let radius = robot.wheels.first().map_or_else(String::new, |wheel| number(wheel.radius, 4));
    let row = robot.drive.row();
    let geometry = defaults::GEOMETRY;
    let (track, base) = (number(geometry.track, 3), number(geometry.wheelbase, 3));
    let lengths = if row.mecanum {
        let sum = number(f64::midpoint(geometry.track, geometry.wheelbase), 3);
        format!("K = {sum} m (half of track {track} m and wheelbase {base} m)")
    } else if row.scrubs() {
        let scrub = scrub_factor(robot.drive, geometry, row.lateral_friction);
        let wide = number(scrub * geometry.track, 3);
        format!("d = {wide} m (track {track} m × {} for tyre scrub in turns)", number(scrub, 2))
    } else {
        format!("d = {track} m")
    };
    format!(
        "\nWheel rates in rad/s:\n```text\n{}\n```\nr = {radius} m, {lengths} unless the scene overrides them.\n",
        row.equations.join("\n")
    )
}

/// The maximum number of users that are named; the others are counted.
const MAX_USERS: usize = 12;

/// The users of an entity, in its own file and in those that import it.
pub(super) fn used_by(database: &Database, id: EntityId, kind: EntityKind) -> String {
    let name = database.tree(id).and_then(Entity::name).map(|name| &name.text);
    let (Some(home), Some(name)) = (database.file_of(id), name) else { return String::new() };
    let resolves_here = |file: &FileId| {
        database.resolve(*file, kind, name).entity().and_then(|id| database.file_of(id)) == Some(home)
    };
    let files = std::iter::once(home).chain(database.importing(home).into_iter().filter(resolves_here));
    let users = files.flat_map(|file| database.users(file, kind, name));
    let mut users: Vec<&str> =
        users.filter_map(|user| database.tree(*user)?.name()).map(|name| name.text.as_str()).collect();
    users.sort_unstable();
    users.dedup();
    if users.is_empty() {
        return "Unused.".to_owned();
    }
    let more = users.len().saturating_sub(MAX_USERS);
    users.truncate(MAX_USERS);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("Used by {}{more}.", names(users))
}
