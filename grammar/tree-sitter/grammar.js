/**
 * @file Tree-sitter grammar of PyDSLRep.
 *
 * It follows ../pydslrep.ebnf but is more tolerant: after the first word of an entity, a clause or an action anything may be
 * missing, even the closing brace of a list. So an entity can begin wherever its keyword is, and incomplete code does not
 * affect its neighbours. The language server reports errors.
 *
 * @license MIT
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

module.exports = grammar({
  name: "pydslrep",

  // `distance`, `bumper` and `import` are keywords only where the grammar expects them, and names elsewhere.
  word: ($) => $.name,
  extras: ($) => [/[ \t\r\n\f]/, $.comment],

  rules: {
    program: ($) => seq(repeat($.import), repeat($._entity)),

    import: ($) => incomplete("import", field("path", $.string)),

    _entity: ($) =>
      choice(
        $.wheel_definition,
        $.sensor_definition,
        $.ip_definition,
        $.robot_definition,
        $.movement_definition,
        $.environment_definition,
      ),

    wheel_definition: ($) =>
      incomplete(choice("wheel", "wheelH"), field("name", $.name), "with", "radius", field("radius", $.number)),

    sensor_definition: ($) =>
      incomplete("sensor", field("name", $.name), incomplete(":", field("kind", choice("distance", "bumper")))),

    ip_definition: ($) => incomplete("ip", field("name", $.name), field("address", $.address)),

    robot_definition: ($) =>
      incomplete(
        "robot",
        // An older spelling has the type before the name.
        choice($.type_clause, seq($.type_clause, field("name", $.name)), seq(field("name", $.name), optional($.type_clause))),
        $.port_clause,
        $.wheels_clause,
        $.sensors_clause,
        "with",
      ),
    type_clause: (_) => incomplete("type", choice("tw", "fw", "fwh")),
    port_clause: ($) => incomplete(seq("with", "port"), field("port", $.number)),
    wheels_clause: ($) => incomplete("has", $.wheel_references, "wheels"),
    sensors_clause: ($) => incomplete(seq("with", "sensors"), $.sensor_references),

    movement_definition: ($) =>
      incomplete(
        choice("movement", incomplete("parallel", "movement")),
        field("name", $.name),
        incomplete("of", field("robot", $.name)),
        $.actions,
      ),
    actions: ($) => incomplete("{", repeat1($._action), "}"),
    _action: ($) => choice($.move, $.turn, $.slam),
    move: ($) =>
      incomplete(
        "move",
        field("distance", $.number),
        field("unit", choice("meters", "centimeters")),
        incomplete("at", field("speed", $.number)),
      ),
    turn: ($) =>
      incomplete(
        "turn",
        field("direction", choice("left", "right")),
        choice(field("angle", $.number), incomplete("until", $.sensor_references)),
      ),
    slam: (_) => "slam",

    environment_definition: ($) =>
      incomplete("environment", field("name", $.name), $.ip_clause, $.robots_clause, $.moves_clause, "with"),
    // An older spelling has a comma.
    ip_clause: ($) => incomplete(choice(seq("with", "ip"), ","), field("ip", $.name)),
    robots_clause: ($) => incomplete("has", $.robot_references, "robots"),
    moves_clause: ($) => incomplete(seq("with", $.movement_references), "moves"),

    wheel_references: ($) => references($),
    sensor_references: ($) => references($),
    robot_references: ($) => references($),
    movement_references: ($) => references($),

    name: (_) => /\^?[A-Za-z_][A-Za-z0-9_]*/,
    number: (_) => /-?[0-9]+(\.[0-9]+)?/,
    address: (_) => /[0-9]+\.[0-9]+\.[0-9]+\.[0-9]+/,
    // Invalid tokens end as in the language server: unterminated strings at the end of the line, unterminated comments at the
    // end of the file. Comments of other languages are accepted, too.
    string: (_) => /"[^"\r\n]*"?/,
    comment: (_) =>
      token(
        choice(
          /\/\/[^\r\n]*/,
          /\/\*([^*]|\*+[^*\/])*(\*+\/|\**)/,
          /(#|<!--|(--|%|\/|\\\\)[ \t])[^\r\n]*/,
        ),
      ),
  },
});

/**
 * The first part and the others in order, each of which may be missing.
 *
 * @param {RuleOrLiteral} first
 * @param {RuleOrLiteral[]} others
 * @returns {Rule}
 */
function incomplete(first, ...others) {
  return prec.right(seq(first, ...others.map(optional)));
}

/**
 * A list of names; the comma after each is optional.
 *
 * @param {GrammarSymbols<string>} $
 * @returns {Rule}
 */
function references($) {
  return incomplete("{", repeat1(seq($.name, optional(","))), "}");
}
