// The viewer as a web page, in every browser that is here: opened, dropped on, scrubbed, played, saved.
// What was done is waited for in what the page says of itself; what is asked then is asked of pixels.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { mkdtempSync, rmSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";

import { PNG } from "pngjs";

import { BROWSERS, WITHOUT_GRAPHICS } from "./browsers.mjs";
import { Desk, WINDOW } from "./desk.mjs";
import { difference, meanDifference, part, shrunk, standingOut } from "./picture.mjs";
import { POSEKIT, serve } from "./site.mjs";

/** Two pictures of different poses or figures differ by this much of the view at least. */
const OTHER = 0.004;

/** The same pose drawn twice, with another pose between, differs by no more. */
const SAME = 0.0005;

/** Off the kept picture by more than this mean of 255, it is another picture. */
const OFF = 3;

/** Where the camera is when it looks from the front: degrees about the figure and above the horizon. */
const FROM_THE_FRONT = "0 3";

/** Where the buttons of listed files are, and the second of them when another clip is open. */
const LISTED = { download: 232, text: 206, second: 289 };

/** The one listed clip that is in no further folder, when another one is open. */
const LISTED_CLIP = [130, 235];

/** Where a clip's scene is begun over its motion, and where one that was not saved is opened again. */
const OVER_THE_MOTION = [112, 571];
const OPEN_AGAIN = [535, 428];

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
      await desk.becomes({ playing: true, working: false });
      await desk.press("Space");
      const { frame } = await desk.becomes({ playing: false });
      const stopped = await desk.settled();
      for (const x of [1, 2, 3]) {
        // A pointer that moves has the window drawn again; a clock that ran would go on.
        await desk.drawnAfter(() => desk.page.mouse.move(x, 1));
      }
      await desk.becomes({ playing: false, frame });
      await desk.equals(stopped, SAME);
      await desk.press("Space");
      await desk.becomes({ playing: true });
      await desk.differs(stopped, OTHER);
    });

    test("the time line is scrubbed with the mouse", async () => {
      const start = await desk.pauseAtStart();
      const last = Number((await desk.state()).lastFrame);
      const [tenth, third, beyond] = [0.1, 0.33, 0.6].map((share) => Math.round(share * last));
      const later = await desk.scrub(tenth, third);
      await desk.show("scrubbed");
      assert.ok(difference(start, later) > OTHER, "another pose");
      await desk.scrub(beyond, third);
      await desk.equals(later, SAME);
      await desk.press("Home");
      await desk.becomes({ frame: 0 });
      await desk.equals(start, SAME);
    });

    test("a clip of the server's list and the same file dropped give the same picture", async () => {
      const walk = `${site.address}?url=${encodeURIComponent("clips/a walk.bvh")}`;
      await desk.goto(walk);
      const walking = await atStartFromTheFront(desk, "a walk.bvh");
      await desk.page.mouse.click(...LISTED_CLIP);
      const clicked = await atStartFromTheFront(desk, "wave.bvh");
      await desk.show("clicked");
      await desk.goto(walk);
      await atStartFromTheFront(desk, "a walk.bvh");
      await desk.drop(join(site.folder, "wave.bvh"));
      await atStartFromTheFront(desk, "wave.bvh");
      await desk.show("dropped");
      await desk.equals(clicked, SAME);
      await desk.differs(walking, OTHER);
    });

    test("an address opens a clip, which looks as it always did", async () => {
      await desk.goto(`${site.address}?url=clips/wave.bvh`);
      const seen = await atStartFromTheFront(desk, "wave.bvh");
      if (process.env.GOLDEN === "write") writeFileSync(GOLDEN, PNG.sync.write(shrunk(seen, 96)));
      await desk.show("golden");
      const golden = PNG.sync.read(readFileSync(GOLDEN));
      await desk.until(`a picture off the kept one by less than ${OFF} of 255`, async () => {
        return meanDifference(shrunk(await desk.figure(), 96), golden) < OFF;
      });
    });

    test("what is no motion is told, and the clip stays", async () => {
      await desk.goto(`${site.address}?url=clips/wave.bvh`);
      await atStartFromTheFront(desk, "wave.bvh");
      const before = await desk.whole();
      const jpeg = join(site.folder, "../photo.jpg");
      writeFileSync(jpeg, Buffer.from([0xff, 0xd8, 0xff, 0xe0, 0, 16, ...Buffer.from("JFIF"), 0, 1, 2, 3]));
      assert.ok(!hasRed(part(before, await desk.messagePlace())), "no message yet");
      const drop = () => desk.drop(jpeg);
      await drop();
      await desk.failureTold(/^photo\.jpg/, drop, hasRed);
      await desk.show("refused");
      await desk.becomes({ clip: "wave.bvh", frame: 0, shown: 1 });
      const above = { x: 420, y: 140, width: 480, height: 380 };
      await desk.until("the clip as it was", async () => {
        return difference(part(before, above), part(await desk.whole(), above)) < SAME;
      });
    });

    test("three files at once stand side by side", async () => {
      const one = await desk.figure();
      await desk.drop(...["a walk.bvh", "more/run.bvh", "wave.bvh"].map((name) => join(site.folder, name)));
      await desk.becomes({ shown: 3, working: false });
      await desk.differs(one, OTHER);
      await desk.show("three");
    });

    test("an address of another origin and one that leads nowhere are told", async () => {
      const refused = [
        ["https://example.com/walk.bvh", /own origin/, "foreign"],
        ["clips/gone.bvh", /no such file/, "gone"],
      ];
      for (const [url, words, name] of refused) {
        const go = () => desk.goto(`${site.address}?url=${encodeURIComponent(url)}`);
        await go();
        await desk.failureTold(words, go, hasRed);
        await desk.show(name);
      }
      // The browser itself reports the file that is not there.
      desk.complaints = desk.complaints.filter((line) => !/404|gone\.bvh/.test(line));
    });

    test("the window may be resized while it plays, and every key pressed", async () => {
      await desk.goto(site.address);
      await desk.figureMoves();
      for (const [width, height] of [[700, 400], [1920, 1080], [360, 640], [1366, 768]]) {
        await desk.page.setViewport({ width, height, deviceScaleFactor: 1 });
        await fills(desk, width, height);
      }
      await pressEverything(desk);
      await desk.show("every-key");
      await desk.goto(site.address);
      await desk.becomes({ working: false });
      await desk.figureSeen();
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
    const complete = await desk.saveInto(folder);
    const arrived = async (count, end) => {
      await desk.becomes({ saved: count });
      await desk.until(`${count} files in the downloads`, () => complete() === count);
      const name = readdirSync(folder).find((name) => name.endsWith(end));
      assert.ok(name, `no file ${end} among ${readdirSync(folder)}`);
      return readFileSync(join(folder, name));
    };
    await desk.pauseAtStart();
    await desk.press("Control+s");
    const motion = await arrived(1, ".bvh");
    assert.deepEqual(motion, readFileSync(join(site.folder, "wave.bvh")), "the whole range is the file");
    await desk.press("Control+Shift+s");
    const image = PNG.sync.read(await arrived(2, ".png"));
    assert.deepEqual([image.width, image.height], [1920, 1080]);
    assert.ok(standingOut(image) > 0.01);
    // A short range, so that it is done soon.
    for (const frame of [1, 2, 3, 4]) {
      await desk.press("ArrowRight");
      await desk.becomes({ frame });
    }
    await desk.press("o");
    await desk.becomes({ range: "0 4" });
    await desk.press("Control+e");
    await desk.becomes({ export: "choosing" });
    await desk.show("export");
    await desk.press("Enter");
    const film = await arrived(3, ".gif");
    assert.equal(film.subarray(0, 6).toString("latin1"), "GIF89a");
    assert.equal(film.at(-1), 0x3b, "a whole GIF");
    await desk.becomes({ export: "closed" });
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk.close();
    rmSync(folder, { recursive: true, force: true });
  }
});

test("a listed file is saved as it is, and its text shown beside the figure", { skip: !chromium }, async () => {
  const own = await serve();
  const folder = mkdtempSync(join(tmpdir(), "posekit-listed-"));
  // A name that needs care in addresses, headers and pages, and a file that nobody would write back as it is.
  const name = `zz d\u00e9fil\u00e9 "1" & 100% #2.bvh`;
  const bytes = Buffer.from(readFileSync(join(own.folder, "wave.bvh"), "latin1").replace("MOTION", "# by hand\nMOTION").replaceAll("\n", "\r\n"), "latin1");
  writeFileSync(join(own.folder, name), bytes);
  let desk;
  try {
    let list;
    do {
      list = await (await fetch(`${own.address}clips.json`)).json();
    } while (!list.clips.some((clip) => clip.name === name));
    desk = await Desk.open(chromium, `${own.address}?url=clips/wave.bvh`);
    const complete = await desk.saveInto(folder);
    await desk.pauseAtStart();
    await desk.page.mouse.click(LISTED.download, LISTED.second);
    await desk.until("the file in the downloads", () => complete() === 1);
    const saved = readdirSync(folder);
    assert.equal(saved.length, 1);
    // Chromium writes no quotes into names of files.
    assert.equal(saved[0].replaceAll("_", '"'), name);
    assert.deepEqual(readFileSync(join(folder, saved[0])), bytes, "every byte");

    await desk.page.mouse.move(LISTED.download - 60, LISTED.second);
    await desk.settled(() => desk.whole());
    await desk.show("listed");
    await desk.page.mouse.click(LISTED.text, LISTED.second);
    await desk.becomes({ clip: name, working: false });
    const lines = bytes.toString("latin1").split("\r\n");
    const first = lines.findIndex((line) => line.startsWith("Frame Time")) + 2;
    const atLine = (line) => ({ text: `${line} of ${lines.length}` });
    await desk.pauseAtStart();
    await desk.becomes(atLine(first));
    await desk.page.mouse.click(...(await desk.middleOf("textRowPlace", 2)));
    await desk.becomes({ frame: 2, ...atLine(first + 2) });
    // A joint in the tree: its columns are further to the right.
    const before = await desk.settled(() => desk.whole());
    await desk.page.mouse.click(90, 591);
    const place = (await desk.state()).textPlace.split(" ").map(Number);
    const linesSeen = { x: place[0], y: place[1], width: place[2] - place[0], height: place[3] - place[1] };
    await desk.until("other columns of the text", async () => {
      return difference(part(before, linesSeen), part(await desk.whole(), linesSeen)) > 0.01;
    });
    await desk.settled(() => desk.whole());
    await desk.show("text");
    await desk.press("Space");
    await desk.becomes({ playing: true });
    await desk.until("a row further down", async () => Number((await desk.state()).text.split(" ")[0]) > first + 10);
    await desk.show("text-playing");
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk?.close();
    own.stop();
    rmSync(folder, { recursive: true, force: true });
  }
});

test("only pages that were named show the viewer in a frame", { skip: !chromium }, async () => {
  const host = createServer((request, response) => {
    response.setHeader("content-type", "text/html");
    response.end(`<!doctype html><iframe src="${request.url.slice(1)}" width="1000" height="600"></iframe>`);
  });
  await new Promise((done) => host.listen(0, "127.0.0.1", done));
  const origin = `http://127.0.0.1:${host.address().port}`;
  const own = await serve(["--embed", origin]);
  let desk;
  try {
    desk = await Desk.open(chromium, `${origin}/${own.address}`);
    const playing = async () => {
      const frame = desk.page.frames().find((frame) => frame.url() === own.address);
      return frame?.$eval("#view", (canvas) => canvas.dataset.playing === "true").catch(() => false);
    };
    await desk.until("the viewer in the frame", playing);
    await desk.show("framed");
    assert.deepEqual(desk.complaints, []);
    await desk.goto(`${origin}/${site.address}`);
    await desk.until("the refusal", () => desk.complaints.some((line) => /frame-ancestors|ERR_BLOCKED_BY_RESPONSE/.test(line)));
  } finally {
    await desk?.close();
    own.stop();
    host.close();
  }
});

test("a scene is dropped, animated and saved, and the labs are there", { skip: !chromium }, async () => {
  const desk = await Desk.open(chromium, site.address);
  const folder = mkdtempSync(join(tmpdir(), "posekit-scene-"));
  try {
    const downloads = join(folder, "downloads");
    const complete = await desk.saveInto(downloads);
    const name = "shot.posekit.toml";
    const scene = join(folder, name);
    execFileSync(POSEKIT, ["keys", "reduce", "sample:walk", "-o", scene, "--quiet"]);
    await desk.becomes({ playing: true, working: false });
    await desk.drop(scene);
    await desk.becomes({ clip: name, working: false });
    await desk.press("a");
    await desk.becomes({ mode: "Animate" });
    await desk.settled(() => desk.whole());
    await desk.show("animate");
    await desk.press("Control+s");
    await desk.becomes({ saved: 1 });
    await desk.until("the scene in the downloads", () => complete() === 1);
    assert.deepEqual(readFileSync(join(downloads, name)), readFileSync(scene), "what was read is what is saved");
    for (const [key, mode] of [["Shift+b", "Interpolation lab"], ["b", "Arm lab"], ["q", "View"]]) {
      await desk.press(key);
      await desk.becomes({ mode });
      await desk.settled(() => desk.whole());
      await desk.show(mode.toLowerCase().replace(" ", "-"));
    }
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk.close();
    rmSync(folder, { recursive: true, force: true });
  }
});

test("a scene that was not saved comes back with its motion, and not in another tab", { skip: !chromium }, async () => {
  const desk = await Desk.open(chromium, `${site.address}?url=${encodeURIComponent("clips/a walk.bvh")}`);
  try {
    const scene = "a_walk.posekit.toml";
    await desk.pauseAtStart();
    await desk.press("a");
    await desk.becomes({ mode: "Animate", working: false });
    await desk.settled(() => desk.whole());
    await desk.page.mouse.click(...OVER_THE_MOTION);
    await desk.becomes({ clip: scene, working: false });
    await desk.press("Shift+i");
    const kept = await desk.until("the scene to be kept aside", () =>
      desk.page.evaluate(() => Object.entries(localStorage).find(([key]) => key.startsWith("posekit kept "))?.[1]));
    assert.match(kept, /^file = "a walk\.bvh"$/m, "the motion is called as its file is");

    // In another tab nothing is asked: keys do what they do.
    const tab = new Desk(chromium, desk.running, await desk.running.newPage());
    await tab.page.setViewport(WINDOW);
    await tab.goto(`${site.address}?url=clips/wave.bvh`);
    await tab.becomes({ clip: "wave.bvh", working: false });
    await tab.press("a");
    await tab.becomes({ mode: "Animate" });
    await tab.page.close();
    await desk.page.bringToFront();

    let asked = 0;
    desk.page.on("dialog", async (dialog) => {
      asked += 1;
      await dialog.accept();
    });
    await desk.goto(`${site.address}?url=clips/wave.bvh`);
    assert.equal(asked, 1, "the page is not left without a question");
    await desk.becomes({ clip: "wave.bvh", working: false });
    await desk.show("kept");
    await desk.until("the scene to be open again", async () => {
      await desk.page.mouse.click(...OPEN_AGAIN);
      return (await desk.state()).clip === scene;
    });
    await desk.becomes({ lastFrame: 260, working: false });
    await desk.show("open-again");
    assert.deepEqual(desk.complaints, []);
  } finally {
    await desk.close();
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

/** The front view of the first frame of a clip that plays, standing. */
async function atStartFromTheFront(desk, clip) {
  await desk.becomes({ clip, playing: true, working: false });
  await desk.pauseAtStart();
  await desk.press("1");
  await desk.becomes({ camera: FROM_THE_FRONT });
  return desk.settled();
}

/** Waits until the canvas has a size, the time line goes across it, and the view has room above that. */
async function fills(desk, width, height) {
  const size = () => desk.page.$eval("#view", (canvas) => [canvas.width, canvas.height].join());
  await desk.until(`everything in its place in ${width} by ${height}`, async () => {
    const state = await desk.state();
    const [view, line] = [state.viewPlace, state.timeLinePlace].map((place) => place.split(" ").map(Number));
    const isAcross = line[0] < 40 && line[2] > width - 40 && line[2] <= width && line[3] <= height;
    const hasRoom = view[0] < view[2] && view[1] < view[3] && view[2] <= width && view[3] <= line[1];
    return isAcross && hasRoom && (await size()) === `${width},${height}`;
  });
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
  const held = [..."abcdgjkmxz13579", "ArrowLeft", "ArrowRight", "Escape"];
  const all = [...keys, ...held.flatMap((key) => [`Shift+${key}`, `Alt+${key}`])];
  // A few at a time, as quick fingers press them.
  for (let first = 0; first < all.length; first += 4) {
    await desk.drawnAfter(() => desk.press(...all.slice(first, first + 4)));
  }
}
