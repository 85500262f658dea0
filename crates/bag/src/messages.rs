//! The messages of ROS 2 that bags contain, and the definitions by which other tools read them.
//!
//! Fields and their order are those of the packages `builtin_interfaces`, `std_msgs`, `geometry_msgs`, `nav_msgs` and
//! `sensor_msgs`; the encoding, CDR, has no names.

use byteorder::{BigEndian, LittleEndian};
use pydslrep_kinematics::Pose;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::BagError;

/// The separator between the definition of a message and those of its parts.
const RULE: &str = "================================================================================";

/// A type of messages.
pub(crate) struct MessageType {
    pub(crate) name: &'static str,
    fields: &'static str,
    parts: &'static [(&'static str, &'static str)],
}

impl MessageType {
    /// The definition with those of its parts, as bags have it.
    pub(crate) fn definition(&self) -> String {
        let part = |(name, fields): &(&str, &str)| format!("{RULE}\nMSG: {name}\n{fields}");
        self.parts.iter().fold(self.fields.to_owned(), |text, each| text + &part(each))
    }
}

const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");
const HEADER: (&str, &str) = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n");
const POINT: (&str, &str) = ("geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n");
const VECTOR: (&str, &str) = ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n");
const QUATERNION: (&str, &str) = ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
const POSE: (&str, &str) =
    ("geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n");
const POSE_STAMPED: (&str, &str) =
    ("geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n");
const POSE_WITH_COVARIANCE: (&str, &str) =
    ("geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n");
const TWIST: (&str, &str) =
    ("geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n");
const TWIST_WITH_COVARIANCE: (&str, &str) =
    ("geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n");

/// Where a robot is, and how fast.
pub(crate) const ODOMETRY: MessageType = MessageType {
    name: "nav_msgs/msg/Odometry",
    fields: "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n\
             geometry_msgs/TwistWithCovariance twist\n",
    parts: &[
        HEADER,
        TIME,
        POSE_WITH_COVARIANCE,
        POSE,
        POINT,
        QUATERNION,
        TWIST_WITH_COVARIANCE,
        TWIST,
        VECTOR,
    ],
};

/// A way.
pub(crate) const PATH: MessageType = MessageType {
    name: "nav_msgs/msg/Path",
    fields: "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n",
    parts: &[HEADER, TIME, POSE_STAMPED, POSE, POINT, QUATERNION],
};

/// The measurement of a distance sensor.
pub(crate) const RANGE: MessageType = MessageType {
    name: "sensor_msgs/msg/Range",
    fields: "uint8 ULTRASOUND=0\nuint8 INFRARED=1\nstd_msgs/Header header\nuint8 radiation_type\n\
             float32 field_of_view\nfloat32 min_range\nfloat32 max_range\nfloat32 range\nfloat32 variance\n",
    parts: &[HEADER, TIME],
};

/// Where a robot is, as localisation says it. Bags of this program have none.
pub(crate) const LOCALISED_POSE: &str = "geometry_msgs/msg/PoseWithCovarianceStamped";

/// A time; zero if it was not set.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Stamp {
    sec: i32,
    nanosec: u32,
}

impl Stamp {
    /// A time in nanoseconds.
    pub(crate) fn of(nanoseconds: u64) -> Self {
        let second = 1_000_000_000;
        let sec = i32::try_from(nanoseconds / second).unwrap_or(i32::MAX);
        Self { sec, nanosec: u32::try_from(nanoseconds % second).unwrap_or_default() }
    }

    /// Seconds; `None` if it was not set.
    pub(crate) fn seconds(self) -> Option<f64> {
        (self != Self::default()).then(|| f64::from(self.sec) + f64::from(self.nanosec) * 1e-9)
    }
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Header {
    pub(crate) stamp: Stamp,
    pub(crate) frame_id: String,
}

#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct Vector {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct PoseMessage {
    position: Vector,
    orientation: Quaternion,
}

impl From<Pose> for PoseMessage {
    fn from(pose: Pose) -> Self {
        let half = pose.theta / 2.0;
        Self {
            position: Vector { x: pose.x, y: pose.y, z: 0.0 },
            orientation: Quaternion { x: 0.0, y: 0.0, z: half.sin(), w: half.cos() },
        }
    }
}

impl PoseMessage {
    /// The pose on the floor; the heading is the rotation about the vertical.
    pub(crate) fn pose(&self) -> Pose {
        let Quaternion { x, y, z, w } = self.orientation;
        let theta = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
        Pose::new(self.position.x, self.position.y, theta)
    }
}

/// Covariances, none of which is known: zeros. Rows of a matrix, because serde has no arrays of 36.
type Covariance = [[f64; 6]; 6];

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PoseWithCovariance {
    pub(crate) pose: PoseMessage,
    covariance: Covariance,
}

impl From<Pose> for PoseWithCovariance {
    fn from(pose: Pose) -> Self {
        Self { pose: pose.into(), covariance: Covariance::default() }
    }
}

#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub(crate) struct Twist {
    pub(crate) linear: Vector,
    pub(crate) angular: Vector,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct TwistWithCovariance {
    pub(crate) twist: Twist,
    covariance: Covariance,
}

impl From<Twist> for TwistWithCovariance {
    fn from(twist: Twist) -> Self {
        Self { twist, covariance: Covariance::default() }
    }
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Odometry {
    pub(crate) header: Header,
    pub(crate) child_frame_id: String,
    pub(crate) pose: PoseWithCovariance,
    pub(crate) twist: TwistWithCovariance,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PoseStamped {
    pub(crate) header: Header,
    pub(crate) pose: PoseMessage,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct LocalisedPose {
    pub(crate) header: Header,
    pub(crate) pose: PoseWithCovariance,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct PathMessage {
    pub(crate) header: Header,
    pub(crate) poses: Vec<PoseStamped>,
}

/// As REP 117 says: infinity is free, minus infinity too near to be measured.
#[expect(clippy::struct_field_names, reason = "they are those of the message")]
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Range {
    pub(crate) header: Header,
    pub(crate) radiation_type: u8,
    pub(crate) field_of_view: f32,
    pub(crate) min_range: f32,
    pub(crate) max_range: f32,
    pub(crate) range: f32,
    pub(crate) variance: f32,
}

impl Range {
    /// Metres; `None` if it detects nothing, or has no reading.
    pub(crate) fn distance(&self) -> Option<f64> {
        let is_free = self.range.is_nan() || self.range > self.max_range || self.range == f32::INFINITY;
        (!is_free).then(|| f64::from(self.range.max(0.0)))
    }
}

/// The bytes before the content of a message: its representation, and two bytes for options.
const LITTLE_ENDIAN: [u8; 4] = [0, 1, 0, 0];
const BIG_ENDIAN: [u8; 4] = [0, 0, 0, 0];

/// A message as bytes.
pub(crate) fn encode(message: &impl Serialize) -> Result<Vec<u8>, BagError> {
    let content = cdr_encoding::to_vec::<_, LittleEndian>(message).map_err(|error| unreadable(&error))?;
    Ok([LITTLE_ENDIAN.as_slice(), &content].concat())
}

/// The message in bytes.
pub(crate) fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, BagError> {
    let (head, content) = bytes.split_at_checked(4).ok_or_else(|| unreadable(&"it is too short"))?;
    // The two bytes for options say nothing that is needed.
    let decoded = match [head[0], head[1], 0, 0] {
        LITTLE_ENDIAN => cdr_encoding::from_bytes::<T, LittleEndian>(content),
        BIG_ENDIAN => cdr_encoding::from_bytes::<T, BigEndian>(content),
        _ => return Err(unreadable(&"its encoding is not plain CDR")),
    };
    decoded.map(|(message, _)| message).map_err(|error| unreadable(&error))
}

fn unreadable(why: &dyn std::fmt::Display) -> BagError {
    BagError::Content(format!("a message of it is damaged ({why})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_survive_both_byte_orders() {
        let pose = Pose::new(1.5, -2.0, 3.0);
        let message = PoseStamped { header: Header::default(), pose: pose.into() };
        let little: PoseStamped = decode(&encode(&message).unwrap()).unwrap();
        let big = cdr_encoding::to_vec::<_, BigEndian>(&message).unwrap();
        let big: PoseStamped = decode(&[BIG_ENDIAN.as_slice(), &big].concat()).unwrap();
        for found in [little.pose.pose(), big.pose.pose()] {
            assert!(found.distance(&pose) < 1e-12 && (found.theta - pose.theta).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn what_is_no_message_is_an_error() {
        for bytes in [&b""[..], b"\0\x01", b"\0\x07\0\0abcdefgh", b"\0\x01\0\0short"] {
            assert!(decode::<Odometry>(bytes).is_err(), "{bytes:?}");
        }
    }

    #[test]
    fn ranges_follow_rep_117() {
        let read = |range| {
            let message = Range {
                header: Header::default(),
                radiation_type: 0,
                field_of_view: 0.1,
                min_range: 0.02,
                max_range: 4.0,
                range,
                variance: 0.0,
            };
            message.distance()
        };
        assert_eq!(read(0.5), Some(0.5));
        assert_eq!(read(f32::NEG_INFINITY), Some(0.0));
        assert_eq!([read(f32::INFINITY), read(f32::NAN), read(4.1)], [None; 3]);
    }
}
