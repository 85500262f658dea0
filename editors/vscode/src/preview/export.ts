// Exports a path: as PNG from the page, or as still or animated SVG drawn by the server.
import * as vscode from "vscode";

import { showError, showInformation } from "../notifications";
import { PNG_PREFIX } from "../../../preview/host/messages";
import type { EnvironmentId } from "../../../preview/host/protocol";

/** URIs of the files that the server has drawn. */
export interface Drawings {
  picture?: string | null;
  replay?: string | null;
}

/** Draws the paths of an environment; `isRunCurrent` if its latest run was one of the program as it is now. */
export type Draw = (environment: EnvironmentId, isRunCurrent: boolean) => Promise<Drawings | undefined>;

type DrawCurrent = (environment: EnvironmentId) => Promise<Drawings | undefined> | undefined;

interface Format extends vscode.QuickPickItem {
  form: "svg" | "png" | "replay";
}

const FORMATS: Format[] = [
  { form: "svg", label: "SVG", detail: "The planned path and that of the latest run, for documents" },
  { form: "png", label: "PNG", detail: "The picture as shown in the preview" },
  { form: "replay", label: "Replay", detail: "An animated SVG, for any browser" },
];

/** Asks for a format and a file, and writes the file. Without `draw` there is only the picture of the page. */
export async function exportPath(environment: EnvironmentId, draw: DrawCurrent | undefined, capture: () => Promise<string>): Promise<void> {
  const formats = draw ? FORMATS : FORMATS.filter(({ form }) => form === "png");
  const format = await vscode.window.showQuickPick(formats, { title: `Export the path of ${environment.environment}`, placeHolder: "Which format?" });
  if (format === undefined) return;
  const content = format.form === "png" ? decodePng(await capture()) : await readDrawing(format.form, await draw?.(environment));
  if (content === undefined) return;
  const extension = format.form === "png" ? "png" : "svg";
  const name = format.form === "replay" ? `${environment.environment}-replay.${extension}` : `${environment.environment}.${extension}`;
  const file = await vscode.window.showSaveDialog({ defaultUri: nextTo(environment.uri, name), filters: { [extension.toUpperCase()]: [extension] } });
  if (file === undefined) return;
  try {
    await vscode.workspace.fs.writeFile(file, content);
  } catch (error) {
    showError(`Cannot write ${file.fsPath}: ${error instanceof Error ? error.message : String(error)}`);
    return;
  }
  // VS Code shows an SVG as text.
  const open = () => (extension === "svg" ? vscode.env.openExternal(file) : vscode.commands.executeCommand("vscode.open", file));
  showInformation(`Path exported: ${file.path.slice(file.path.lastIndexOf("/") + 1)}`, { label: "Open", press: open });
}

function decodePng(dataUri: string): Uint8Array {
  return Uint8Array.from(atob(dataUri.slice(PNG_PREFIX.length)), (character) => character.charCodeAt(0));
}

async function readDrawing(form: "svg" | "replay", drawings: Drawings | undefined): Promise<Uint8Array | undefined> {
  const uri = form === "svg" ? drawings?.picture : drawings?.replay;
  return typeof uri === "string" ? vscode.workspace.fs.readFile(vscode.Uri.parse(uri)) : undefined;
}

/** A file in the program's folder, or in the workspace if the program was never saved. */
function nextTo(program: string, name: string): vscode.Uri {
  const uri = vscode.Uri.parse(program);
  const folder = uri.scheme === "untitled" ? vscode.workspace.workspaceFolders?.[0]?.uri : vscode.Uri.joinPath(uri, "..");
  return vscode.Uri.joinPath(folder ?? vscode.Uri.file("/"), name);
}
