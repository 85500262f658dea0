// Which diagnostics are not shown while their statement is being typed.

/** The line being typed when the server found that the next word of its statement will settle a diagnostic. */
function typedLine(diagnostic: object): number | undefined {
  const data = "data" in diagnostic ? diagnostic.data : undefined;
  const line = typeof data === "object" && data !== null && "typedLine" in data ? data.typedLine : undefined;
  return typeof line === "number" ? line : undefined;
}

/** Whether the next word of a statement will settle a diagnostic. */
export function isUnsettled(diagnostic: object): boolean {
  return typedLine(diagnostic) !== undefined;
}

/** The diagnostics to show while these lines are being typed. */
export function settled<T extends object>(diagnostics: readonly T[], lines: ReadonlySet<number>): T[] {
  return diagnostics.filter((diagnostic) => {
    const line = typedLine(diagnostic);
    return line === undefined || !lines.has(line);
  });
}

/** The lines being typed in: those of the cursors, from a change of the text until a cursor goes to another line without one. */
export class TypedLines {
  private cursors: ReadonlySet<number> = new Set();
  private isTyping = false;
  /** Whether the text has changed since the cursors were last seen. */
  private isChanged = false;

  get lines(): ReadonlySet<number> {
    return this.isTyping ? this.cursors : new Set();
  }

  changed(): void {
    this.isTyping = true;
    this.isChanged = true;
  }

  /** The cursors are on these lines. */
  moved(lines: readonly number[]): void {
    const isElsewhere = lines.length !== this.cursors.size || lines.some((line) => !this.cursors.has(line));
    this.cursors = new Set(lines);
    if (isElsewhere && !this.isChanged) {
      this.isTyping = false;
    }
    this.isChanged = false;
  }

  /** Saved text counts as finished. */
  left(): void {
    this.isTyping = false;
  }
}
