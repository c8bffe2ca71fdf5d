"""Renders a BVH file to a film with Blender's Workbench engine, to have something to compare posekit's films with.

    xvfb-run -a blender --background --factory-startup --python tools/film_blender.py -- walk.bvh out.mp4 [FRAMES]

Workbench is Blender's fast engine, that of its viewport; even in the background it draws with OpenGL and needs a display,
be it a virtual one. Each bone gets a tapered cylinder, which is less than the body posekit draws; there is a ground, and
shadows and anti-aliasing are Workbench's own. With FRAMES only as many are drawn. Prints the seconds, and the
processor's seconds, from the first frame to the end of the file.
"""

import sys
import time

import bpy

WIDTH, HEIGHT = 1280, 720


def give_bones_a_shape(armature):
    """Hangs a cylinder on each bone, a tenth as thick as the bone is long."""
    for bone in armature.data.bones:
        length = max(bone.length, 1e-6)
        bpy.ops.mesh.primitive_cone_add(vertices=16, radius1=0.10 * length, radius2=0.05 * length, depth=length)
        shape = bpy.context.object
        shape.parent, shape.parent_type, shape.parent_bone = armature, "BONE", bone.name
        # A bone points along its own Y and its children hang at its tail; a cone stands along Z.
        shape.rotation_euler = (-1.5707963, 0.0, 0.0)
        shape.location = (0.0, -0.5 * length, 0.0)


def place_camera(scene, armature):
    """Puts the camera where it sees the whole motion from three quarters."""
    lows, highs = [1e30] * 3, [-1e30] * 3
    for frame in range(scene.frame_start, scene.frame_end + 1, 10):
        scene.frame_set(frame)
        for bone in armature.pose.bones:
            point = armature.matrix_world @ bone.head
            for axis in range(3):
                lows[axis], highs[axis] = min(lows[axis], point[axis]), max(highs[axis], point[axis])
    middle = [(low + high) / 2 for low, high in zip(lows, highs)]
    size = max(high - low for low, high in zip(lows, highs))
    camera_data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", camera_data)
    scene.collection.objects.link(camera)
    camera.location = (middle[0] + 1.6 * size, middle[1] - 1.6 * size, middle[2] + 0.6 * size)
    target = bpy.data.objects.new("target", None)
    target.location = middle
    scene.collection.objects.link(target)
    look = camera.constraints.new("TRACK_TO")
    look.target = target
    camera_data.clip_end = 100 * size
    scene.camera = camera
    bpy.ops.mesh.primitive_plane_add(size=6 * size, location=(middle[0], middle[1], lows[2]))


def mend_importer():
    """Debian's Blender 3.4 opens files in a mode that its Python 3.11 no longer has."""
    from io_anim_bvh import import_bvh

    import_bvh.open = lambda path, mode: open(path, mode.replace("U", ""))


def main(source, output, most_frames=None):
    mend_importer()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=source, update_scene_fps=True, update_scene_duration=True)
    armature = bpy.context.object
    scene = bpy.context.scene
    scene.frame_start = 1
    give_bones_a_shape(armature)
    place_camera(scene, armature)
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.show_shadows = True
    scene.display.render_aa = "5"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.render.image_settings.file_format = "FFMPEG"
    scene.render.ffmpeg.format = "MPEG4"
    scene.render.ffmpeg.codec = "H264"
    scene.render.filepath = output
    if most_frames is not None:
        scene.frame_end = min(scene.frame_end, int(most_frames))
    frames = scene.frame_end - scene.frame_start + 1
    start, start_cpu = time.monotonic(), time.process_time()
    bpy.ops.render.render(animation=True)
    seconds, cpu_seconds = time.monotonic() - start, time.process_time() - start_cpu
    print(f"{frames} frames in {seconds:.2f} s: {frames / seconds:.2f} frames/s, {cpu_seconds / frames:.3f} s of CPU a frame")


main(*sys.argv[sys.argv.index("--") + 1 :])
