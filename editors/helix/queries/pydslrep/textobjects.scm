(movement_definition (actions (_) @function.inside)) @function.around

[(robot_definition) (environment_definition)] @class.around

(wheel_references ((name) @parameter.inside . ","? @parameter.around) @parameter.around)
(sensor_references ((name) @parameter.inside . ","? @parameter.around) @parameter.around)
(robot_references ((name) @parameter.inside . ","? @parameter.around) @parameter.around)
(movement_references ((name) @parameter.inside . ","? @parameter.around) @parameter.around)

(comment) @comment.inside
(comment)+ @comment.around
