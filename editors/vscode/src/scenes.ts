// Builds, checks and removes scenes in a running CoppeliaSim. The server asks and reports, in every editor.
import * as vscode from "vscode";

import { type Connection, executeWithProgress } from "./execute";
import type { EnvironmentId } from "../../preview/host/protocol";
import { askForTrust } from "./run";

/** The server's commands on scenes, with what their progress is called. */
const TITLES = {
  "pydslrep.pushScene": "Building the scene of",
  "pydslrep.checkScene": "Checking the scene of",
  "pydslrep.removeScene": "Removing the scene of",
} as const;

interface Finding {
  severity: string;
  robot: string | null;
  message: string;
  help: string;
}

export function isOnScene(command: string): command is keyof typeof TITLES {
  return command in TITLES;
}

/** Executes a command on the scene of an environment; what it finds wrong is in the output channel, too. */
export async function onScene(connection: Connection, command: keyof typeof TITLES, environment: EnvironmentId): Promise<unknown> {
  if (!vscode.workspace.isTrusted) {
    askForTrust();
    return undefined;
  }
  const cancellation = new vscode.CancellationTokenSource();
  try {
    const title = `${TITLES[command]} ${environment.environment}`;
    const answer = await executeWithProgress(connection, command, environment, cancellation, title);
    for (const { severity, robot, message, help } of findings(answer)) {
      connection.output.info(`${severity}: ${robot === null ? "" : `robot ${robot}: `}${message}; ${help}`);
    }
    return answer;
  } finally {
    cancellation.dispose();
  }
}

function findings(answer: unknown): Finding[] {
  return typeof answer === "object" && answer !== null && "findings" in answer ? (answer.findings as Finding[]) : [];
}
