// The browsers that are there, each with the graphics that it is to use. All draw in software, so that
// the tests run on a machine without a graphics card; a blank canvas fails them, whatever it claims.

import { existsSync } from "node:fs";
import { join } from "node:path";

import puppeteer from "puppeteer-core";

/** How long anything at all may take: a busy machine that draws in software may take a minute for what takes a second. */
export const PATIENCE_MS = 240_000;

const CHROMIUM = found(["chromium", "chromium-browser", "google-chrome"]);
const FIREFOX = found(["firefox-esr", "firefox"]);

const SWIFTSHADER = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
// Without every one of these the canvas stays blank while frames are counted.
const SWIFTSHADER_WEBGPU = [
  "--enable-unsafe-webgpu", "--enable-features=Vulkan", "--use-vulkan=swiftshader", "--use-angle=swiftshader",
  "--use-webgpu-adapter=swiftshader", "--ignore-gpu-blocklist",
];
const NOTHING = ["--disable-3d-apis", "--disable-gpu", "--disable-software-rasterizer"];

/** What can be tested here. */
export const BROWSERS = [
  chromium("Chromium, WebGL2", [...SWIFTSHADER, "--disable-features=WebGPU"]),
  chromium("Chromium, WebGPU", SWIFTSHADER_WEBGPU),
  firefox("Firefox, WebGL2", { "dom.webgpu.enabled": false }),
  firefox("Firefox, WebGPU", { "dom.webgpu.enabled": true, "gfx.webgpu.ignore-blocklist": true }),
].filter((browser) => browser && isWanted(browser.name));

/** Chromium without anything that draws. */
export const WITHOUT_GRAPHICS = chromium("Chromium, no graphics", NOTHING);

/** BROWSER="Chromium" or "WebGPU" leaves only those whose name has that in it. */
function isWanted(name) {
  return name.includes(process.env.BROWSER ?? "");
}

function chromium(name, flags) {
  // A container has no sandbox to offer to root.
  // The watchdog takes drawing in software on a busy machine for a graphics driver that hangs.
  const args = ["--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu-watchdog", ...flags];
  return CHROMIUM && { name, kind: "chromium", options: { executablePath: CHROMIUM, args } };
}

function firefox(name, extraPrefsFirefox) {
  return FIREFOX && { name, kind: "firefox", options: { browser: "firefox", executablePath: FIREFOX, extraPrefsFirefox } };
}

function found(names) {
  const folders = (process.env.PATH ?? "").split(":");
  return names.flatMap((name) => folders.map((folder) => join(folder, name))).find(existsSync);
}

/** Starts one. */
export function launch(browser, options = {}) {
  const patience = { timeout: PATIENCE_MS, protocolTimeout: PATIENCE_MS };
  return puppeteer.launch({ headless: true, ...patience, ...browser.options, ...options });
}
