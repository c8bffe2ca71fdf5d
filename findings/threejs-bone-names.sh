#!/usr/bin/env bash
# three.js 0.187: a bone whose name ends in `.bones`, `.map` or `.material` is read by BVHLoader and given a track,
# and stands still when the clip plays: the mixer takes the end of the name for an object inside the bone. It says so
# only on the console. A full stop elsewhere in a name, as in `hand.L`, does no harm.
#
# Needs Node.js with npm. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund three@0.187.0 >/dev/null
cat > play.mjs <<'JS'
import { AnimationMixer } from 'three';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';

const text = (name) => `HIERARCHY
ROOT Hips
{
	OFFSET 0 0 0
	CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
	JOINT ${name}
	{
		OFFSET 0 1 0
		CHANNELS 3 Zrotation Xrotation Yrotation
		End Site
		{
			OFFSET 0 1 0
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.5
0 0 0 0 0 0 90 0 0
0 0 0 0 0 0 90 0 0
`;
console.error = console.warn = () => {};
const turned = (name) => {
  const { clip, skeleton } = new BVHLoader().parse(text(name));
  const [root, bone] = skeleton.bones;
  const mixer = new AnimationMixer(root);
  mixer.clipAction(clip).play();
  mixer.update(0.1);
  return Math.abs(bone.quaternion.z) > 0.5;
};
let asSaid = true;
for (const [name, turns] of [['hand', true], ['hand.L', true], ['hand.bones', false], ['hand.map', false], ['hand.material', false]]) {
  const found = turned(name);
  console.log(`${name}: ${found ? 'turns by 90 degrees' : 'stands still'}`);
  asSaid &&= found === turns;
}
process.exit(asSaid ? 0 : 1);
JS
node play.mjs
