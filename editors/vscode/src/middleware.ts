// What is between the editor and the server: which settings it is told, and where its commands and pictures go.
import * as vscode from "vscode";
import type { Middleware } from "vscode-languageclient/node";

import manifest from "../package.json";
import type { ChosenEnvironment } from "./environments";
import { execute, type Surroundings } from "./execute";
import { explanations } from "./explain";
import { reached } from "./milestones";
import type { Runs } from "./run";
import { setTable } from "./settings";

/** The commands of this extension that the server may put into a lens. */
export const CLIENT_COMMANDS = ["pydslrep.showReferences"];

const SECTION = "pydslrep";

/** The settings that the server knows. */
const KEYS = manifest.contributes.configuration
  .filter(({ title }) => title === "Programs")
  .flatMap(({ properties }) => Object.keys(properties))
  .map((key) => key.slice(SECTION.length + 1));

export function middleware(around: Surroundings, runs: Runs): Middleware {
  return {
    workspace: {
      configuration: async (params, token, next) => {
        const answers: unknown = await next(params, token);
        const others: unknown[] = Array.isArray(answers) ? answers : [];
        const settings = vscode.workspace.getConfiguration(SECTION);
        const told = params.items.map((item, index): unknown =>
          item.section === SECTION ? setTable(KEYS, (key) => settings.inspect<unknown>(key)) : others[index],
        );
        return told;
      },
    },
    // Not by the client library: it would show each failure twice, and in words of the protocol.
    executeCommand: async (command, args: unknown[], next) => {
      const [chosen] = args as [ChosenEnvironment];
      switch (command) {
        case "pydslrep.run":
          return runs.run(chosen);
        case "pydslrep.previewPath":
          return vscode.commands.executeCommand("pydslrep.showPreview", vscode.Uri.parse(chosen.uri), chosen.environment);
        case "pydslrep.generateScript": {
          const answer = await execute(around, command, chosen);
          if (answer !== undefined) {
            reached("script");
          }
          return answer;
        }
        default:
          return next(command, args) as unknown;
      }
    },
    provideCodeActions: async (document, range, context, token, next) => {
      const actions = (await next(document, range, context, token)) ?? [];
      const isFix = context.only?.contains(vscode.CodeActionKind.QuickFix) ?? true;
      return isFix ? [...actions, ...explanations(context.diagnostics)] : actions;
    },
    window: {
      // The picture of a run: the preview shows what is in it, where one can look closer.
      showDocument: (params, token, next) =>
        params.external === true && params.uri.endsWith(".svg") ? { success: true } : next(params, token),
    },
  };
}
