// The viewer as a web page, in every browser that is here: opened, dropped on, scrubbed, played, saved.
// What is asked is asked of pixels.

import assert from "node:assert/strict";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

import { PNG } from "pngjs";

import { BROWSERS, WITHOUT_GRAPHICS } from "./browsers.mjs";
import { Desk, difference, part, sleep } from "./desk.mjs";
import { meanDifference, picture, shrunk, standingOut } from "./picture.mjs";
import { serve } from "./site.mjs";

/** Two pictures of different poses or figures differ by this much of the view at least. */
const OTHER = 0.004;

/** The same pose drawn twice, with another pose between, differs by no more. */
const SAME = 0.0005;

/** The last clip of the server's folder, when another one of it is open. */
const LAST_CLIP = [130, 289];

/** Where the messages over the view come up, in the laptop's window. */
const MESSAGES = { x: 380, y: 44, width: 560, height: 70 };

const GOLDEN = fileURLToPath(new URL("golden/wave_front.png", import.meta.url));

let site;
before(async () => {
  site = await serve();
});
after(() => site?.stop());

test("a browser was found", () => {
  assert.ok(BROWSERS.length > 0, "install chromium or firefox-esr");
});

for (const browser of BROWSERS) {
  describe(browser.name, () => {
    let desk;
    before(async () => {
      desk = await Desk.open(browser, site.address);
    });
    after(() => desk?.close());

    test("a figure moves without anything being done", async (t) => {
      const took = await desk.figureMoves();
      t.diagnostic(`a moving figure after ${(took / 1000).toFixed(2)} s, in a browser just started`);
      await desk.show("first");
    });

    test("space stops it and starts it", async () => {
      await desk.press("Space");
      const stopped = await desk.still();
      await sleep(600);
      assert.equal(difference(stopped, await desk.figure()), 0);
      await desk.press("Space");
      await desk.until("the figure to move again", async () => difference(stopped, await desk.figure()) > OTHER);
    });

    test("the time line is scrubbed with the mouse", async () => {
      const start = await desk.pauseAtStart();
      const later = await desk.scrub(0.1, 0.33);
      await desk.show("scrubbed");
      assert.ok(difference(start, later) > OTHER, "another pose");
      const again = await desk.scrub(0.6, 0.33);
      assert.ok(difference(later, again) < SAME, "the same time, the same picture");
      await desk.press("Home");
      assert.ok(difference(start, await desk.still()) < SAME, "back at the start");
    });

    test("a clip of the server's list and the same file dropped give the same picture", async () => {
      const walk = `${site.address}?url=${encodeURIComponent("clips/a walk.bvh")}`;
      await desk.page.goto(walk);
      const walking = await atStartFromTheFront(desk);
      await desk.page.mouse.click(...LAST_CLIP);
      const clicked = await atStartFromTheFront(desk);
      await desk.show("clicked");
      await desk.page.goto(walk);
      await atStartFromTheFront(desk);
      await desk.drop(join(site.folder, "wave.bvh"));
      const dropped = await atStartFromTheFront(desk);
      await desk.show("dropped");
      assert.ok(difference(clicked, dropped) < SAME, "clicked and dropped");
      assert.ok(difference(walking, dropped) > OTHER, "another clip");
    });

    test("an address opens a clip, which looks as it always did", async () => {
      await desk.page.goto(`${site.address}?url=clips/wave.bvh`);
      let small = shrunk(await atStartFromTheFront(desk), 96);
      if (process.env.GOLDEN === "write") writeFileSync(GOLDEN, PNG.sync.write(small));
      const golden = PNG.sync.read(readFileSync(GOLDEN));
      // Where drawing takes long, the picture can stand still before the last key was taken.
      for (let tries = 0; tries < 20 && meanDifference(small, golden) >= 3; tries += 1) {
        small = shrunk(await desk.still(), 96);
      }
      const off = meanDifference(small, golden);
      if (off >= 3) await desk.show("off-the-kept-picture");
      assert.ok(off < 3, `off the kept picture by ${off.toFixed(2)} of 255`);
    });

    test("what is no motion is told, and the clip stays", async () => {
      const before = await desk.still(() => desk.whole());
      const jpeg = join(site.folder, "../photo.jpg");
      writeFileSync(jpeg, Buffer.from([0xff, 0xd8, 0xff, 0xe0, 0, 16, ...Buffer.from("JFIF"), 0, 1, 2, 3]));
      await desk.drop(jpeg);
      const after = await desk.until("a message", async () => {
        const now = await desk.whole();
        return difference(part(before, MESSAGES), part(now, MESSAGES)) > 0.05 && now;
      });
      await desk.show("refused");
      const figure = { x: 420, y: 200, width: 480, height: 400 };
      assert.ok(difference(part(before, figure), part(after, figure)) < SAME);
    });

    test("three files at once stand side by side", async () => {
      const one = await desk.figure();
      await desk.drop(...["a walk.bvh", "more/run.bvh", "wave.bvh"].map((name) => join(site.folder, name)));
      await desk.until("more to see", async () => difference(one, await desk.figure()) > OTHER);
      await sleep(1500);
      await desk.show("three");
    });

    test("an address of another origin and one that leads nowhere are told", async () => {
      for (const url of ["https://example.com/walk.bvh", "clips/gone.bvh"]) {
        await desk.page.goto(`${site.address}?url=${encodeURIComponent(url)}`);
        await desk.until("a message", async () => hasRed(await picture(desk.page, MESSAGES)));
        await desk.show(url.startsWith("https") ? "foreign" : "gone");
      }
      // The browser itself reports the file that is not there.
      desk.complaints = desk.complaints.filter((line) => !/404|gone\.bvh/.test(line));
    });

    test("the window may be resized while it plays, and every key pressed", async () => {
      await desk.page.goto(site.address);
      await desk.figureMoves();
      for (const [width, height] of [[700, 400], [1920, 1080], [360, 640], [1366, 768]]) {
        await desk.page.setViewport({ width, height, deviceScaleFactor: 1 });
        await sleep(250);
      }
      await pressEverything(desk);
      await desk.show("every-key");
      await desk.page.goto(site.address);
      await desk.figureMoves();
    });

    test("nothing was complained about in the console", () => {
      assert.deepEqual(desk.complaints, []);
    });
  });
}

const chromium = BROWSERS.find((browser) => browser.kind === "chromium");

test("what is saved arrives in the downloads", { skip: !chromium }, async () => {
  const desk = await Desk.open(chromium, `${site.address}?url=clips/wave.bvh`);
  const folder = mkdtempSync(join(tmpdir(), "posekit-downloads-"));
  try {
    const session = await desk.page.createCDPSession();
    await session.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: folder });
    await desk.figureMoves();
    await desk.pauseAtStart();
    const arrived = (end) => desk.until(end, async () => {
      const name = readdirSync(folder).find((name) => name.endsWith(end));
      return name && readFileSync(join(folder, name));
    });
    await desk.press("Control+s");
    const motion = await arrived(".bvh");
    assert.deepEqual(motion, readFileSync(join(site.folder, "wave.bvh")), "the whole range is the file");
    await desk.press("Control+Shift+s");
    const image = PNG.sync.read(await arrived(".png"));
    assert.deepEqual([image.width, image.height], [1920, 1080]);
    assert.ok(standingOut(image) > 0.01);
    // A short range, so that it is done soon.
    for (let step = 0; step < 4; step += 1) await desk.press("ArrowRight");
    await desk.press("o", "Control+e");
    await sleep(400);
    await desk.show("export");
    await clickExport(desk);
    const film = await arrived(".gif");
    assert.equal(film.subarray(0, 6).toString("latin1"), "GIF89a");
    assert.equal(film.at(-1), 0x3b, "a whole GIF");
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk.close();
    rmSync(folder, { recursive: true, force: true });
  }
});

test("a browser without graphics is told so", { skip: !WITHOUT_GRAPHICS }, async () => {
  const desk = await Desk.open(WITHOUT_GRAPHICS, site.address);
  try {
    const says = () => desk.page.$eval("#message", (message) => message.textContent);
    await desk.until("the message", async () => /neither WebGPU nor WebGL2/.test(await says()));
    await desk.show("no-graphics");
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk.close();
  }
});

/** The front view of the first frame, standing. */
async function atStartFromTheFront(desk) {
  await desk.figureMoves();
  await desk.press("Space", "Home", "1");
  return desk.still();
}

async function clickExport(desk) {
  await desk.page.mouse.click(528, 495);
}

/** A dot of the colour of failures. */
function hasRed(image) {
  let count = 0;
  for (let i = 0; i < image.data.length; i += 4) {
    const [r, g, b] = image.data.subarray(i, i + 3);
    if (r > 170 && g < 110 && b < 110) count += 1;
  }
  return count > 20;
}

/** All keys that write or move, alone and with each modifier, and no key that the browser itself takes. */
async function pressEverything(desk) {
  const keys = [
    ..."abcdefghijklmnopqrstuvwxyz0123456789[],.-=/?`;'", "Space", "Home", "End", "ArrowUp", "ArrowDown", "Escape", "Delete",
    "Tab", "Enter", "F2", "PageUp", "PageDown", "Escape"];
  for (const key of keys) await desk.press(key);
  for (const key of [..."abcdgjkmxz13579", "ArrowLeft", "ArrowRight", "Escape"]) {
    for (const held of ["Shift", "Alt"]) await desk.press(`${held}+${key}`);
  }
}
