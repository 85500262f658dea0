// Links that carry a whole project in the fragment of the address, which browsers send to no server.
import { projectOf, type Project } from "./documents";

const KEY = "#project=";

/** Texts longer than this are not read: a short link can hold any amount of compressed text. */
const MAX_LENGTH = 2_000_000;

/** The fragment of a link to a project. */
export async function fragmentOf(project: Project): Promise<string> {
  const stream = new Blob([JSON.stringify(project)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return KEY + btoa(binary).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** The project of a fragment: undefined if the fragment is no link to one, "damaged" if it is one that cannot be read. */
export async function projectIn(fragment: string): Promise<Project | "damaged" | undefined> {
  if (!fragment.startsWith(KEY)) return undefined;
  try {
    const binary = atob(fragment.slice(KEY.length).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(binary, (character) => character.charCodeAt(0));
    return projectOf(JSON.parse(await inflate(bytes))) ?? "damaged";
  } catch {
    return "damaged";
  }
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<string> {
  const decoder = new TextDecoder("utf-8", { fatal: true });
  let text = "";
  for await (const chunk of new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"))) {
    text += decoder.decode(chunk, { stream: true });
    if (text.length > MAX_LENGTH) throw new RangeError("too long");
  }
  return text + decoder.decode();
}
