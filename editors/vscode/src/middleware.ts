// Intercepts the language client: which settings the server gets, and how its commands and documents are shown.
import * as vscode from "vscode";
import type { Middleware } from "vscode-languageclient";

import manifest from "../package.json";
import { filteredHere } from "./completion";
import { execute, type Connection } from "./execute";
import { explainActions } from "./explain";
import { reached } from "./milestones";
import type { EnvironmentId } from "../../preview/host/protocol";
import type { Runs } from "./run";
import { isOnScene, onScene } from "./scenes";
import { explicitSettings } from "./settings";

/** The commands of this extension that the server may use in a lens. */
export const CLIENT_COMMANDS = ["pydslrep.showReferences"];

const SECTION = "pydslrep";

/** The settings that the server knows. */
const KEYS = manifest.contributes.configuration
  .filter(({ title }) => title === "Programs")
  .flatMap(({ properties }) => Object.keys(properties))
  .map((key) => key.slice(SECTION.length + 1));

export function middleware(connection: Connection, runs: Runs | undefined): Middleware {
  return {
    workspace: {
      configuration: async (params, token, next) => {
        const answers: unknown = await next(params, token);
        const others: unknown[] = Array.isArray(answers) ? answers : [];
        const settings = vscode.workspace.getConfiguration(SECTION);
        return params.items.map((item, index): unknown =>
          item.section === SECTION ? explicitSettings(KEYS, (key) => settings.inspect<unknown>(key)) : others[index],
        );
      },
    },
    // Left to the client library, each failure would be shown twice, in the protocol's terms.
    executeCommand: async (command, args: unknown[], next) => {
      const [environment] = args as [EnvironmentId];
      switch (command) {
        case "pydslrep.run":
          return runs?.run(environment);
        case "pydslrep.previewPath":
          return vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(environment.uri), environment.environment);
        case "pydslrep.generateScript": {
          const answer = await execute(connection, command, environment);
          if (answer !== undefined) {
            reached("script");
          }
          return answer;
        }
        default:
          return isOnScene(command) ? onScene(connection, command, environment) : (next(command, args) as unknown);
      }
    },
    provideCompletionItem: async (document, position, context, token, next) => {
      const found = await next(document, position, context, token);
      return found && filteredHere(found);
    },
    provideCodeActions: async (document, range, context, token, next) => {
      const actions = (await next(document, range, context, token)) ?? [];
      const wantsFixes = context.only?.contains(vscode.CodeActionKind.QuickFix) ?? true;
      return wantsFixes ? [...actions, ...explainActions(context.diagnostics)] : actions;
    },
    window: {
      // The picture of a run is not opened: the preview shows the same path.
      showDocument: (params, token, next) =>
        params.external === true && params.uri.endsWith(".svg") ? { success: true } : next(params, token),
    },
  };
}
