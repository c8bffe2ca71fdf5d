// Pictures of the page, looked at as pixels.

import { PNG } from "pngjs";

/** A difference of a colour channel that an eye sees. */
const SEEN = 24;

/** A screenshot of the page or of a part of it, `{ x, y, width, height }`. */
export async function picture(page, part) {
  // Beyond the window there is nothing, and looking there would resize the page.
  const bytes = await page.screenshot({ type: "png", captureBeyondViewport: false, ...(part && { clip: part }) });
  return PNG.sync.read(Buffer.from(bytes));
}

/** The share of pixels that differ so that an eye sees it. */
export function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  let count = 0;
  for (let i = 0; i < a.data.length; i += 4) if (differs(a.data, i, b.data, i)) count += 1;
  return (4 * count) / a.data.length;
}

function differs(a, i, b, j) {
  return [0, 1, 2].some((c) => Math.abs(a[i + c] - b[j + c]) > SEEN);
}

/** The share of pixels that stand out from the left end of their own row: a figure before an even ground. */
export function standingOut(image) {
  let count = 0;
  for (let y = 0; y < image.height; y += 1) {
    const start = 4 * y * image.width;
    for (let x = 1; x < image.width; x += 1) if (differs(image.data, start + 4 * x, image.data, start)) count += 1;
  }
  return count / (image.width * image.height);
}

/** The part of a picture, as a picture. */
export function part(image, { x, y, width, height }) {
  const cut = new PNG({ width, height });
  PNG.bitblt(image, cut, x, y, width, height, 0, 0);
  return cut;
}

/** A picture of at most `width` pixels across, each the mean of those that it stands for. */
export function shrunk(image, width) {
  const factor = Math.ceil(image.width / width);
  const small = new PNG({ width: Math.floor(image.width / factor), height: Math.floor(image.height / factor) });
  for (let y = 0; y < small.height; y += 1) {
    for (let x = 0; x < small.width; x += 1) {
      for (let c = 0; c < 4; c += 1) {
        let sum = 0;
        for (let v = 0; v < factor; v += 1) {
          for (let u = 0; u < factor; u += 1) sum += image.data[4 * ((y * factor + v) * image.width + x * factor + u) + c];
        }
        small.data[4 * (y * small.width + x) + c] = Math.round(sum / factor ** 2);
      }
    }
  }
  return small;
}

/** The mean difference of two pictures' channels, 0 to 255. */
export function meanDifference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 255;
  let sum = 0;
  for (let i = 0; i < a.data.length; i += 1) sum += Math.abs(a.data[i] - b.data[i]);
  return (4 / 3) * (sum / a.data.length);
}
