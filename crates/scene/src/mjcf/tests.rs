//! Worlds as they are written.

use expect_test::{Expect, expect};
use pydslrep_kinematics::{Drive, MotionPrimitive, RobotPlan, Run, plan};

use super::mjcf;
use crate::{Noise, Robot, Scene, SensorKind, Wheel, read};

fn robot(name: &str, drive: Drive, sensors: &[&str]) -> Robot {
    let wheels = drive.row().wheels.iter().map(|place| Wheel::new(place.identifier, 0.05)).collect();
    let sensors = sensors.iter().map(|&name| (name.to_owned(), SensorKind::Distance)).collect();
    Robot::new(name, drive, wheels, sensors)
}

/// The world of robots of which no path is planned.
fn world(scene: &Scene) -> String {
    mjcf(scene, &[])
}

#[track_caller]
fn check(robots: Vec<Robot>, scene: &str, expected: &Expect) -> String {
    let (scene, problems) = read(scene, Scene::empty_floor(robots));
    assert_eq!(problems, []);
    let text = world(&scene);
    expected.assert_eq(&text);
    text
}

#[test]
fn a_two_wheel_robot_stands_on_casters() {
    check(
        vec![robot("rover", Drive::TwoWheel, &["front"])],
        "[world]\nfriction = 0.3\n[robots.rover]\nstart = [1, 2, 90]\nrim-speed = 0.5\nmotor-gain = 100\nwheel-width = 0.03\n",
        &expect![[r#"
            <!-- A world for MuJoCo, written by PyDSLRep -->
            <mujoco model="pydslrep">
              <compiler angle="radian"/>
              <option timestep="0.002" integrator="implicitfast" cone="elliptic" impratio="10"/>
              <visual>
                <headlight ambient="0.5 0.5 0.5" diffuse="0.45 0.45 0.45" specular="0 0 0"/>
              </visual>
              <statistic center="1 2 0" extent="1.5"/>
              <size nuser_jnt="4" nuser_site="2"/>
              <custom>
                <numeric name="step" data="0.05"/>
                <numeric name="seed" data="1"/>
              </custom>
              <asset>
                <texture name="squares" type="2d" builtin="checker" width="256" height="256" rgb1="0.93 0.93 0.91" rgb2="0.88 0.88 0.86"/>
                <material name="squares" texture="squares" texuniform="true" texrepeat="0.5 0.5"/>
              </asset>
              <worldbody>
                <geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="0" friction="0.3 0.005 0.0001" material="squares"/>
                <body name="rover" pos="1 2 0" quat="0.707106781 0 0 0.707106781">
                  <freejoint/>
                  <geom type="box" size="0.15 0.15 0.05" pos="0 0 0.07" mass="4" contype="4" conaffinity="7" friction="0.3 0.005 0.0001" rgba="0.2 0.45 0.7 0.6"/>
                  <geom type="sphere" size="0.015" pos="0.12 0 0.015" mass="0.05" contype="0" conaffinity="3" priority="1" friction="0.0001 0.0001 0.0001" group="1" rgba="0.3 0.3 0.3 1"/>
                  <geom type="sphere" size="0.015" pos="-0.12 0 0.015" mass="0.05" contype="0" conaffinity="3" priority="1" friction="0.0001 0.0001 0.0001" group="1" rgba="0.3 0.3 0.3 1"/>
                  <site name="rover/front" pos="0.15 0 0.07" quat="1 0 0 0" user="1 0.34906585"/>
                  <body name="rover/left" pos="0 0.15 0.05">
                    <joint name="rover/left" axis="0 1 0" armature="0.00125" damping="0.00125" user="0.05 0 0.15 1"/>
                    <geom name="rover/left" type="cylinder" size="0.05 0.015" quat="0.707106781 0.707106781 0 0" mass="0.2" rgba="0.15 0.15 0.15 1" contype="0" conaffinity="3" condim="4" friction="0.0001 0.0001 0.0001" group="1"/>
                  </body>
                  <body name="rover/right" pos="0 -0.15 0.05">
                    <joint name="rover/right" axis="0 1 0" armature="0.00125" damping="0.00125" user="0.05 0 -0.15 1"/>
                    <geom name="rover/right" type="cylinder" size="0.05 0.015" quat="0.707106781 0.707106781 0 0" mass="0.2" rgba="0.15 0.15 0.15 1" contype="0" conaffinity="3" condim="4" friction="0.0001 0.0001 0.0001" group="1"/>
                  </body>
                </body>
              </worldbody>
              <actuator>
                <velocity name="rover/left" joint="rover/left" gear="1" kv="0.25" forcerange="-4.5 4.5" ctrlrange="-10 10"/>
                <velocity name="rover/right" joint="rover/right" gear="1" kv="0.25" forcerange="-4.5 4.5" ctrlrange="-10 10"/>
              </actuator>
            </mujoco>
        "#]],
    );
}

#[test]
fn wheels_that_scrub_touch_the_floor_in_their_own_way() {
    let robots = vec![robot("plain", Drive::FourWheel, &[]), robot("other", Drive::Mecanum, &[])];
    let (scene, _) = read("[world]\nfriction = 0.3\n", Scene::empty_floor(robots));
    let text = world(&scene);
    let pairs: Vec<&str> = text.lines().map(str::trim).filter(|line| line.starts_with("<pair ")).collect();
    expect![[r#"
        <pair condim="4" friction="0.3 0.3 0.005 0.0001 0.0001" solreffriction="0.1 1" solimp="0.1 0.9 0.0005"/>
        <pair geom1="floor" geom2="plain/left_front"/>
        <pair geom1="floor" geom2="plain/left_rear"/>
        <pair geom1="floor" geom2="plain/right_front"/>
        <pair geom1="floor" geom2="plain/right_rear"/>
    "#]]
    .assert_eq(&(pairs.join("\n") + "\n"));
}

#[test]
fn obstacles_stand_and_move() {
    check(
        Vec::new(),
        "[[wall]]\nfrom = [0, 1]\nto = [2, 1]\n[[cylinder]]\nname = \"a <post>\"\nradius = 0.2\nheight = 0.1\n\
         path = [[0, 2, 0], [30, 2, -1]]\nrepeat = true\n\
         [[polygon]]\ncorners = [[0, 0], [1, 0], [0, 1]]\n[[box]]\nname = \"a <post>\"\nat = [5, 5]\nsize = [1, 2]\n",
        &expect![[r#"
            <!-- A world for MuJoCo, written by PyDSLRep -->
            <mujoco model="pydslrep">
              <compiler angle="radian"/>
              <option timestep="0.002" integrator="implicitfast" cone="elliptic" impratio="10"/>
              <visual>
                <headlight ambient="0.5 0.5 0.5" diffuse="0.45 0.45 0.45" specular="0 0 0"/>
              </visual>
              <statistic center="2.75 2.4 0" extent="7.2"/>
              <size nuser_jnt="4" nuser_site="2"/>
              <custom>
                <numeric name="step" data="0.05"/>
                <numeric name="seed" data="1"/>
                <numeric name="path/obstacle/a &lt;post&gt;" data="0 2 0 30 2 -1"/>
                <numeric name="repeat/obstacle/a &lt;post&gt;" data="1"/>
              </custom>
              <asset>
                <texture name="squares" type="2d" builtin="checker" width="256" height="256" rgb1="0.93 0.93 0.91" rgb2="0.88 0.88 0.86"/>
                <material name="squares" texture="squares" texuniform="true" texrepeat="0.5 0.5"/>
                <mesh name="obstacle/polygon_1/1" inertia="shell" vertex="0 1 0 0 0 0 1 0 0 0 1 0.5 0 0 0.5 1 0 0.5"/>
              </asset>
              <worldbody>
                <geom name="floor" type="plane" size="0 0 1" contype="1" conaffinity="0" friction="0.8 0.005 0.0001" material="squares"/>
                <body name="obstacle/wall_1" pos="1 1 0" quat="1 0 0 0">
                  <geom type="box" contype="2" conaffinity="0" friction="0.3 0.005 0.0001" rgba="0.62 0.62 0.65 1" pos="0 0 0.25" size="1 0.05 0.25"/>
                </body>
                <body name="obstacle/a &lt;post&gt;" pos="2 0 0" quat="1 0 0 0" mocap="true">
                  <geom type="cylinder" contype="2" conaffinity="0" friction="0.3 0.005 0.0001" rgba="0.85 0.55 0.3 1" pos="0 0 0.05" size="0.2 0.05"/>
                </body>
                <body name="obstacle/polygon_1" pos="0 0 0" quat="1 0 0 0">
                  <geom type="mesh" contype="2" conaffinity="0" friction="0.3 0.005 0.0001" rgba="0.62 0.62 0.65 1" mesh="obstacle/polygon_1/1"/>
                </body>
                <body name="obstacle/a &lt;post&gt;'" pos="5 5 0" quat="1 0 0 0">
                  <geom type="box" contype="2" conaffinity="0" friction="0.3 0.005 0.0001" rgba="0.62 0.62 0.65 1" pos="0 0 0.25" size="0.5 1 0.25"/>
                </body>
              </worldbody>
            </mujoco>
        "#]],
    );
}

#[test]
fn robots_pass_through_what_does_not_stop_them() {
    let robots = vec![robot("a", Drive::FourWheel, &[])];
    let (scene, _) = read(
        "[world]\ncollisions = false\n[[box]]\nat = [0, 0]\nsize = [1, 1]\n",
        Scene::empty_floor(robots),
    );
    let text = world(&scene);
    let solid: Vec<&str> = text.lines().filter(|line| line.contains("contype=\"")).collect();
    assert!(solid.len() > 5);
    for line in solid {
        assert!(line.contains("contype=\"0\"") || line.contains("name=\"floor\""), "{line}");
    }
}

/// The numbers of an attribute, of each line that has it.
fn attributes(text: &str, element: &str, key: &str) -> Vec<Vec<f64>> {
    let start = format!("<{element} ");
    let lines = text.lines().filter(|line| line.trim_start().starts_with(&start));
    let values = lines.filter_map(|line| line.split_once(&format!(" {key}=\""))?.1.split('"').next());
    values.map(|value| value.split(' ').map(|word| word.parse().unwrap()).collect()).collect()
}

#[test]
fn rollers_touch_the_floor_along_the_way_that_a_wheel_pushes() {
    let text = world(&Scene::empty_floor(vec![robot("m", Drive::Mecanum, &[])]));
    let axes = attributes(&text, "joint", "axis");
    // A wheel's own joint, then those of its rollers; the first one is at the bottom.
    let lowest: Vec<f64> = axes.chunks(10).map(|wheel| wheel[1][1] / wheel[1][0]).collect();
    let pushes: Vec<f64> = Drive::Mecanum.row().wheels.iter().map(|wheel| wheel.push).collect();
    assert_eq!(lowest, pushes);
}

#[test]
fn mecanum_wheels_are_round() {
    let text = world(&Scene::empty_floor(vec![robot("m", Drive::Mecanum, &[])]));
    let ellipsoids = attributes(&text, "geom", "size");
    let ellipsoid =
        ellipsoids.iter().find(|size| size.len() == 3 && size[0] > 0.0 && size[2] > size[0]).unwrap();
    let (thickness, half, centre) = (ellipsoid[0], ellipsoid[2], 0.05 - ellipsoid[0]);
    for degrees in 0..=20 {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        // The support of the ellipsoid in a direction of the wheel's plane, to which its axis is at 45°.
        let along = sin / std::f64::consts::SQRT_2;
        let reach =
            (thickness.powi(2) * (1.0 - along.powi(2)) + half.powi(2) * along.powi(2)).sqrt() + centre * cos;
        assert!((reach / 0.05 - 1.0).abs() < 0.005, "{reach} at {degrees}°");
    }
}

#[test]
fn wheels_are_not_what_scripts_believe_them_to_be() {
    let noise = Noise { track_error: 0.1, radius_error: -0.2, ..Noise::default() };
    let scene =
        Scene { noise: Some(noise), seed: 7, ..Scene::empty_floor(vec![robot("r", Drive::TwoWheel, &[])]) };
    let text = world(&scene);
    assert_eq!(attributes(&text, "joint", "user")[0], [0.05, 0.0, 0.15, 1.0]);
    let places = attributes(&text, "body", "pos");
    assert_eq!(places[1], [0.0, 0.165, 0.04]);
    assert_eq!(attributes(&text, "numeric", "data"), [vec![0.05], vec![7.0], vec![0.02, 0.01]]);
}

#[test]
fn what_will_be_driven_is_in_view() {
    let (scene, _) = read(
        "[robots.rover]\nstart = [1, 2, 90]\n[[cylinder]]\nradius = 0.2\npath = [[0, 2, 0], [30, 2, -1]]\n",
        Scene::empty_floor(vec![robot("rover", Drive::TwoWheel, &[])]),
    );
    let actions = vec![MotionPrimitive::Move { distance: 4.0, speed: 0.1 }];
    let rover = RobotPlan { model: scene.robots[0].model().unwrap(), start: scene.robots[0].start };
    let plan = plan(&[rover], &[vec![Run { robot: 0, actions }]]).unwrap();
    let text = mjcf(&scene, &plan.robots);
    let reach = scene.robots[0].body.reach();
    let (left, right, low, high) = (1.0 - reach, 2.2, -1.2, 6.0 + reach);
    let [center, extent] = ["center", "extent"].map(|key| attributes(&text, "statistic", key).concat());
    assert!((center[0] - f64::midpoint(left, right)).abs() < 1e-6, "{center:?}");
    assert!((center[1] - f64::midpoint(low, high)).abs() < 1e-6, "{center:?}");
    assert!((extent[0] - (high - low)).abs() < 1e-6, "{extent:?}");
}
