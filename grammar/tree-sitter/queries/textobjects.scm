(movement_definition) @function.outer
(actions . "{" . (_) @function.inner . "}")
(actions . "{" . (_) @_first (_) @_last . "}"
  (#make-range! "function.inner" @_first @_last))

(robot_definition) @class.outer
(environment_definition) @class.outer

; The actions, which crates/syntax/tests/keywords.rs writes.
[(move) (turn) (slam)] @statement.outer
; End of the actions.

(wheel_references (name) @parameter.inner)
(sensor_references (name) @parameter.inner)
(robot_references (name) @parameter.inner)
(movement_references (name) @parameter.inner)

(number) @number.inner
(comment) @comment.outer
