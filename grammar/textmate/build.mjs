// Generates pydslrep.tmLanguage.json: `node build.mjs`; `--check` only reports whether it is up to date.
//
// A TextMate grammar sees one line at a time and cannot look back, so context is kept by nesting: the rule of an entity
// extends from its keyword to the next entity and contains a rule for each clause where names have another kind. Every rule
// ends where the next entity begins, so an unclosed clause does not affect what follows.
//
// No rule requires a word boundary on its left, because the language does not (`4meters`): each word, number and comment is
// consumed as a whole.
import { readFileSync, writeFileSync } from "node:fs";

const read = (name) => readFileSync(new URL(name, import.meta.url), "utf8");
const colours = JSON.parse(read("../colours.json"));
const scope = (kind, detail) => [colours[kind].scope, detail, "pydslrep"].filter(Boolean).join(".");

// The keywords are those of the published grammar, which a test compares with the lexer. Its comment on tokens names the
// contextual ones, which are names wherever a name can be.
const [rules, tokens] = read("../pydslrep.ebnf").split("(* Tokens.");
const quoted = (text) => [...new Set([...text.matchAll(/"([A-Za-z]+)"/g)].map(([, word]) => word))];
const contextual = quoted(tokens.split("*)")[0]);
const keywords = quoted(rules).filter((word) => !contextual.includes(word));
// The contextual keywords of a movement's actions: all but those of other entities.
const actionWords = contextual.filter((word) => !["distance", "bumper", "import"].includes(word));
const entities = ["wheel", "wheelH", "sensor", "ip", "robot", "parallel", "movement", "environment"];

// A keyword does not continue as another word or as a malformed name: `wheels`, `wheel-a`.
const oneOf = (words) => `(?:${words.join("|")})(?![\\p{L}\\p{M}\\p{N}_]|[-.'’][\\p{L}_])`;
const name = `(?:\\^[A-Za-z_][A-Za-z0-9_]*|(?!${oneOf(keywords)})[A-Za-z_][A-Za-z0-9_]*)`;
// An action's first words that are followed by what no name is followed by: where a name is wanted, it is missing.
const counted = [...rules.matchAll(/= "([a-z]+)" (?:\( )?Number/g)].map(([, word]) => word);
const missing = `(?=(?:${counted.filter((word) => contextual.includes(word)).join("|")})\\s+(?:-?[0-9]|${oneOf(["until"])})|if\\s*\\{)`;
const nextEntity = `(?=${oneOf(entities)}|import(?=[ \\t]*"))`;

const word = "[\\p{L}_][\\p{L}\\p{M}\\p{N}_]*";
const malformed = { name: "invalid.illegal.name.pydslrep" };

const include = (...names) => names.map((name) => ({ include: `#${name}` }));
const named = (kind) => ({ match: name, name: scope(kind) });
const keyword = { name: scope("keyword") };

// Patterns with the same scope everywhere; they come last.
const anywhere = include("comment", "malformed-name", "keyword", "number", "string", "comma");

/** An entity: from its keyword to the next one. */
const entity = (words, ...patterns) => ({
  name: `meta.${words.at(-1)}.pydslrep`,
  begin: oneOf(words),
  beginCaptures: { 0: keyword },
  end: nextEntity,
  patterns: [...include("comment", "malformed-name"), ...patterns, ...anywhere],
});

/** A clause: from its keyword to `end`; its names are of one kind. */
const part = (word, end, kind, ...patterns) => ({
  begin: oneOf([word]),
  beginCaptures: { 0: keyword },
  end: `${end}|${nextEntity}`,
  patterns: [...include("comment", "malformed-name"), ...patterns, named(kind), ...anywhere],
});

/** Braces and their content. */
const braces = (end, ...patterns) => ({
  begin: "\\{",
  beginCaptures: { 0: { name: "punctuation.section.block.begin.pydslrep" } },
  end: `(\\})|${end}`,
  endCaptures: { 1: { name: "punctuation.section.block.end.pydslrep" } },
  patterns: [...include("comment", "malformed-name"), ...patterns, ...anywhere],
});

/** Names in braces. Where no brace closes them, the next word that is no name does. */
const list = (kind) => braces(`(?=\\{|${oneOf(keywords)})|${missing}|${nextEntity}`, named(kind));

/** The condition after a word: the sensors in braces. */
const condition = (word) =>
  part(word, `(?<=\\})|(?=\\}|${oneOf(keywords)})|${missing}`, "property", list("property"));

const grammar = {
  $schema: "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
  name: "PyDSLRep",
  scopeName: "source.pydslrep",
  fileTypes: ["pyr"],
  patterns: [
    ...include("comment", "malformed-name"),
    { match: oneOf(["import"]), ...keyword },
    ...include("wheel", "sensor", "ip", "robot", "movement", "environment"),
    ...anywhere,
  ],
  repository: {
    wheel: entity(["wheelH", "wheel"], named("variable")),
    sensor: entity(
      ["sensor"],
      {
        begin: ":",
        beginCaptures: { 0: { name: "punctuation.separator.pydslrep" } },
        // A single name; anything else ends the rule.
        end: `(${oneOf(["distance", "bumper"])})|(?=[A-Za-z_^{}:,0-9"])`,
        endCaptures: { 1: keyword },
        patterns: include("comment"),
      },
      named("property"),
    ),
    ip: entity(["ip"], named("enumMember")),
    robot: entity(
      ["robot"],
      part("has", `(?=${oneOf(["wheels", "with"])})`, "variable", list("variable")),
      list("property"),
      named("class"),
    ),
    movement: {
      patterns: [
        { match: oneOf(["parallel"]), ...keyword },
        entity(
          ["movement"],
          part("of", "(?=[{}])", "class"),
          ...include("actions"),
          named("function"),
        ),
      ],
    },
    // Actions in braces. The only names are in conditions and after `do`, so every contextual word elsewhere is a keyword.
    actions: braces(
      nextEntity,
      ...include("actions"),
      condition("until"),
      condition("if"),
      {
        // The name ends the rule.
        begin: oneOf(["do"]),
        beginCaptures: { 0: keyword },
        end: `(?=[{}0-9"]|-[0-9]|${oneOf(keywords)})|${missing}|${nextEntity}|(${name})`,
        endCaptures: { 1: { name: scope("function") } },
        patterns: include("comment", "malformed-name"),
      },
      { match: oneOf(actionWords), ...keyword },
      // Any other word is consumed as a whole.
      { match: name },
    ),
    environment: entity(
      ["environment"],
      {
        // `with ip NAME`, or the older `, NAME`; the name ends the rule.
        begin: `(${oneOf(["with"])})|,`,
        beginCaptures: { 1: keyword },
        end: `(${name})|(?=[{}]|${oneOf(["has", ...entities.filter((word) => word !== "ip")])})`,
        endCaptures: { 1: { name: scope("enumMember") } },
        patterns: anywhere,
      },
      part("has", `(?=${oneOf(["robots", "with"])})`, "class", list("class")),
      list("function"),
      named("namespace"),
    ),

    comment: {
      patterns: [
        {
          name: scope("comment", "line.double-slash"),
          begin: "//",
          beginCaptures: { 0: { name: "punctuation.definition.comment.pydslrep" } },
          end: "$",
        },
        {
          name: scope("comment", "block"),
          begin: "/\\*",
          beginCaptures: { 0: { name: "punctuation.definition.comment.begin.pydslrep" } },
          end: "\\*/",
          endCaptures: { 0: { name: "punctuation.definition.comment.end.pydslrep" } },
        },
        // Comments of other languages: an error, but their text is not part of the program.
        { name: scope("comment", "line"), match: "(?:#|<!--|(?:--|%|/|\\\\\\\\)[ \\t]).*$" },
      ],
    },
    keyword: { match: oneOf(keywords), ...keyword },
    number: {
      patterns: [
        { match: "[0-9]+(?:\\.[0-9]+){3}(?![0-9.])", name: scope("number", "address") },
        { match: "-?[0-9]+(?:\\.[0-9]+)?(?![0-9.])", name: scope("number", "decimal") },
        { match: "-?\\.*[0-9][0-9.]*", name: `invalid.illegal.number.pydslrep` },
      ],
    },
    string: {
      patterns: [
        { match: '"[^"]*"', name: scope("string") },
        { match: '"[^"]*$', name: `${scope("string")} invalid.illegal.unterminated.pydslrep` },
      ],
    },
    // `left-wheel`, `räder`: one error that contains no keyword.
    "malformed-name": {
      patterns: [
        { match: `\\^?${word}(?:[-.'’]${word})+`, ...malformed },
        { match: `\\^?(?![0-9])[A-Za-z0-9_]*(?=[^\\x00-\\x7F])[\\p{L}\\p{M}\\p{N}]+[\\p{L}\\p{M}\\p{N}_]*`, ...malformed },
      ],
    },
    comma: { match: ",", name: "punctuation.separator.pydslrep" },
  },
};

const text = JSON.stringify(grammar, undefined, 2) + "\n";
const file = new URL("pydslrep.tmLanguage.json", import.meta.url);
if (!process.argv.includes("--check")) {
  writeFileSync(file, text);
} else if (text !== read("pydslrep.tmLanguage.json")) {
  console.error("pydslrep.tmLanguage.json is not what build.mjs writes: run `node build.mjs` in grammar/textmate");
  process.exit(1);
}
