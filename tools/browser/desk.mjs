// One page in one browser, used as people use it: looked at, clicked, dropped on.
//
// The page says what it shows (`docs/viewer.md`, "What the page says of itself"). Whatever is done is
// waited for there, and pixels are compared after that, again and again until they are right or the
// patience ends: nothing here depends on how fast the machine is.

import { basename } from "node:path";
import { readFileSync } from "node:fs";

import { PATIENCE_MS, launch } from "./browsers.mjs";
import { difference, picture, standingOut } from "./picture.mjs";

/** A laptop's window. */
export const WINDOW = { width: 1366, height: 768, deviceScaleFactor: 1 };

/** Where, in that window, the figure is and nothing else. */
export const FIGURE = { x: 420, y: 130, width: 480, height: 500 };

/** Between two looks at something that is waited for. */
const BETWEEN_LOOKS_MS = 50;

/** THROTTLE=6 makes Chromium's pages six times slower, to try what a slow machine does. */
const THROTTLE = Number(process.env.THROTTLE ?? 1);

export class Desk {
  /** Opens an address in a browser of its own. */
  static async open(browser, address, { window = WINDOW, dark = false } = {}) {
    const running = await launch(browser, { defaultViewport: window });
    const page = await running.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    const desk = new Desk(browser, running, page);
    page.on("console", (line) => desk.listen(line));
    page.on("requestfailed", (request) => desk.failed(request));
    page.on("pageerror", (error) => desk.complaints.push(String(error?.stack ?? error)));
    await page.setViewport(window);
    if (dark) await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
    if (THROTTLE > 1 && browser.kind === "chromium") await page.emulateCPUThrottling(THROTTLE);
    desk.opened = performance.now();
    await desk.goto(address);
    return desk;
  }

  constructor(browser, running, page) {
    Object.assign(this, { browser, running, page, complaints: [], opened: 0, isLeaving: false });
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

  /** Requests that were begun and given up show red in a browser's tools, but for those of a page that was left. */
  failed(request) {
    if (this.isLeaving) return;
    this.complaints.push(`${request.failure()?.errorText}: ${request.url()}`);
  }

  close() {
    this.isLeaving = true;
    return this.running.close();
  }

  /** Goes to an address. */
  async goto(address) {
    this.isLeaving = true;
    await this.page.goto(address, { waitUntil: "load" });
    this.isLeaving = false;
  }

  /** Waits until `test` holds, and gives what it gave; `what` is what was waited for. */
  async until(what, test) {
    const end = performance.now() + PATIENCE_MS;
    let found = await test();
    while (!found) {
      if (performance.now() > end) await this.giveUp(what);
      await new Promise((done) => setTimeout(done, BETWEEN_LOOKS_MS));
      found = await test();
    }
    return found;
  }

  async giveUp(what) {
    await this.show("waited-in-vain");
    const says = JSON.stringify(await this.state());
    throw new Error(`${this.browser.name}: waited in vain for ${what}; the page says ${says}; ${this.complaints.join("; ")}`);
  }

  /** What the page says it shows; nothing before it has started. */
  state() {
    return this.page.$eval("#view", (canvas) => ({ ...canvas.dataset }));
  }

  /** Waits until the page says all of this and shows it, and gives what it says. */
  becomes(wanted) {
    return this.until(JSON.stringify(wanted), async () => {
      const state = await this.state();
      const holds = Object.entries(wanted).every(([name, value]) => state[name] === String(value));
      return holds && state.drawn === "true" && state;
    });
  }

  /** Does something after which the window is drawn once more, and waits for that. */
  async drawnAfter(act) {
    const before = Number((await this.state()).pictures);
    await act();
    await this.until("another picture", async () => Number((await this.state()).pictures) > before);
  }

  /** A picture of what the page says it shows. */
  async settled(get = () => this.figure()) {
    await this.becomes({ playing: false, working: false });
    await this.onScreen();
    return get();
  }

  /** Waits until what the page has drawn is on the screen. */
  async onScreen() {
    // The first of the two draws, the second begins when that is done.
    await this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  /** The middle of the view. */
  figure() {
    return picture(this.page, FIGURE);
  }

  /** The whole window. */
  whole() {
    return picture(this.page);
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
    await this.becomes({ playing: true });
    const before = await this.figureSeen();
    await this.differs(before, 0.003);
    return performance.now() - this.opened;
  }

  /** Waits until the view differs by more than that from a picture. */
  differs(from, share) {
    return this.until(`a view that differs by more than ${share}`, async () => difference(from, await this.figure()) > share);
  }

  /** Waits until the view differs by less than that from a picture. */
  equals(one, share) {
    return this.until(`a view that differs by less than ${share}`, async () => difference(one, await this.figure()) < share);
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
    }
  }

  /** Stops at the first frame, once everything is there, and gives the picture of it. */
  async pauseAtStart() {
    await this.becomes({ playing: true, working: false });
    await this.press("Space");
    await this.becomes({ playing: false });
    await this.press("Home");
    await this.becomes({ frame: 0 });
    return this.settled();
  }

  /** Presses the mouse on the time line at one frame and lets go at another; the picture of that one. */
  async scrub(from, to) {
    const state = await this.state();
    const [left, top, right, bottom] = state.timeLinePlace.split(" ").map(Number);
    const x = (frame) => left + (frame / Number(state.lastFrame)) * (right - left);
    const y = (top + bottom) / 2;
    const { mouse } = this.page;
    await mouse.move(x(from), y);
    await mouse.down();
    await this.becomes({ playing: false, frame: from });
    for (let step = 1; step <= 4; step += 1) await mouse.move(x(from + ((to - from) * step) / 4), y);
    await this.becomes({ frame: to });
    await mouse.up();
    return this.settled();
  }

  /** Where messages come up: a strip along the bottom of the view. */
  async messagePlace() {
    const [left, , right, bottom] = (await this.state()).viewPlace.split(" ").map(Number);
    return { x: left + 20, y: bottom - 130, width: right - left - 40, height: 130 };
  }

  /**
   * Waits until a failure is told in these words, and until `test` holds of the picture of the place where it
   * is. Messages go after a while: where looking takes longer than that, `again` makes it come once more.
   */
  async failureTold(words, again, test) {
    await this.until(`a failure with ${words}`, async () => {
      const { notice, noticeKind } = await this.state();
      return noticeKind === "failure" && words.test(notice);
    });
    const place = await this.messagePlace();
    await this.until("the message to be seen", async () => {
      if (Number((await this.state()).notices) === 0) await again();
      return test(await picture(this.page, place));
    });
  }

  /** The middle of a part of the window that the page says the place of, moved by some of its heights. */
  async middleOf(name, heights = 0) {
    const [left, top, right, bottom] = (await this.state())[name].split(" ").map(Number);
    return [(left + right) / 2, (top + bottom) / 2 + heights * (bottom - top)];
  }

  /** Has the browser save into a folder. What comes back says how many files arrived whole. */
  async saveInto(folder) {
    const session = await this.page.createCDPSession();
    let complete = 0;
    session.on("Browser.downloadProgress", ({ state }) => {
      if (state === "completed") complete += 1;
    });
    const behavior = { behavior: "allow", downloadPath: folder, eventsEnabled: true };
    await session.send("Browser.setDownloadBehavior", behavior);
    return () => complete;
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
    }
    await session.detach();
  }

  /** Saves what is seen, to be looked at, where SEEN names a folder. */
  async show(name) {
    if (!process.env.SEEN) return;
    const file = `${process.env.SEEN}/${this.browser.name.replace(/[^a-z0-9]+/gi, "-")}-${name}.png`;
    await this.page.screenshot({ path: file, captureBeyondViewport: false });
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
