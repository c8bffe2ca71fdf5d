#!/usr/bin/env bash
# Babylon.js 9.28.0 reads a BVH file mirrored unless the scene was made right-handed before. BVH is right-handed, a
# Babylon scene left-handed by default, and its BVH loader takes offsets, positions and angles over as they are. (The
# glTF loader of the same package turns its files into the scene's handedness, so one expects the same here.)
# Seen from the front, a figure that faces the camera has its left arm on the picture's left, as in a mirror, and so
# does the motion: who steps with the left foot steps with the right. `scene.useRightHandedSystem = true` mends it.
#
# Needs Node.js 20 with npm. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init -y >/dev/null
npm install --silent --no-audit --no-fund --ignore-scripts @babylonjs/core@9.28.0 @babylonjs/loaders@9.28.0
cat > front.mjs <<'JS'
import { FreeCamera, ImportMeshAsync, Matrix, NullEngine, Scene, Vector3 } from '@babylonjs/core';
import '@babylonjs/loaders/BVH/index.js';

// Y up, looking along +Z: the left arm of such a figure is at +X.
const bvh = `HIERARCHY
ROOT Hips
{
  OFFSET 0 1 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftArm
  {
    OFFSET 0.5 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0.5 0 0
    }
  }
}
MOTION
Frames: 1
Frame Time: 0.04
0 1 0 0 0 0 0 0 0
`;
// Where the left arm is in the picture of a camera in front of the figure that looks back at it.
const side = async (rightHanded) => {
  const engine = new NullEngine({ renderWidth: 200, renderHeight: 200 });
  const scene = new Scene(engine);
  scene.useRightHandedSystem = rightHanded;
  const camera = new FreeCamera('camera', new Vector3(0, 1, 5), scene);
  camera.setTarget(new Vector3(0, 1, 0));
  const { skeletons } = await ImportMeshAsync(`data:${bvh}`, scene, { pluginExtension: '.bvh' });
  skeletons[0].computeAbsoluteMatrices(true);
  scene.render();
  const arm = skeletons[0].bones.find((bone) => bone.name === 'LeftArm').getAbsolutePosition();
  const viewport = camera.viewport.toGlobal(200, 200);
  const { x } = Vector3.Project(arm, Matrix.Identity(), scene.getTransformMatrix(), viewport);
  return x > 100 ? 'right' : 'left';
};
const plain = await side(false);
const rightHanded = await side(true);
console.log(`the left arm of a figure that faces the camera: ${plain} in the picture (it should be right)`);
console.log(`with useRightHandedSystem: ${rightHanded}`);
process.exit(plain === 'left' && rightHanded === 'right' ? 0 : 1);
JS
node front.mjs
