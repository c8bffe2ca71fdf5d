// One page in one browser, used as people use it: looked at, clicked, dropped on.

import { basename } from "node:path";
import { readFileSync } from "node:fs";

import { launch } from "./browsers.mjs";
import { difference, part, picture, standingOut } from "./picture.mjs";

/** A laptop's window. */
export const WINDOW = { width: 1366, height: 768, deviceScaleFactor: 1 };

/** Where, in that window, the figure is and nothing else. */
export const FIGURE = { x: 420, y: 130, width: 480, height: 500 };

/** The time line's left and right end and its height in the window. */
export const TIME_LINE = { left: 10, right: 1356, y: 714 };

/** Software draws a few frames a second; a busy machine one in some seconds. */
const PATIENCE_MS = 90_000;

const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

export class Desk {
  /** Opens an address in a browser of its own. */
  static async open(browser, address, { window = WINDOW, dark = false } = {}) {
    const running = await launch(browser, { defaultViewport: window });
    const page = await running.newPage();
    const desk = new Desk(browser, running, page);
    page.on("console", (line) => desk.listen(line));
    page.on("pageerror", (error) => desk.complaints.push(String(error?.stack ?? error)));
    await page.setViewport(window);
    if (dark) await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
    desk.opened = performance.now();
    await page.goto(address, { waitUntil: "load", timeout: PATIENCE_MS });
    return desk;
  }

  constructor(browser, running, page) {
    Object.assign(this, { browser, running, page, complaints: [], opened: 0 });
  }

  listen(line) {
    if (!["error", "assert"].includes(line.type())) return;
    const { url, lineNumber } = line.location();
    this.complaints.push(`${line.text()} (${url ?? ""}:${lineNumber ?? ""})`);
    // An error object says what it is only when it is asked.
    for (const value of line.args()) {
      value.evaluate((error) => String(error?.stack ?? error)).then((text) => this.complaints.push(text), () => {});
    }
  }

  close() {
    return this.running.close();
  }

  /** The middle of the view. */
  figure() {
    return picture(this.page, FIGURE);
  }

  /** Waits until `test` holds; `what` is what was waited for. */
  async until(what, test) {
    const end = performance.now() + PATIENCE_MS;
    while (performance.now() < end) {
      const found = await test();
      if (found) return found;
      await sleep(60);
    }
    throw new Error(`${this.browser.name}: waited in vain for ${what}; ${this.complaints.join("; ")}`);
  }

  /** Waits until a figure is seen, and gives its picture. */
  figureSeen() {
    return this.until("a figure", async () => {
      const seen = await this.figure();
      return standingOut(seen) > 0.01 && seen;
    });
  }

  /** Waits until the figure has moved; milliseconds since the address was opened. */
  async figureMoves() {
    let before = await this.figureSeen();
    return this.until("the figure to move", async () => {
      const now = await this.figure();
      const moved = difference(before, now) > 0.003;
      before = now;
      return moved && performance.now() - this.opened;
    });
  }

  /** Waits until the picture stands still, and gives it. */
  async still(get = () => this.figure()) {
    let before = await get();
    let same = 0;
    return this.until("the picture to stand still", async () => {
      await sleep(250);
      const now = await get();
      same = difference(before, now) === 0 ? same + 1 : 0;
      before = now;
      return same >= 2 && now;
    });
  }

  /** Presses keys one after the other: "Space", "Control+s". */
  async press(...keys) {
    for (const key of keys) {
      const held = key.split("+");
      const last = held.pop();
      for (const name of held) await this.page.keyboard.down(name);
      // One of the two protocols knows the bar by its character only.
      await this.page.keyboard.press(last === "Space" ? " " : last);
      for (const name of held.reverse()) await this.page.keyboard.up(name);
      await sleep(30);
    }
  }

  /** Pauses at the first frame, and gives the picture of it. */
  async pauseAtStart() {
    await this.press("Space", "Home");
    return this.still();
  }

  /** Presses the mouse on the time line at one share of it and lets go at another. */
  async scrub(from, to) {
    const x = (share) => TIME_LINE.left + share * (TIME_LINE.right - TIME_LINE.left);
    const { mouse } = this.page;
    await mouse.move(x(from), TIME_LINE.y);
    await mouse.down();
    for (let step = 1; step <= 4; step += 1) {
      await mouse.move(x(from + ((to - from) * step) / 4), TIME_LINE.y);
      await sleep(60);
    }
    await mouse.up();
    return this.still();
  }

  /** Drops files on the view. */
  async drop(...paths) {
    if (this.browser.kind === "chromium") return this.dragIn(paths);
    const files = paths.map((path) => ({ name: basename(path), bytes: readFileSync(path).toString("base64") }));
    await this.page.evaluate(synthesizeDrop, files);
  }

  /** As the mouse of a file manager does it; only Chromium's protocol has this. */
  async dragIn(files) {
    const session = await this.page.createCDPSession();
    const data = { items: [], files, dragOperationsMask: 1 };
    const place = { x: FIGURE.x + FIGURE.width / 2, y: FIGURE.y + FIGURE.height / 2 };
    for (const type of ["dragEnter", "dragOver", "drop"]) {
      await session.send("Input.dispatchDragEvent", { type, ...place, data });
      await sleep(60);
    }
    await session.detach();
  }

  /** Saves what is seen, to be looked at, where SEEN names a folder. */
  async show(name) {
    if (!process.env.SEEN) return;
    const file = `${process.env.SEEN}/${this.browser.name.replace(/[^a-z0-9]+/gi, "-")}-${name}.png`;
    await this.page.screenshot({ path: file });
  }

  async whole() {
    return picture(this.page);
  }
}

/** Runs in the page. */
function synthesizeDrop(files) {
  const transfer = new DataTransfer();
  for (const { name, bytes } of files) {
    const binary = Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0));
    transfer.items.add(new File([binary], name));
  }
  const canvas = document.getElementById("view");
  const place = { clientX: innerWidth / 2, clientY: innerHeight / 2, bubbles: true, cancelable: true };
  for (const type of ["dragenter", "dragover", "drop"]) {
    canvas.dispatchEvent(new DragEvent(type, { ...place, dataTransfer: transfer }));
  }
}

export { difference, part, sleep };
