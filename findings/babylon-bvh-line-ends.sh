#!/usr/bin/env bash
# Babylon.js 9.28.0 refuses every BVH file with Windows line ends. What follows the first line is trimmed line by line,
# but the test of the first line is for HIERARCHY exactly, and a carriage return (or a blank) behind it fails it.
# Most motion-capture programs write BVH on Windows. The error says that a header is missing, which it is not.
#
# Needs Node.js 20 with npm. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --ignore-scripts @babylonjs/core@9.28.0 @babylonjs/loaders@9.28.0
cat > lines.mjs <<'JS'
import { ImportMeshAsync, NullEngine, Scene } from '@babylonjs/core';
import '@babylonjs/loaders/BVH/index.js';

const lines = [
  'HIERARCHY', 'ROOT Hips', '{', 'OFFSET 0 1 0', 'CHANNELS 3 Zrotation Xrotation Yrotation',
  'End Site', '{', 'OFFSET 0 1 0', '}', '}', 'MOTION', 'Frames: 1', 'Frame Time: 0.04', '10 20 30', '',
];
const read = async (text) => {
  const scene = new Scene(new NullEngine());
  try {
    const { skeletons } = await ImportMeshAsync(`data:${text}`, scene, { pluginExtension: '.bvh' });
    return `${skeletons[0].bones.length} bones`;
  } catch (error) {
    const message = String(error?.message ?? error);
    return message.includes('expects HIERARCHY header') ? 'refused: BVH loader expects HIERARCHY header' : message;
  }
};
const unix = await read(lines.join('\n'));
const windows = await read(lines.join('\r\n'));
const onlyLater = await read(lines.join('\r\n').replace('HIERARCHY\r', 'HIERARCHY'));
console.log(`line feeds: ${unix}`);
console.log(`carriage returns and line feeds: ${windows}`);
console.log(`the same but for the first line: ${onlyLater}`);
process.exit(unix === '2 bones' && windows.startsWith('refused') && onlyLater === '2 bones' ? 0 : 1);
JS
node lines.mjs
