//! An environment with its scene as JSON, for `python/pydslrep_runtime/scene/description.py` reads.

use pydslrep_kinematics::Pose;
use pydslrep_scene::{Obstacle, Robot, Ros2Value, Scene, SensorKind, Shape, triangulate};
use serde_json::{Map, Value, json};

/// The description of a scene; metres and radians. `reach` has the least and the greatest coordinates that robots may get
/// to.
pub(crate) fn describe(environment: &str, scene: &Scene, reach: [Pose; 2]) -> Value {
    json!({
        "environment": environment,
        "reach": reach.map(|corner| [corner.x, corner.y]),
        "robots": scene.robots.iter().map(robot).collect::<Vec<_>>(),
        "obstacles": scene.obstacles.iter().map(obstacle).collect::<Vec<_>>(),
    })
}

/// A robot with its parts.
pub(crate) fn robot(robot: &Robot) -> Value {
    // A wheel and a sensor may have one name and two paths; both are found at either.
    let paths = |name: &str| robot.objects.get(name).map_or(&[][..], Vec::as_slice);
    let positions = robot.geometry.wheel_positions(robot.drive);
    let wheels: Vec<Value> = robot
        .wheels
        .iter()
        .zip(positions)
        .map(|(wheel, (x, y))| {
            json!({
                "name": wheel.name, "radius": wheel.radius, "x": x, "y": y, "mirrored": wheel.mirrored,
                "object": paths(&wheel.name).first(),
            })
        })
        .collect();
    let sensors: Vec<Value> = robot
        .sensors
        .iter()
        .map(|sensor| {
            let kind = match sensor.kind {
                SensorKind::Distance => "distance",
                SensorKind::Bumper => "bumper",
            };
            let mount = sensor.mount;
            json!({
                "name": sensor.name, "kind": kind,
                "x": mount.pose.x, "y": mount.pose.y, "bearing": mount.pose.theta,
                "range": mount.range, "cone": mount.cone,
                "object": paths(&sensor.name).last(),
            })
        })
        .collect();
    json!({
        "name": robot.name, "type": robot.drive.word(),
        "x": robot.start.x, "y": robot.start.y, "heading": robot.start.theta,
        "length": robot.body.length, "width": robot.body.width,
        "grip": robot.lateral_friction,
        // JSON has no infinity.
        "rim_speed": robot.motor_speed.is_finite().then_some(robot.motor_speed),
        "rim_acceleration": robot.motor_acceleration,
        "wheels": wheels, "sensors": sensors,
        "object": paths(&robot.name).first(),
    })
}

/// A robot with what it is called in ROS 2: what `ros2_world.py` and `ros2_doctor.py` read.
pub(crate) fn ros2_robot(robot: &Robot) -> Value {
    let mut described = self::robot(robot);
    let setting = |value: &Ros2Value| match value {
        Ros2Value::Text(text) => json!(text),
        Ros2Value::Number(number) => json!(number),
        Ros2Value::Flag(flag) => json!(flag),
    };
    let settings: Map<String, Value> =
        robot.ros2().iter().map(|(key, value)| (key.replace('-', "_"), setting(value))).collect();
    described["ros2"] = Value::Object(settings);
    described
}

fn obstacle(obstacle: &Obstacle) -> Value {
    let mut described = json!({
        "name": obstacle.name, "moves": obstacle.trajectory.is_some(),
        "x": obstacle.pose.x, "y": obstacle.pose.y, "heading": obstacle.pose.theta,
    });
    match &obstacle.shape {
        Shape::Box(body) => described["size"] = json!([body.length, body.width]),
        Shape::Cylinder { radius } => described["radius"] = json!(radius),
        Shape::Polygon(corners) => {
            described["corners"] = json!(corners);
            described["triangles"] = json!(triangulate(corners));
        }
    }
    described
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::Drive;
    use pydslrep_scene::{Trajectory, Waypoint, Wheel};

    use super::*;

    #[test]
    fn a_scene_is_described_completely() {
        let wheels = ["l", "r"].map(|name| Wheel::new(name, 0.045)).to_vec();
        let sensors = vec![("fEye".to_owned(), SensorKind::Bumper)];
        let mut scene = Scene::empty_floor(vec![Robot::new("r1", Drive::TwoWheel, wheels, sensors)]);
        let corners = vec![(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)];
        scene.obstacles.push(Obstacle::wall("wall", (0.0, 2.0), (4.0, 2.0), 0.1));
        scene.obstacles.push(Obstacle::fixed("corner", Pose::new(3.0, 0.0, 0.0), Shape::Polygon(corners)));
        let points = vec![Waypoint { time: 2.0, x: 1.0, y: 0.0 }, Waypoint { time: 3.0, x: 2.0, y: 0.0 }];
        let trajectory = Trajectory::new(points, false).unwrap();
        scene.obstacles.push(Obstacle::moving("person", 0.0, Shape::Cylinder { radius: 0.2 }, trajectory));
        let found = describe("area", &scene, [Pose::new(-1.0, 0.0, 0.0), Pose::new(2.0, 3.0, 0.0)]);
        assert_eq!(found["reach"], json!([[-1.0, 0.0], [2.0, 3.0]]));
        let robot = &found["robots"][0];
        assert_eq!((&robot["type"], &robot["rim_speed"]), (&json!("tw"), &Value::Null));
        let wheel =
            json!({ "name": "r", "radius": 0.045, "x": 0.0, "y": -0.15, "mirrored": false, "object": null });
        assert_eq!(robot["wheels"][1], wheel);
        assert_eq!(
            (&robot["sensors"][0]["kind"], &robot["sensors"][0]["range"]),
            (&json!("bumper"), &json!(0.05))
        );
        assert_eq!(found["obstacles"][0]["size"], json!([4.0, 0.1]));
        assert_eq!(found["obstacles"][0]["moves"], json!(false));
        let person = &found["obstacles"][2];
        assert_eq!((&person["moves"], &person["x"]), (&json!(true), &json!(1.0)));
        assert_eq!(found["obstacles"][1]["triangles"].as_array().map(Vec::len), Some(1));
    }
}
