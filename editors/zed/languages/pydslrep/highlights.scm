; Generated from grammar/tree-sitter/queries/highlights.scm.

; The keywords, which crates/syntax/tests/keywords.rs writes. Where one is not allowed, the parser reads it as a name.
[
  "wheel" "wheelH" "with" "radius" "sensor" "ip" "robot" "type" "tw" "fw" "fwh" "port" "has" "wheels" "sensors"
  "parallel" "movement" "of" "move" "meters" "centimeters" "at" "turn" "left" "right" "until" "environment" "robots"
  "moves" "distance" "bumper" "import" "wait" "seconds" "repeat" "times" "if" "else" "do" "in" "reverse" "clear"
  "detect" "within"
] @keyword
(slam) @keyword
((ERROR (name) @keyword)
  (#any-of? @keyword
    "wheel" "wheelH" "with" "radius" "sensor" "ip" "robot" "type" "tw" "fw" "fwh" "port" "has" "wheels" "sensors"
    "parallel" "movement" "of" "move" "meters" "centimeters" "at" "turn" "left" "right" "until" "slam" "environment"
    "robots" "moves"))
; End of the keywords.

[(number) (address)] @number
(string) @string
(comment) @comment

(wheel_definition name: (name) @variable)
(wheel_references (name) @variable)

(sensor_definition name: (name) @property)
(sensor_references (name) @property)

(ip_definition name: (name) @constant)
(ip_clause ip: (name) @constant)

(robot_definition name: (name) @type)
(movement_definition robot: (name) @type)
(robot_references (name) @type)

(movement_definition name: (name) @function)
(movement_references (name) @function)
(do movement: (name) @function)

(environment_definition name: (name) @namespace)

["{" "}"] @punctuation.bracket
["," ":"] @punctuation.delimiter
