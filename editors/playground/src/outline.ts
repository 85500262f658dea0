// The outline of the program: a list of its declarations, which lead there.
import type { DocumentSymbol } from "vscode-languageserver-protocol";

import type { Connection } from "./connection";
import { button, element } from "./elements";

/** After the latest keystroke, milliseconds. */
const DELAY = 150;

export class Outline {
  private timer = 0;
  private latest = "";

  constructor(
    private readonly list: HTMLElement,
    private readonly connection: Connection,
    private readonly reveal: (line: number, character: number) => void,
  ) {}

  /** Reads the symbols of a program again, soon. */
  update(uri: string): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.request(uri), DELAY);
  }

  private async request(uri: string): Promise<void> {
    const symbols = (await this.connection
      .request("textDocument/documentSymbol", { textDocument: { uri } })
      .catch(() => null)) as DocumentSymbol[] | null;
    const text = JSON.stringify(symbols);
    if (symbols === null || text === this.latest) return;
    this.latest = text;
    this.list.replaceChildren(...symbols.map((symbol) => this.item(symbol)));
  }

  private item({ name, detail, selectionRange: { start } }: DocumentSymbol): HTMLElement {
    const entry = button(name, () => this.reveal(start.line, start.character));
    if (detail) entry.append(element("span", { class: "detail" }, ` ${detail}`));
    return element("li", {}, entry);
  }
}
