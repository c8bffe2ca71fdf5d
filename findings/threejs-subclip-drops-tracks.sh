#!/usr/bin/env bash
# AnimationUtils.subclip of three.js 0.187 keeps only keys that lie inside the range: it adds none at its ends.
# A joint whose keys lie outside (one key before, one after, turning all the time between) loses its track and falls back
# to the rest pose, and all times are moved so that the first key left is at 0, so that a range of 1 s of a sparsely keyed
# clip comes out shorter and starts too early. Clips with a key in every frame come out right, which hides it; clips keyed
# by hand, reduced, or optimised on export do not.
#
# Needs Node.js 20 with npm. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --ignore-scripts three@0.187.0
cat > cut.mjs <<'JS'
import { AnimationClip, AnimationUtils, NumberKeyframeTrack } from 'three';

// The arm goes from 0 to 90 in two seconds with a key at each end; the head has three keys of its own.
const clip = new AnimationClip('nod', -1, [
  new NumberKeyframeTrack('arm.angle', [0, 2], [0, 90]),
  new NumberKeyframeTrack('head.angle', [0, 0.875, 2], [0, 10, 0]),
]);
const cut = AnimationUtils.subclip(clip, 'middle', 12, 36, 24); // 0.5 s to 1.5 s
const tracks = cut.tracks.map((track) => `${track.name} keyed at ${[...track.times].join(', ')} s`);
console.log(`0.5 s to 1.5 s of the clip: ${cut.duration} s long; ${tracks.join('; ')}`);
console.log('expected: 1 s long; arm.angle from 22.5 to 67.5; head.angle with its key at 0.375 s');
const asSaid = cut.duration === 0 && tracks.length === 1 && tracks[0] === 'head.angle keyed at 0 s';
process.exit(asSaid ? 0 : 1);
JS
node cut.mjs
