import assert from "node:assert/strict";
import { test } from "node:test";

import { page } from "../src/preview/page";

test("only the extension's script runs in the page", () => {
  const html = page({ source: "https://x.test", script: "https://x.test/a.js", style: "https://x.test/a.css", nonce: "n0" });
  assert.match(html, /default-src 'none'; style-src https:\/\/x\.test; script-src 'nonce-n0';/);
  assert.deepEqual(html.match(/<script[^>]*>/g), ['<script nonce="n0" src="https://x.test/a.js">']);
  assert.doesNotMatch(html, /unsafe|style=/);
});
