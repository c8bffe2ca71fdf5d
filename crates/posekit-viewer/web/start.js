// Starts the viewer in the page, and says how far that is. A file of its own, so that a host may forbid
// scripts that stand in pages.

// The build task puts the size of the module, unpacked, and a mark of this build here.
const MODULE = { file: "posekit_viewer_bg.wasm?v=__VERSION__", bytes: Number("__MODULE_BYTES__") };
const cover = document.getElementById("cover");
const bar = document.getElementById("bar");
const message = document.getElementById("message");

class Unfit extends Error {}

/// Whether the browser can draw at all.
async function check() {
  const canvas = document.createElement("canvas");
  if (canvas.getContext("webgl2")) return;
  const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
  if (!adapter) {
    throw new Unfit(
      "This browser offers neither WebGPU nor WebGL2, with which the figure is drawn.\n" +
      "A current Chromium, Firefox or Safari has one of them, unless graphics acceleration is " +
      "switched off in its settings. The desktop program needs neither.");
  }
}

/// Fetches the module, telling how far it is. It is compiled as it comes.
async function fetchModule() {
  const response = await fetch(MODULE.file);
  if (!response.ok) throw new Error(`${MODULE.file}: the server answered ${response.status}`);
  let done = 0;
  const counted = response.body.pipeThrough(new TransformStream({
    transform(piece, onward) {
      done += piece.byteLength;
      const share = Math.min(done / MODULE.bytes, 1);
      bar.firstElementChild.style.width = `${100 * share}%`;
      bar.setAttribute("aria-valuenow", Math.round(100 * share));
      message.textContent = `${(done / 1e6).toFixed(1)} of ${(MODULE.bytes / 1e6).toFixed(1)} MB`;
      onward.enqueue(piece);
    },
  }));
  return new Response(counted, { headers: { "content-type": "application/wasm" } });
}

function tell(text) {
  bar.hidden = true;
  message.textContent = text;
  cover.hidden = false;
}

// Keys that are the viewer's, though a browser has a use for them too.
addEventListener("keydown", (event) => {
  const typing = event.target instanceof HTMLInputElement;
  const held = event.ctrlKey || event.metaKey;
  if (held ? "e137".includes(event.key.toLowerCase()) : !typing && "/'".includes(event.key)) {
    event.preventDefault();
  }
});

// What goes wrong later stops the viewer for good; it keeps no file that could be lost.
addEventListener("error", (event) => {
  if (!(event.error instanceof WebAssembly.RuntimeError)) return;
  tell("The viewer has stopped because of an error in it. Your files are untouched.");
  const again = document.createElement("button");
  again.textContent = "Start it again";
  again.onclick = () => location.reload();
  cover.append(again);
});

/// The clips that the server offers.
async function fetchList() {
  const response = await fetch("clips.json");
  return response.ok ? await response.json() : null;
}

/// What this page is called among those of its origin that are open in the browser, and what the others are called.
/// Each holds a lock of its name, which the browser lets go when the page is gone.
async function findRuns() {
  const run = `${Date.now()}-${Math.random().toString(36).slice(2)}`;
  const prefix = "posekit page ";
  // What was in this tab before is gone, though its lock may be let go a little later.
  const before = sessionStorage.getItem("posekit page");
  sessionStorage.setItem("posekit page", run);
  // A page that came by plain HTTP from another machine has no locks, and takes itself for the only one.
  if (!navigator.locks) return { run, others: [] };
  navigator.locks.request(prefix + run, () => new Promise(() => {})).catch(() => {});
  const { held = [] } = await navigator.locks.query();
  const names = held.map((lock) => lock.name).filter((name) => name.startsWith(prefix));
  return { run, others: names.map((name) => name.slice(prefix.length)).filter((name) => name !== run && name !== before) };
}

/// Nothing, after a while.
const nothingAfter = (ms) => new Promise((done) => setTimeout(done, ms, null));

try {
  // A browser that cannot draw fetches nothing; what is fetched comes all at once, none waiting for another.
  await check();
  const module = fetchModule();
  module.catch(() => {});
  const list = fetchList().catch(() => null);
  // Where a browser refuses to tell, the page takes itself for the only one.
  const runs = findRuns().catch(() => ({ run: `${Date.now()}`, others: [] }));
  const viewer = import("./posekit_viewer.js?v=__VERSION__");
  const { default: init, start } = await viewer;
  await init({ module_or_path: module });
  message.textContent = "Starting\u2026";
  // The list is small and was asked for together with the module: a server that has not sent it by
  // now has a few seconds more.
  const clips = await Promise.race([list, nothingAfter(5000)]);
  const { run, others } = await runs;
  await start(document.getElementById("view"), clips, run, others);
  cover.hidden = true;
  document.getElementById("view").focus();
} catch (error) {
  if (error instanceof Unfit) {
    tell(error.message);
  } else {
    console.error(error);
    tell(`The viewer could not be started: ${error?.message ?? error}`);
  }
}
