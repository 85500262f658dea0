//! Reading a call's arguments and writing its results.

use ciborium::Value;
use nalgebra::{Isometry3, Matrix3x4, Vector3};

/// The placeholder that clients send for a missing argument.
const NIL: &str = "_*NIL*_";

/// A failed call, with the message for the client.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Failure(pub(super) String);

/// The result of a call: its return values or its failure.
pub(super) type Outcome = Result<Vec<Value>, Failure>;

/// The arguments of one call.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arguments<'a> {
    function: &'a str,
    values: &'a [Value],
}

impl<'a> Arguments<'a> {
    pub(super) fn new(function: &'a str, values: &'a [Value]) -> Self {
        Self { function, values }
    }

    /// Returns whether this is a call of a function.
    pub(super) fn is(&self, function: &str) -> bool {
        self.function == function
    }

    /// A failure of this call, formatted as the engine does: error number, function, message.
    pub(super) fn failure(&self, number: u32, text: &str) -> Failure {
        // For this function, the engine names its C implementation.
        let function = if self.function == "sim.getObject" { "sim._getObject" } else { self.function };
        Failure(format!("{number}: in {function}: {text}"))
    }

    /// The argument at `index`, unless it is missing or nil.
    pub(super) fn get(&self, index: usize) -> Option<&'a Value> {
        self.values.get(index).filter(|value| !(value.is_null() || value.as_text() == Some(NIL)))
    }

    pub(super) fn integer(&self, index: usize) -> Result<i64, Failure> {
        self.get(index).and_then(integer).ok_or_else(|| self.unfit(index))
    }

    /// An optional integer.
    pub(super) fn integer_or(&self, index: usize, default: i64) -> Result<i64, Failure> {
        if self.get(index).is_none() { Ok(default) } else { self.integer(index) }
    }

    /// A finite number; clients may send it as an integer.
    pub(super) fn number(&self, index: usize) -> Result<f64, Failure> {
        self.get(index).and_then(number).filter(|value| value.is_finite()).ok_or_else(|| self.unfit(index))
    }

    pub(super) fn text(&self, index: usize) -> Result<&'a str, Failure> {
        self.get(index).and_then(Value::as_text).ok_or_else(|| self.unfit(index))
    }

    /// True for `true` and for non-zero numbers, as in the engine.
    pub(super) fn truth(&self, index: usize) -> Result<bool, Failure> {
        let value = self.get(index).ok_or_else(|| self.unfit(index))?;
        value.as_bool().or_else(|| Some(number(value)? != 0.0)).ok_or_else(|| self.wrong_type())
    }

    /// An entry of the options map at `index`, if present.
    pub(super) fn option(&self, index: usize, name: &str) -> Option<&'a Value> {
        let map = self.get(index)?.as_map()?;
        map.iter().find(|(key, _)| key.as_text() == Some(name)).map(|(_, value)| value)
    }

    /// The failure of the first argument that is missing or has the wrong type.
    fn unfit(&self, index: usize) -> Failure {
        if index < self.values.len() || self.is("sim.getObject") {
            return self.wrong_type();
        }
        self.failure(316, "the function requires more arguments.")
    }

    pub(super) fn wrong_type(&self) -> Failure {
        let number = if self.is("sim.getObject") { 1308 } else { 316 };
        self.failure(number, "one of the function's argument type is not correct.")
    }
}

/// An integer, possibly encoded as a float.
pub(super) fn integer(value: &Value) -> Option<i64> {
    match value {
        Value::Integer(whole) => i64::try_from(*whole).ok(),
        #[allow(clippy::cast_possible_truncation)] // only whole numbers that i32, and so i64, can hold
        Value::Float(float) if float.fract() == 0.0 && float.abs() <= f64::from(i32::MAX) => {
            Some(*float as i64)
        }
        _ => None,
    }
}

/// A finite number.
pub(super) fn finite_number(value: &Value) -> Option<f64> {
    number(value).filter(|value| value.is_finite())
}

fn number(value: &Value) -> Option<f64> {
    match value {
        Value::Float(float) => Some(*float),
        #[allow(clippy::cast_precision_loss)] // no rate, angle or flag needs more than 53 bits
        Value::Integer(whole) => Some(i128::from(*whole) as f64),
        _ => None,
    }
}

/// A list of numbers.
pub(super) fn list(numbers: impl IntoIterator<Item = f64>) -> Value {
    Value::Array(numbers.into_iter().map(Value::Float).collect())
}

pub(super) fn position(frame: &Isometry3<f64>) -> Value {
    list(frame.translation.vector.iter().copied())
}

/// Position and quaternion: x, y, z, qx, qy, qz, qw.
pub(super) fn pose(frame: &Isometry3<f64>) -> Value {
    let quaternion = frame.rotation.coords;
    list(frame.translation.vector.iter().chain(quaternion.iter()).copied())
}

/// x, y, z, w.
pub(super) fn quaternion(frame: &Isometry3<f64>) -> Value {
    list(frame.rotation.coords.iter().copied())
}

pub(super) fn euler_angles(frame: &Isometry3<f64>) -> Value {
    list(angles(frame))
}

/// Euler angles α, β, γ with rotation = Rx(α) Ry(β) Rz(γ), the engine's convention.
pub(super) fn angles(frame: &Isometry3<f64>) -> [f64; 3] {
    let m = frame.rotation.to_rotation_matrix();
    // asin(m02) would lose half the digits near ±90°.
    let beta = m[(0, 2)].atan2(m[(0, 0)].hypot(m[(0, 1)]));
    if m[(0, 2)].abs() > 1.0 - 1e-12 {
        // Gimbal lock: α and γ rotate about the same axis, so all of it goes to γ.
        return [0.0, beta, m[(1, 0)].atan2(m[(1, 1)])];
    }
    [(-m[(1, 2)]).atan2(m[(2, 2)]), beta, (-m[(0, 1)]).atan2(m[(0, 0)])]
}

/// The upper three rows of the homogeneous matrix, row by row.
pub(super) fn matrix(frame: &Isometry3<f64>) -> Value {
    let rows: Matrix3x4<f64> = frame.to_homogeneous().fixed_rows::<3>(0).into_owned();
    list(rows.transpose().iter().copied())
}

pub(super) fn vector(vector: Vector3<f64>) -> Value {
    list(vector.iter().copied())
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, UnitQuaternion};
    use proptest::prelude::*;

    use super::*;

    fn angles_of(rotation: Rotation3<f64>) -> [f64; 3] {
        let frame = Isometry3::from_parts(
            nalgebra::Translation3::identity(),
            UnitQuaternion::from_rotation_matrix(&rotation),
        );
        angles(&frame)
    }

    fn rotation(a: f64, b: f64, c: f64) -> Rotation3<f64> {
        Rotation3::from_axis_angle(&Vector3::x_axis(), a)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), b)
            * Rotation3::from_axis_angle(&Vector3::z_axis(), c)
    }

    proptest! {
        #[test]
        fn euler_angles_round_trip(a in -3.1..3.1, b in -1.5..1.5, c in -3.1..3.1) {
            let found = angles_of(rotation(a, b, c));
            let again = rotation(found[0], found[1], found[2]);
            let difference = (again.matrix() - rotation(a, b, c).matrix()).norm();
            prop_assert!(difference < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn euler_angles_at_the_pole() {
        let quarter = std::f64::consts::FRAC_PI_2;
        for (a, c) in [(0.0, 0.0), (0.3, 0.4), (-1.0, 2.0)] {
            let found = angles_of(rotation(a, quarter, c));
            let again = rotation(found[0], found[1], found[2]);
            assert!((again.matrix() - rotation(a, quarter, c).matrix()).norm() < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn arguments_of_every_kind() {
        let values =
            [Value::from(2), Value::from(2.5), Value::from("a"), Value::from(NIL), Value::Null, true.into()];
        let arguments = Arguments::new("sim.f", &values);
        assert_eq!((arguments.integer(0), arguments.number(0)), (Ok(2), Ok(2.0)));
        assert_eq!((arguments.number(1), arguments.text(2)), (Ok(2.5), Ok("a")));
        assert!(arguments.integer(1).is_err() && arguments.number(2).is_err() && arguments.text(0).is_err());
        assert_eq!(
            (arguments.integer_or(3, 7), arguments.integer_or(4, 7), arguments.integer_or(9, 7)),
            (Ok(7), Ok(7), Ok(7))
        );
        assert_eq!((arguments.truth(0), arguments.truth(5)), (Ok(true), Ok(true)));
        assert!(arguments.truth(2).is_err());
        let wrong = |reason: &str| Err(Failure(format!("316: in sim.f: {reason}")));
        assert_eq!(arguments.text(0), wrong("one of the function's argument type is not correct."));
        assert_eq!(arguments.text(9), wrong("the function requires more arguments."));
    }
}
