(movement_definition (actions (_)* @function.inside)) @function.around
[(robot_definition) (environment_definition)] @class.around
(comment)+ @comment.around
