// The indentation of a new line, at once: the server's answer may come when the next block is open, whose closing brace the editor
// indents like the line that opens it.
import { indentService, type IndentContext } from "@codemirror/language";
import type { Extension } from "@codemirror/state";

const COMMENT = /\/\/.*|\/\*.*?\*\//g;

/** How many braces of a line are still open at its end. */
function opened(line: string): number {
  let open = 0;
  for (const sign of line.replace(COMMENT, "")) {
    if (sign === "{") open += 1;
    else if (sign === "}") open = Math.max(open - 1, 0);
  }
  return open;
}

/** That of a line that begins at a position, by the line before the break; the server knows more, and corrects it. */
function indentation(context: IndentContext, at: number): number | null {
  if (context.simulatedBreak !== at) return null;
  const line = context.state.doc.lineAt(at);
  const closes = /^\s*\}/.test(context.textAfterPos(at));
  const levels = opened(line.text.slice(0, at - line.from)) - Number(closes);
  return Math.max(context.lineIndent(line.from) + levels * context.unit, 0);
}

export const indent: Extension = indentService.of(indentation);
