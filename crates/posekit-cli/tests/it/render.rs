//! Pictures and films.

use std::fs;
use std::path::Path;

use crate::harness::{ARM, Folder, real_data};

fn bytes(folder: &Folder, name: &str) -> Vec<u8> {
    fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Width and height that a PNG's header says.
fn png_size(bytes: &[u8]) -> (u32, u32) {
    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"), "not a PNG");
    let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    (number(16), number(20))
}

/// The names of an MP4's boxes of the first level, in order.
fn mp4_boxes(bytes: &[u8]) -> Vec<String> {
    let mut names = Vec::new();
    let mut at = 0;
    while at + 8 <= bytes.len() {
        let size = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
        names.push(String::from_utf8_lossy(&bytes[at + 4..at + 8]).into_owned());
        at += (size as usize).max(8);
    }
    names
}

const CPU: [&str; 2] = ["--renderer", "cpu"];

fn render(folder: &Folder, args: &[&str]) -> String {
    let args: Vec<&str> = ["render"].iter().chain(args).chain(&CPU).copied().collect();
    let ran = folder.run(&args);
    assert_eq!(ran.code, Some(0), "{args:?}: {}", ran.stderr);
    assert_eq!(ran.stdout, "");
    ran.stderr
}

#[test]
fn a_picture_has_the_size_asked_for_and_is_said_with_its_renderer() {
    let folder = Folder::with_arm();
    let said = render(&folder, &["arm.bvh", "-o", "arm.png", "--size", "96x54"]);
    assert!(
        said.starts_with("note: wrote arm.png: 96x54\nnote: renderer: CPU, "),
        "{said}"
    );
    assert_eq!(png_size(&bytes(&folder, "arm.png")), (96, 54));
    let quiet = render(
        &folder,
        &["arm.bvh", "-o", "q.png", "--size", "9x9", "--quiet"],
    );
    assert_eq!(quiet, "");
}

#[test]
fn the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::with_arm();
    for (name, extra) in [
        ("a.png", &["--size", "160x90"][..]),
        ("a.gif", &["--size", "64x36"]),
        ("a.apng", &["--size", "64x36", "--transparent"]),
    ] {
        let mut results = Vec::new();
        for jobs in ["1", "3"] {
            let args = [&["arm.bvh", "-o", name, "-j", jobs], extra].concat();
            render(&folder, &args);
            results.push(bytes(&folder, name));
        }
        assert!(results[0] == results[1], "{name}");
    }
}

#[test]
fn options_change_the_picture() {
    let folder = Folder::with_arm();
    let mut seen: Vec<(String, Vec<u8>)> = Vec::new();
    for extra in [
        &[][..],
        &["--camera", "top"],
        &["--camera", "-40,20"],
        &["--style", "bones"],
        &["--style", "octahedra"],
        &["--style", "lines"],
        &["--style", "axes"],
        &["--theme", "dark"],
        &["--labels"],
        &["--labels=elbow"],
        &["--ghosts", "1"],
        &["--trails", "elbow"],
        &["--frames", "2"],
        &["--rest"],
        &["--overlay", "sample:arm"],
        &["--beside", "arm.bvh"],
        &["--unit", "cm"],
        &["--transparent"],
    ] {
        let args = [&["arm.bvh", "-o", "x.png", "--size", "160x120"], extra].concat();
        render(&folder, &args);
        let picture = bytes(&folder, "x.png");
        if let Some((other, _)) = seen.iter().find(|(_, old)| *old == picture) {
            panic!("{extra:?} drew the same as {other}");
        }
        seen.push((format!("{extra:?}"), picture));
    }
}

#[test]
fn a_contact_sheet_is_a_row_and_numbered_pictures_are_files() {
    let folder = Folder::with_arm();
    render(
        &folder,
        &[
            "arm.bvh",
            "-o",
            "sheet.png",
            "--contact-sheet",
            "3",
            "--size",
            "40x50",
        ],
    );
    assert_eq!(png_size(&bytes(&folder, "sheet.png")), (120, 50));
    let said = render(
        &folder,
        &["arm.bvh", "-o", "f/{stem}_##.png", "--size", "16x16"],
    );
    assert!(said.contains("3 pictures of 16x16"), "{said}");
    assert_eq!(
        folder.names(),
        [
            "arm.bvh",
            "f/arm_00.png",
            "f/arm_01.png",
            "f/arm_02.png",
            "sheet.png"
        ]
    );
}

#[cfg(feature = "h264")]
#[test]
fn a_film_starts_with_its_index_and_a_folder_becomes_films() {
    let folder = Folder::with_arm();
    folder.write("in/a.bvh", ARM);
    folder.write("in/sub/b.bvh", ARM);
    let args = ["arm.bvh", "-o", "arm.mp4", "--size", "63x36", "--fps", "10"];
    let said = render(&folder, &args);
    assert!(said.contains("sides of .mp4 are even"), "{said}");
    assert!(
        said.contains("wrote arm.mp4: 11 frames, 64x36, 10 frames/s, 1.1 s"),
        "{said}"
    );
    let boxes = mp4_boxes(&bytes(&folder, "arm.mp4"));
    assert_eq!(boxes, ["ftyp", "moov", "mdat"]);
    let said = render(&folder, &["in", "-o", "films", "--size", "32x32"]);
    assert!(said.contains("wrote 2 files to films"), "{said}");
    for name in ["films/a.mp4", "films/sub/b.mp4"] {
        assert_eq!(mp4_boxes(&bytes(&folder, name))[0], "ftyp");
    }
}

#[test]
fn standard_output_gets_the_bytes_and_nothing_else() {
    let folder = Folder::with_arm();
    let mut command = folder.command();
    let args = [
        "render", "arm.bvh", "-o", "-", "--format", "gif", "--size", "24x24",
    ];
    let output = command.args(args).args(CPU).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stdout.starts_with(b"GIF89a"));
    assert!(output.stdout.ends_with(b";"));
}

#[test]
fn what_makes_no_sense_is_refused_before_anything_is_drawn() {
    let folder = Folder::with_arm();
    for (args, wanted) in [
        (&["-o", "x.avi"][..], "no format writes .avi"),
        (&["-o", "-"], "give --format"),
        (&["-o", "x.png", "--size", "0x9"], "from 1 to 16384"),
        (&["-o", "x.png", "--size", "big"], "write it like 1280x720"),
        (&["-o", "x.png", "--camera", "moon"], "three-quarter"),
        (&["-o", "x.gif", "--transparent"], "name it .png or .apng"),
        (&["-o", "x.gif", "--contact-sheet", "2"], "name it .png"),
        (&["-o", "x.gif", "--fps", "0"], "not a frame rate"),
        (&["-o", "x.gif", "--fps", "nan"], "not a frame rate"),
        (&["-o", "x.png", "--ghosts", "0"], "not in"),
        (
            &["-o", "x.png", "--overlay", "a", "--beside", "b"],
            "cannot be used with",
        ),
        (&["-o", "x_#.png", "--contact-sheet", "2"], "one picture"),
    ] {
        let args = [&["render", "arm.bvh"], args].concat();
        let error = folder.fail(2, &args);
        assert!(error.contains(wanted), "{args:?}: {error}");
    }
    for (args, wanted) in [
        (&["-o", "x.png", "--frames", "0..2"][..], "--contact-sheet"),
        (&["-o", "x.png", "--frames", "9"], "past the end"),
        (
            &["-o", "x.png", "--trails", "Elbow"],
            "did you mean 'elbow'",
        ),
        (
            &["-o", "x.png", "--overlay", "gone.bvh"],
            "gone.bvh: no such file",
        ),
        (
            &[
                "-o",
                "x.png",
                "--overlay",
                "sample:walk",
                "--trails",
                "elbow",
            ],
            "'elbow'",
        ),
    ] {
        let args = [&["render", "arm.bvh"], args, &CPU].concat();
        let error = folder.fail(1, &args);
        assert!(error.contains(wanted), "{args:?}: {error}");
    }
    assert_eq!(folder.names(), ["arm.bvh"]);
}

#[test]
fn without_frames_the_rest_pose_is_drawn_and_said() {
    let folder = Folder::with_arm();
    let head = ARM.split("Frames:").next().unwrap();
    folder.write("still.bvh", format!("{head}Frames: 0\nFrame Time: 0.1\n"));
    let said = render(&folder, &["still.bvh", "-o", "a.png", "--size", "20x20"]);
    assert!(said.contains("rest pose"), "{said}");
    assert_eq!(png_size(&bytes(&folder, "a.png")), (20, 20));
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_the_old_film_and_no_other_file() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    let folder = Folder::with_arm();
    folder.write("out.gif", "old");
    let mut command = folder.command();
    // Thousands of frames: more than the time to the interrupt draws.
    command.args(["render", "sample:arm", "-o", "out.gif", "--fps", "50"]);
    command.args(["--size", "1280x720"]).args(CPU);
    let mut child = command.stderr(Stdio::null()).spawn().unwrap();
    let deadline = Instant::now() + Duration::from_secs(120);
    while !folder
        .names()
        .iter()
        .any(|name| name.starts_with(".posekit-"))
    {
        assert!(Instant::now() < deadline, "no temporary file appeared");
        assert!(
            child.try_wait().unwrap().is_none(),
            "done before the interrupt"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.names(), ["arm.bvh", "out.gif"]);
    assert_eq!(folder.read("out.gif"), "old");
}

#[test]
fn without_a_display_posekit_alone_makes_a_film_under_a_free_name() {
    let folder = Folder::with_arm();
    let extension = if cfg!(feature = "h264") { "mp4" } else { "gif" };
    let taken = format!("walk.{extension}");
    folder.write(&taken, "mine");
    let mut command = folder.command();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    if !cfg!(all(unix, not(target_vendor = "apple"))) {
        return; // There a window would open.
    }
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(
        said.contains(&format!("wrote walk-2.{extension}: ")),
        "{said}"
    );
    assert_eq!(folder.read(&taken), "mine");
    assert!(bytes(&folder, &format!("walk-2.{extension}")).len() > 1000);
}

#[cfg(all(feature = "window", unix, not(target_vendor = "apple")))]
#[test]
fn without_a_display_view_says_what_to_do() {
    let folder = Folder::with_arm();
    let mut command = folder.command();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let output = command.args(["view", "arm.bvh"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("no display") && said.contains("posekit render"),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn every_real_skeleton_is_drawn() {
    let Some(data) = real_data() else { return };
    let folder = Folder::with_arm();
    for (file, stem) in one_of_each_kind(&data) {
        let name = format!("{stem}.png");
        render(
            &folder,
            &[&file, "-o", &name, "--size", "80x60", "--style", "bones"],
        );
        let picture = bytes(&folder, &name);
        assert_eq!(png_size(&picture), (80, 60));
        // An empty room packs into a few hundred bytes.
        assert!(picture.len() > 1500, "{file}: {} bytes", picture.len());
    }
}

/// The first .bvh file of every folder of the real data, and all that lie at its top.
fn one_of_each_kind(data: &Path) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut folders = vec![data.to_owned()];
    while let Some(folder) = folders.pop() {
        let mut here: Vec<_> = fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        here.sort();
        folders.extend(here.iter().filter(|path| path.is_dir()).cloned());
        let first = here
            .into_iter()
            .find(|path| path.extension().is_some_and(|kind| kind == "bvh"));
        files.extend(first);
    }
    files
        .into_iter()
        .enumerate()
        .map(|(index, path)| (path.to_str().unwrap().to_owned(), format!("{index}")))
        .collect()
}
