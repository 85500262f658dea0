[
  (actions)
  (block)
  (wheel_references)
  (sensor_references)
  (robot_references)
  (movement_references)
] @indent.begin

"}" @indent.branch @indent.end

(comment) @indent.auto
