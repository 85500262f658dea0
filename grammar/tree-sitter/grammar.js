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

/** Words that begin or continue an action and are names wherever a name is wanted: in a list, and after `do`. */
const CONTEXTUAL = [
  "wait", "seconds", "repeat", "times", "if", "else", "do", "in", "reverse", "clear", "detect", "within",
];

module.exports = grammar({
  name: "pydslrep",

  // `distance`, `bumper`, `import` and the words above are keywords only where the grammar expects them, and names elsewhere.
  word: ($) => $.name,
  // After `do`, such a word is the movement's name, unless what follows shows that the name is missing: `do wait 2 seconds`.
  conflicts: ($) => [[$.do]],
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
    _action: ($) => choice($.move, $.turn, $.wait, $.repeat, $.if, $.do, $.slam),
    move: ($) => incomplete("move", field("distance", $.number), field("unit", $._unit), speed($), until($)),
    turn: ($) =>
      incomplete(
        "turn",
        field("direction", choice("left", "right")),
        field("angle", $.number),
        $.circle,
        speed($),
        incomplete("in", "reverse"),
        until($),
      ),
    circle: ($) => incomplete("with", "radius", field("radius", $.number), field("unit", $._unit)),
    wait: ($) => incomplete("wait", field("seconds", $.number), "seconds", until($)),
    // The first brace after `until` and `if` is that of a condition.
    repeat: ($) =>
      incomplete(
        "repeat",
        field("count", $.number),
        "times",
        choice(field("body", $.block), incomplete("until", guarded("body", $))),
      ),
    if: ($) => incomplete("if", guarded("then", $), incomplete("else", field("else", choice($.if, $.block)))),
    do: ($) => seq("do", optional(prec.dynamic(1, field("movement", name($))))),
    slam: (_) => "slam",
    block: ($) => incomplete("{", repeat1($._action), "}"),
    condition: ($) =>
      incomplete(
        $.sensor_references,
        field("word", choice("clear", "detect")),
        incomplete("within", field("distance", $.number), field("unit", $._unit)),
      ),
    _unit: (_) => choice("meters", "centimeters"),

    environment_definition: ($) =>
      incomplete("environment", field("name", $.name), $.ip_clause, $.robots_clause, $.moves_clause, "with"),
    // An older spelling has a comma.
    ip_clause: ($) => incomplete(choice(seq("with", "ip"), ","), field("ip", $.name)),
    robots_clause: ($) => incomplete("has", $.robot_references, "robots"),
    moves_clause: ($) => incomplete(seq("with", $.movement_references), "moves"),

    wheel_references: ($) => references($.name),
    // Inside a movement, only a brace ends the list before an action whose first word may be a name.
    sensor_references: ($) => references(name($)),
    robot_references: ($) => references($.name),
    movement_references: ($) => references($.name),

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
 * The speed of an action.
 *
 * @param {GrammarSymbols<string>} $
 * @returns {Rule}
 */
function speed($) {
  return incomplete("at", field("speed", $.number));
}

/**
 * What ends an action early.
 *
 * @param {GrammarSymbols<string>} $
 * @returns {Rule}
 */
function until($) {
  return incomplete("until", $.condition);
}

/**
 * A condition and the block that depends on it.
 *
 * @param {string} block The block's field.
 * @param {GrammarSymbols<string>} $
 * @returns {Rule}
 */
function guarded(block, $) {
  return incomplete($.condition, field(block, $.block));
}

/**
 * A name where an action may follow.
 *
 * @param {GrammarSymbols<string>} $
 * @returns {Rule}
 */
function name($) {
  return choice($.name, ...CONTEXTUAL.map((word) => alias(word, $.name)));
}

/**
 * A list of names; the comma after each is optional.
 *
 * @param {Rule} name
 * @returns {Rule}
 */
function references(name) {
  return incomplete("{", repeat1(seq(name, optional(","))), "}");
}
