// A path as a file: what is seen as PNG, and what the server has drawn as SVG, still or moving.
import * as path from "node:path";

import * as vscode from "vscode";

import { inform, fail } from "../notifications";
import { PNG } from "./messages";
import type { Which } from "./protocol";

/** Addresses of what the server has drawn. */
export interface Drawn {
  picture?: string | null;
  replay?: string | null;
  /** Whether a run is in it. */
  isDriven: boolean;
}

interface Format extends vscode.QuickPickItem {
  form: "svg" | "png" | "replay";
}

const FORMATS: Format[] = [
  { form: "svg", label: "SVG", detail: "The planned path, and that of the latest run, for documents" },
  { form: "png", label: "PNG", detail: "The picture as the preview shows it" },
  { form: "replay", label: "Replay", detail: "An animated SVG, for any browser" },
];

/** Asks for the format and the file, and writes it. */
export async function exportPath(which: Which, draw: () => Promise<Drawn | undefined>, picture: () => Promise<string>): Promise<void> {
  const format = await vscode.window.showQuickPick(FORMATS, { title: `Export the path of ${which.environment}`, placeHolder: "As what?" });
  if (format === undefined) return;
  const content = format.form === "png" ? fromAddress(await picture()) : await drawnFile(format.form, await draw());
  if (content === undefined) return;
  const ending = format.form === "png" ? "png" : "svg";
  const name = format.form === "replay" ? `${which.environment}-replay.${ending}` : `${which.environment}.${ending}`;
  const file = await vscode.window.showSaveDialog({ defaultUri: beside(which.uri, name), filters: { [ending.toUpperCase()]: [ending] } });
  if (file === undefined) return;
  try {
    await vscode.workspace.fs.writeFile(file, content);
  } catch (error) {
    fail(`Cannot write ${file.fsPath}: ${error instanceof Error ? error.message : String(error)}`);
    return;
  }
  const isOutside = ending === "svg";
  const open = () => (isOutside ? vscode.env.openExternal(file) : vscode.commands.executeCommand("vscode.open", file));
  inform(`Path exported: ${path.basename(file.path)}`, { label: "Open", press: open });
}

function fromAddress(data: string): Uint8Array {
  return Buffer.from(data.slice(PNG.length), "base64");
}

/** A file of the server's, which goes with it. */
async function drawnFile(kind: "svg" | "replay", drawn: Drawn | undefined): Promise<Uint8Array | undefined> {
  const address = kind === "svg" ? drawn?.picture : drawn?.replay;
  return typeof address === "string" ? vscode.workspace.fs.readFile(vscode.Uri.parse(address)) : undefined;
}

/** A file in the folder of a program; for one that was never saved, in the workspace. */
function beside(program: string, name: string): vscode.Uri {
  const uri = vscode.Uri.parse(program);
  const folder = uri.scheme === "untitled" ? vscode.workspace.workspaceFolders?.[0]?.uri : vscode.Uri.joinPath(uri, "..");
  return vscode.Uri.joinPath(folder ?? vscode.Uri.file("/"), name);
}
