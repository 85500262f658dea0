// The Python packages of a run, as built for Pyodide: from PyPI, in the versions and with the hashes of python/requirements.txt.
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";

const root = path.resolve(import.meta.dirname, "..");
const repository = path.resolve(root, "../..");

/** The client of CoppeliaSim, and what it encodes messages with. ZeroMQ needs sockets: src/run/python/zmq stands in for it. */
const PACKAGES = ["coppeliasim-zmqremoteapi-client", "cbor2"];

/** Python for the build, which has pip: that of the tests, or else the system's. */
function python(...options) {
  const ofTests = path.join(repository, ".venv/bin/python");
  execFileSync(existsSync(ofTests) ? ofTests : "python3", options, { stdio: ["ignore", "ignore", "inherit"] });
}

/** The part of python/requirements.txt about the packages, with hashes. */
function requirements() {
  const entries = readFileSync(path.join(repository, "python/requirements.txt"), "utf8").split(/\n(?! )/);
  return PACKAGES.map((name) => {
    const entry = entries.find((text) => text.startsWith(`${name}==`));
    if (entry === undefined) throw new Error(`python/requirements.txt has no ${name}`);
    return `${entry}\n`;
  }).join("");
}

/** A folder with the wheels, and for each a folder of what it contains; it is filled when requirements or Pyodide change. */
export function wheels() {
  const { info } = JSON.parse(readFileSync(path.join(root, "node_modules/pyodide/pyodide-lock.json"), "utf8"));
  const platform = ["--platform", `pyemscripten_${info.abi_version}_wasm32`, "--python-version", info.python];
  const wanted = `# ${platform.join(" ")}\n${requirements()}`;
  const folder = path.join(root, "wheels");
  const list = path.join(folder, "requirements.txt");
  if (!existsSync(list) || readFileSync(list, "utf8") !== wanted) {
    const part = `${folder}.part`;
    for (const old of [folder, part]) rmSync(old, { recursive: true, force: true });
    mkdirSync(part);
    writeFileSync(path.join(part, "requirements.txt"), wanted);
    const options = ["--quiet", "--disable-pip-version-check", "--require-hashes", "--no-deps", "--only-binary", ":all:", ...platform];
    python("-m", "pip", "download", ...options, "--dest", part, "--requirement", path.join(part, "requirements.txt"));
    for (const name of namesIn(part)) python("-m", "zipfile", "-e", path.join(part, name), path.join(part, path.parse(name).name));
    renameSync(part, folder);
  }
  return { folder, names: namesIn(folder) };
}

const namesIn = (folder) => readdirSync(folder).filter((name) => name.endsWith(".whl")).sort();
