(wheel_definition ["wheel" "wheelH"] @context name: (name) @name) @item
(sensor_definition "sensor" @context name: (name) @name) @item
(ip_definition "ip" @context name: (name) @name) @item
(robot_definition "robot" @context name: (name) @name) @item
(movement_definition "movement" @context name: (name) @name) @item
(environment_definition "environment" @context name: (name) @name) @item
