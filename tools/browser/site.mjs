// The page as people get it: clips that posekit makes, served by `posekit serve` on any free port.

import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

const ROOT = resolve(dirname(fileURLToPath(import.meta.url)), "../..");

/** The page to test: PAGE, or where the build task puts it. */
export const PAGE = process.env.PAGE ?? join(ROOT, "target/page");

/** The program to serve it with: POSEKIT, or the newest that was built. */
export const POSEKIT = process.env.POSEKIT ?? newest(["debug", "release"].map((profile) => join(ROOT, "target", profile, "posekit")));

function newest(paths) {
  const built = paths.filter(existsSync);
  if (built.length === 0) throw new Error("posekit is not built: cargo build");
  return built.sort((a, b) => statSync(b).mtimeMs - statSync(a).mtimeMs)[0];
}

/** Starts a server over a folder of clips: `{ address, folder, stop }`. */
export async function serve(extra = []) {
  if (!existsSync(join(PAGE, "index.html"))) throw new Error(`${PAGE}: no page there: cargo xtask web`);
  const base = mkdtempSync(join(tmpdir(), "posekit-page-"));
  const folder = join(base, "takes");
  mkdirSync(join(folder, "more"), { recursive: true });
  const make = (motion, name) => execFileSync(POSEKIT, ["sample", motion, "-o", join(folder, name), "--quiet"]);
  make("walk", "a walk.bvh");
  make("run", "more/run.bvh");
  make("wave", "wave.bvh");
  const child = spawn(POSEKIT, ["serve", folder, "--page", PAGE, "--port", "0", "--quiet", ...extra], { stdio: ["ignore", "pipe", "inherit"] });
  const address = await firstLine(child);
  const stop = () => {
    child.kill("SIGINT");
    rmSync(base, { recursive: true, force: true });
  };
  return { address, folder, stop };
}

async function firstLine(child) {
  for await (const line of createInterface({ input: child.stdout })) return line.trim();
  throw new Error("posekit serve ended without an address");
}
