// How long it takes from opening the page until a figure is seen moving, as the page itself sees it.
//
//     cargo build --release && cargo xtask web
//     cd tools/browser && npm ci && xvfb-run -a node first_figure.mjs
//
// The canvas is looked at after every frame that is drawn, so that a blank one does not count. The
// browser is running already; the first time it has never seen the page, later it has.

import { BROWSERS, PATIENCE_MS, launch } from "./browsers.mjs";
import { FIGURE, WINDOW } from "./desk.mjs";
import { serve } from "./site.mjs";

const TIMES = Number(process.env.TIMES ?? 5);

const site = await serve();
try {
  for (const browser of BROWSERS) {
    const running = await launch(browser, { defaultViewport: WINDOW });
    const page = await running.newPage();
    await page.setViewport(WINDOW);
    await page.evaluateOnNewDocument(watchCanvas, FIGURE);
    const took = [];
    for (let time = 0; time < TIMES; time += 1) {
      await page.goto(site.address, { waitUntil: "load" });
      await page.waitForFunction(() => window.seen?.moved, { timeout: PATIENCE_MS });
      took.push(await page.evaluate(() => window.seen));
      await page.goto("about:blank");
    }
    await running.close();
    const secs = (field) => took.map((seen) => (seen[field] / 1000).toFixed(2)).join(" ");
    console.log(`${browser.name}: a figure after ${secs("first")} s, moving after ${secs("moved")} s`);
  }
} finally {
  site.stop();
}

/** Runs in the page before anything else: looks at the canvas after every frame. */
function watchCanvas(place) {
  const [width, height] = [96, 100];
  const eye = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d", { willReadFrequently: true });
  const seen = (window.seen = { first: 0, moved: 0 });
  let before = null;
  const differs = (a, b, i, j) => [0, 1, 2].some((c) => Math.abs(a[i + c] - b[j + c]) > 24);
  const look = () => {
    const canvas = document.getElementById("view");
    if (!canvas || seen.moved) return;
    const scale = canvas.width / canvas.clientWidth;
    eye.drawImage(canvas, place.x * scale, place.y * scale, place.width * scale, place.height * scale, 0, 0, width, height);
    const now = eye.getImageData(0, 0, width, height).data;
    let standing = 0;
    let moved = 0;
    for (let i = 0; i < now.length; i += 4) {
      if (now[i + 3] === 255 && differs(now, now, i, i - (i % (4 * width)))) standing += 1;
      if (before && differs(now, before, i, i)) moved += 1;
    }
    if (standing < 0.01 * width * height) return;
    if (!seen.first) seen.first = performance.now();
    else if (moved > 0.003 * width * height) seen.moved = performance.now();
    before ??= now;
  };
  const plain = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => plain((time) => {
    draw(time);
    look();
  });
}
