// Writes pydslrep.tmLanguage.json: `node build.mjs`, with `--check` only looks whether that would change it.
//
// A TextMate grammar sees one line at a time and cannot look back, so what has to be known about a place is kept by
// nesting: an entity's rule reaches from its keyword to the next one, and inside of it a rule for each part where names
// mean something else. Every rule ends where the next entity begins, so nothing left open colours what follows.
//
// No rule asks for a word boundary on its left, because none is needed in the language (`4meters`): each word, number
// and comment is consumed as a whole.
import { readFileSync, writeFileSync } from "node:fs";

const read = (name) => readFileSync(new URL(name, import.meta.url), "utf8");
const colours = JSON.parse(read("../colours.json"));
const scope = (kind, detail) => [colours[kind].scope, detail, "pydslrep"].filter(Boolean).join(".");

// The published grammar has the words, and a test holds it against the lexer.
const [rules] = read("../pydslrep.ebnf").split("(* Tokens.");
const contextual = ["distance", "bumper", "import"];
const quoted = [...rules.matchAll(/"([A-Za-z]+)"/g)].map(([, word]) => word);
const keywords = [...new Set(quoted)].filter((word) => !contextual.includes(word));
const entities = ["wheel", "wheelH", "sensor", "ip", "robot", "parallel", "movement", "environment"];

// Behind a word there is neither more of it nor what makes it a malformed name: `wheels`, `wheel-a`.
const oneOf = (words) => `(?:${words.join("|")})(?![\\p{L}\\p{M}\\p{N}_]|[-.'’][\\p{L}_])`;
const name = `(?:\\^[A-Za-z_][A-Za-z0-9_]*|(?!${oneOf(keywords)})[A-Za-z_][A-Za-z0-9_]*)`;
const nextEntity = `(?=${oneOf(entities)}|import(?=[ \\t]*"))`;

const word = "[\\p{L}_][\\p{L}\\p{M}\\p{N}_]*";
const malformed = { name: "invalid.illegal.name.pydslrep" };

const include = (...names) => names.map((name) => ({ include: `#${name}` }));
const named = (kind) => ({ match: name, name: scope(kind) });
const keyword = { name: scope("keyword") };

// What has the same colour wherever it stands; it comes last.
const anywhere = include("comment", "malformed-name", "keyword", "number", "string", "comma");

/** An entity: from its keyword to the next one. */
const entity = (words, ...patterns) => ({
  name: `meta.${words.at(-1)}.pydslrep`,
  begin: oneOf(words),
  beginCaptures: { 0: keyword },
  end: nextEntity,
  patterns: [...include("comment", "malformed-name"), ...patterns, ...anywhere],
});

/** A part: from its first word up to what `end` says, in which names are of one kind. */
const part = (word, end, kind, ...patterns) => ({
  begin: oneOf([word]),
  beginCaptures: { 0: keyword },
  end: `${end}|${nextEntity}`,
  patterns: [...include("comment", "malformed-name"), ...patterns, named(kind), ...anywhere],
});

/** Braces and what is between them. */
const braces = (end, ...patterns) => ({
  begin: "\\{",
  beginCaptures: { 0: { name: "punctuation.section.block.begin.pydslrep" } },
  end: `(\\})|${end}`,
  endCaptures: { 1: { name: "punctuation.section.block.end.pydslrep" } },
  patterns: [...include("comment", "malformed-name"), ...patterns, ...anywhere],
});

/** Names in braces. Where no brace closes them, the next word that is no name does. */
const list = (kind) => braces(`(?=\\{|${oneOf(keywords)})|${nextEntity}`, named(kind));

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
        // One word, and whatever else begins ends it.
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
          braces(
            nextEntity,
            part("until", `(?<=\\})|(?=\\}|${oneOf(keywords)})`, "property", list("property")),
          ),
          named("function"),
        ),
      ],
    },
    environment: entity(
      ["environment"],
      {
        // `with ip NAME`, or `, NAME` in the older spelling; the name ends it.
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
        // As other languages write them: a mistake, but what they say is no part of the program.
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
    // `left-wheel`, `räder`: one mistake, and no keyword within it.
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
