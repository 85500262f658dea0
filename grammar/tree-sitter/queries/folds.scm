[
  (robot_definition)
  (movement_definition)
  (environment_definition)
  (block)
  (import)+
  (comment)+
] @fold
