[
  (robot_definition)
  (movement_definition)
  (environment_definition)
  (import)+
  (comment)+
] @fold
