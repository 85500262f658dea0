(movement_definition) @function.outer
(actions . "{" . (_) @function.inner . "}")
(actions . "{" . (_) @_first (_) @_last . "}"
  (#make-range! "function.inner" @_first @_last))

(robot_definition) @class.outer
(environment_definition) @class.outer

; The actions, which crates/syntax/tests/keywords.rs writes.
[(move) (turn) (slam) (wait) (repeat) (if) (do)] @statement.outer
; End of the actions.

(block) @block.outer
(block . "{" . (_) @block.inner . "}")
(block . "{" . (_) @_first (_) @_last . "}"
  (#make-range! "block.inner" @_first @_last))

(repeat) @loop.outer
(repeat (block . "{" . (_) @loop.inner . "}"))
(repeat (block . "{" . (_) @_first (_) @_last . "}"
  (#make-range! "loop.inner" @_first @_last)))

(if) @conditional.outer
(if (block . "{" . (_) @conditional.inner . "}"))
(if (block . "{" . (_) @_first (_) @_last . "}"
  (#make-range! "conditional.inner" @_first @_last)))

(do) @call.outer

(wheel_references (name) @parameter.inner)
(sensor_references (name) @parameter.inner)
(robot_references (name) @parameter.inner)
(movement_references (name) @parameter.inner)

(number) @number.inner
(comment) @comment.outer
