[
  (actions)
  (block)
  (wheel_references)
  (sensor_references)
  (robot_references)
  (movement_references)
] @rainbow.scope

["{" "}"] @rainbow.bracket
