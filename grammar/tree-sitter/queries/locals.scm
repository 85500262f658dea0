; Not for highlighting: each kind of entity has its own namespace, which these queries cannot express.
(program) @local.scope

(wheel_definition name: (name) @local.definition.var)
(sensor_definition name: (name) @local.definition.field)
(ip_definition name: (name) @local.definition.constant)
(robot_definition name: (name) @local.definition.type)
(movement_definition name: (name) @local.definition.function)
(environment_definition name: (name) @local.definition.namespace)

(wheel_references (name) @local.reference)
(sensor_references (name) @local.reference)
(ip_clause ip: (name) @local.reference)
(movement_definition robot: (name) @local.reference)
(robot_references (name) @local.reference)
(movement_references (name) @local.reference)
(do movement: (name) @local.reference)
