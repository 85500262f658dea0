(wheel_definition name: (name) @name) @definition.constant
(sensor_definition name: (name) @name) @definition.constant
(ip_definition name: (name) @name) @definition.constant
(robot_definition name: (name) @name) @definition.class
(movement_definition name: (name) @name) @definition.function
(environment_definition name: (name) @name) @definition.module

(movement_definition robot: (name) @name) @reference.class
(robot_references (name) @name @reference.class)
(movement_references (name) @name @reference.call)
(do movement: (name) @name) @reference.call
