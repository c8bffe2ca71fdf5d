//! What a command reads is not overwritten, whatever the names, and two results do not go to one place.
//!
//! `options.txt` lists every option that takes a value, and whether it names something to read or to write; the
//! command's own tests hold it against the command line. Here every pair of a thing that a command reads and a thing
//! that it writes is brought to one place.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::harness::{ARM, Folder};

/// All options with their roles.
const OPTIONS: &str = include_str!("options.txt");

/// A scene that plays `in.bvh` on its own skeleton.
const SCENE: &str = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nframes_per_sec = 2\n\
                     [skeleton]\nfile = \"in.bvh\"\n[[motion]]\nfile = \"in.bvh\"\n";

/// Something that a command reads.
struct Read {
    command: &'static str,
    option: &'static str,
    /// The file that must stay as it is; `{in}` in the arguments.
    file: &'static str,
    text: &'static str,
    /// The command line without its outputs.
    args: &'static str,
}

/// Something that a command writes.
struct Write {
    command: &'static str,
    option: &'static str,
    /// Appended to the command line; `{out}` is the file's name without its extension.
    args: &'static str,
    /// What the file's name ends in.
    extension: &'static str,
}

const LIMITS: &str = "{\"elbow\": {\"fixed\": true}}";
const PATH: &str = "10,22,30\n";

const fn read(
    command: &'static str,
    option: &'static str,
    (file, text): (&'static str, &'static str),
    args: &'static str,
) -> Read {
    Read {
        command,
        option,
        file,
        text,
        args,
    }
}

const fn write(
    command: &'static str,
    option: &'static str,
    args: &'static str,
    extension: &'static str,
) -> Write {
    Write {
        command,
        option,
        args,
        extension,
    }
}

const MOTION: (&str, &str) = ("in.bvh", ARM);

/// Everything that a command which writes reads.
const READS: &[Read] = &[
    read("convert", "IN", MOTION, "convert {in}"),
    read(
        "convert",
        "--reorder-like",
        MOTION,
        "convert arm.bvh --reorder-like {in}",
    ),
    read("fix", "FILE", MOTION, "fix {in}"),
    read("fk", "FILE", MOTION, "fk {in}"),
    read(
        "ik",
        "FILE",
        MOTION,
        "ik {in} --end elbow_end --offset 0,0,0",
    ),
    read(
        "ik",
        "--follow",
        MOTION,
        "ik arm.bvh --end elbow_end --follow {in}:elbow",
    ),
    read(
        "ik",
        "--path",
        ("in.csv", PATH),
        "ik arm.bvh --end elbow_end --path {in}",
    ),
    read(
        "ik",
        "--limits",
        ("in.json", LIMITS),
        "ik arm.bvh --end elbow_end --offset 0,0,0 --limits {in}",
    ),
    read(
        "ik-study",
        "FILE",
        MOTION,
        "ik-study {in} --chain base:elbow_end --target 10,22,30 --grid 0 --random 0 --unreachable 0 --iterations 1",
    ),
    read(
        "render",
        "FILE",
        MOTION,
        "render {in} --size 16x16 --renderer cpu",
    ),
    read(
        "render",
        "--overlay",
        MOTION,
        "render arm.bvh --overlay {in} --size 16x16 --renderer cpu",
    ),
    read(
        "render",
        "--beside",
        MOTION,
        "render arm.bvh --beside {in} --size 16x16 --renderer cpu",
    ),
    read("keys reduce", "FILE", MOTION, "keys reduce {in}"),
    read(
        "keys bake",
        "SCENE",
        ("in.posekit.toml", BAKED),
        "keys bake {in}",
    ),
    read(
        "inbetween",
        "FILE",
        MOTION,
        "inbetween {in} --keep 2 --method slerp",
    ),
];

/// A scene without other files.
const BAKED: &str = "format = \"posekit scene\"\nversion = 1\nrange_secs = [0, 1]\nframes_per_sec = 2\n\
                     [skeleton]\njoints = [ { name = \"a\", translation = [0, 0, 0] }, \
                     { name = \"b\", parent = \"a\", translation = [0, 1, 0], end_site = true } ]\n";

/// Everything that is written by a command which reads.
const WRITES: &[Write] = &[
    write("convert", "--output", "{out}.bvh", "bvh"),
    write("convert", "--output", "-o {out}.bvh", "bvh"),
    write("fix", "--output", "-o {out}.bvh", "bvh"),
    write("fk", "--output", "-o {out}.npz", "npz"),
    write("fk", "--output", "-o {out}.csv", "csv"),
    write("ik", "--output", "-o {out}.bvh", "bvh"),
    write("ik", "--trace", "--trace {out}.json", "json"),
    write("ik", "--trace", "--trace {out}.csv", "csv"),
    write("ik-study", "--output", "-o {out}.html", "html"),
    write("ik-study", "--output", "-o {out}.html", "csv"),
    write("ik-study", "--output", "-o {out}.html", "md"),
    write("ik-study", "--output", "-o {out}.html", "bvh"),
    write("render", "--output", "-o {out}.png", "png"),
    write("render", "--output", "-o {out}.gif", "gif"),
    write(
        "keys reduce",
        "--output",
        "-o {out}.posekit.toml",
        "posekit.toml",
    ),
    write("keys bake", "--output", "-o {out}.bvh", "bvh"),
    write("inbetween", "--output", "-o {out}.bvh", "bvh"),
    write("inbetween", "--report", "--report={out}", "html"),
    write("inbetween", "--report", "--report={out}", "md"),
    write("inbetween", "--report", "--report={out}", "csv"),
];

/// The options of a role, each with its command.
fn options(role: &str) -> BTreeSet<(&'static str, &'static str)> {
    let rows = OPTIONS.lines().filter(|line| !line.starts_with('#'));
    rows.filter_map(|line| {
        let (command, rest) = line.split_once(" | ")?;
        let (option, it) = rest.split_once(" | ")?;
        (it == role).then_some((command, option))
    })
    .collect()
}

#[test]
fn every_option_that_names_a_file_is_tried() {
    let writes: BTreeSet<_> = WRITES.iter().map(|it| (it.command, it.option)).collect();
    let reads: BTreeSet<_> = READS.iter().map(|it| (it.command, it.option)).collect();
    let made = options("makes");
    let writing: BTreeSet<&str> = options("writes")
        .iter()
        .map(|(command, _)| *command)
        .collect();
    let wanted = options("reads")
        .into_iter()
        .filter(|(command, _)| writing.contains(command));
    assert_eq!(reads, wanted.collect::<BTreeSet<_>>(), "what is read");
    assert_eq!(writes, options("writes"), "what is written");
    // Commands that write and read nothing.
    assert_eq!(made, [("man", "--out-dir"), ("sample", "--output")].into());
}

/// The words of a command line.
fn words(args: &str) -> Vec<&str> {
    args.split(' ').collect()
}

/// How the place of a result comes to be that of a file which is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// By a folder that is not there.
    Spelled,
    #[cfg(unix)]
    Link,
    #[cfg(unix)]
    HardLink,
}

#[cfg(unix)]
const WAYS: &[Way] = &[Way::Spelled, Way::Link, Way::HardLink];
#[cfg(not(unix))]
const WAYS: &[Way] = &[Way::Spelled];

/// The name of a result, without its extension, that is in the place of `file`; `None` where the way does not lead
/// there.
fn name_of(way: Way, folder: &Path, file: &str, extension: &str) -> Option<String> {
    match way {
        Way::Spelled => {
            let stem = file.strip_suffix(extension)?.strip_suffix('.')?;
            Some(format!("nosuch/../{stem}"))
        }
        #[cfg(unix)]
        Way::Link => {
            std::os::unix::fs::symlink(file, folder.join(format!("out.{extension}"))).unwrap();
            Some("out".to_owned())
        }
        #[cfg(unix)]
        Way::HardLink => {
            let name = folder.join(format!("out.{extension}"));
            fs::hard_link(folder.join(file), name).unwrap();
            Some("out".to_owned())
        }
    }
}

/// The files of a read, and the scene or the glTF that lead to them.
fn folder_of(read: &Read) -> Folder {
    let folder = Folder::with_arm();
    folder.write(read.file, read.text);
    folder.write("shot.posekit.toml", SCENE);
    folder
}

fn refused(folder: &Folder, args: &str, protected: &str) {
    let before = fs::read(folder.path().join(protected)).unwrap();
    let names = folder.names();
    let ran = folder.run(&words(args));
    assert_eq!(ran.code, Some(2), "{args}: {}{}", ran.stdout, ran.stderr);
    assert!(
        ran.stderr.contains("would be overwritten") && ran.stderr.contains(protected),
        "{args}: {}",
        ran.stderr
    );
    let after = fs::read(folder.path().join(protected)).unwrap();
    assert_eq!(after, before, "{args}");
    assert_eq!(folder.names(), names, "{args}");
}

#[test]
fn nothing_that_is_read_is_overwritten() {
    let mut pairs = 0;
    for read in READS {
        for write in WRITES.iter().filter(|write| write.command == read.command) {
            for &way in WAYS {
                let folder = folder_of(read);
                let Some(out) = name_of(way, folder.path(), read.file, write.extension) else {
                    continue;
                };
                let args = format!("{} {}", read.args, write.args);
                let args = args.replace("{in}", read.file).replace("{out}", &out);
                refused(&folder, &args, read.file);
                pairs += 1;
            }
        }
    }
    assert!(pairs > 30, "{pairs}");
}

#[cfg(unix)]
#[test]
fn nothing_that_a_scene_names_is_overwritten() {
    for read in READS
        .iter()
        .filter(|read| read.file == MOTION.0 && read.option != "SCENE")
    {
        let writes = WRITES.iter().filter(|write| write.command == read.command);
        for write in writes {
            let folder = folder_of(read);
            let out = name_of(Way::HardLink, folder.path(), read.file, write.extension).unwrap();
            let args = format!("{} {}", read.args, write.args);
            let args = args
                .replace("{in}", "shot.posekit.toml")
                .replace("{out}", &out);
            refused(&folder, &args, "in.bvh");
        }
    }
    let folder = folder_of(&READS[0]);
    refused(&folder, "keys bake shot.posekit.toml -o in.bvh", "in.bvh");
}

#[test]
fn elsewhere_each_of_them_is_written() {
    for read in READS {
        for write in WRITES.iter().filter(|write| write.command == read.command) {
            let folder = folder_of(read);
            let args = format!("{} {}", read.args, write.args);
            let args = args
                .replace("{in}", read.file)
                .replace("{out}", "elsewhere");
            folder.succeed(&words(&args));
            let name = format!("elsewhere.{}", write.extension);
            assert!(folder.exists(&name), "{args}: {:?}", folder.names());
        }
    }
}

#[cfg(unix)]
#[test]
fn two_results_do_not_go_to_one_place() {
    let mut pairs = 0;
    for read in READS {
        let of_command: Vec<&Write> = WRITES
            .iter()
            .filter(|write| write.command == read.command)
            .collect();
        for (index, first) in of_command.iter().enumerate() {
            for second in &of_command[index + 1..] {
                if first.extension == second.extension
                    || first.option == second.option && first.args != second.args
                {
                    continue;
                }
                let folder = folder_of(read);
                // The second's name leads to the first's, which is not there yet.
                let link = folder.path().join(format!("out.{}", second.extension));
                std::os::unix::fs::symlink(format!("out.{}", first.extension), link).unwrap();
                let both = match first.args == second.args {
                    true => first.args.to_owned(),
                    false => format!("{} {}", first.args, second.args),
                };
                let args = format!("{} {both}", read.args);
                let args = args.replace("{in}", read.file).replace("{out}", "out");
                let error = folder.fail(2, &words(&args));
                assert!(
                    error.contains("would both be written to"),
                    "{args}: {error}"
                );
                assert!(!folder.exists("out.bvh"), "{args}");
                pairs += 1;
            }
        }
    }
    assert!(pairs > 10, "{pairs}");
}

#[test]
fn a_buffer_beside_a_gltf_is_read_too() {
    let folder = Folder::with_arm();
    // A joint that turns once: one second, two keys.
    let values: [f32; 10] = [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0];
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    folder.write("rig.bvh", &bytes);
    folder.write(
        "rig.gltf",
        r#"{"asset": {"version": "2.0"}, "nodes": [{"name": "a", "children": [1]}, {"name": "b", "translation": [0, 1, 0]}],
            "skins": [{"joints": [0, 1]}], "buffers": [{"uri": "rig.bvh", "byteLength": 40}],
            "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 32}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                          {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC4"}],
            "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                            "samplers": [{"input": 0, "output": 1}]}]}"#,
    );
    folder.write("shot.posekit.toml", SCENE.replace("in.bvh", "rig.gltf"));
    for args in [
        "convert shot.posekit.toml rig.bvh",
        "keys bake shot.posekit.toml -o rig.bvh",
    ] {
        let error = folder.fail(2, &words(args));
        assert!(
            error.contains("rig.bvh") && error.contains("overwritten"),
            "{args}: {error}"
        );
        assert_eq!(
            fs::read(folder.path().join("rig.bvh")).unwrap(),
            bytes,
            "{args}"
        );
    }
    folder.succeed(&words("convert shot.posekit.toml out.bvh"));
}

#[test]
fn what_a_later_input_names_is_safe_from_the_result_of_an_earlier_one() {
    let folder = Folder::with_arm();
    folder.write("out/arm.bvh", ARM);
    let scene = SCENE.replace("in.bvh", "out/arm.bvh");
    folder.write("shot.posekit.toml", scene);
    let error = folder.fail(2, &["convert", "arm.bvh", "shot.posekit.toml", "-o", "out"]);
    assert!(error.contains("would be overwritten"), "{error}");
    assert_eq!(folder.read("out/arm.bvh"), ARM);
}

#[test]
fn a_protected_file_stays_as_it_is() {
    let folder = Folder::with_arm();
    for (name, args) in [
        ("out.bvh", "convert arm.bvh out.bvh"),
        ("out.csv", "fk arm.bvh -o out.csv"),
        (
            "out.json",
            "ik arm.bvh --end elbow_end --offset 0,0,0 --trace out.json",
        ),
        (
            "p_1.png",
            "render arm.bvh -o p_#.png --size 16x16 --renderer cpu",
        ),
    ] {
        folder.write(name, "mine");
        let path = folder.path().join(name);
        let mut permissions = fs::metadata(&path).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let error = folder.fail(1, &words(args));
        assert!(
            error.contains(&format!("{name}: is write-protected")),
            "{args}: {error}"
        );
        assert_eq!(folder.read(name), "mine");
    }
}

#[cfg(unix)]
#[test]
fn standard_streams_are_files_too() {
    use std::fs::File;
    let folder = Folder::with_arm();
    let stdin = || File::open(folder.path().join("arm.bvh")).unwrap();
    let mut command = folder.command();
    let output = command
        .args(["convert", "-", "arm.bvh"])
        .stdin(stdin())
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(
        error.contains("arm.bvh is the same file as standard input"),
        "{error}"
    );
    let appended = File::options()
        .append(true)
        .open(folder.path().join("arm.bvh"))
        .unwrap();
    let mut command = folder.command();
    let output = command
        .args(["convert", "arm.bvh", "-"])
        .stdout(appended)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(folder.read("arm.bvh"), ARM);
}

#[cfg(unix)]
#[test]
fn a_link_as_the_output_stays_a_link() {
    let folder = Folder::with_arm();
    for (link, leads_to) in [("new.bvh", "later/real.bvh"), ("old.bvh", "kept.bvh")] {
        folder.write("kept.bvh", "old");
        let path = folder.path().join(link);
        std::os::unix::fs::symlink(leads_to, &path).unwrap();
        folder.succeed(&["convert", "arm.bvh", link]);
        assert!(fs::symlink_metadata(&path).unwrap().is_symlink(), "{link}");
        assert!(folder.read(leads_to).starts_with("HIERARCHY"), "{link}");
    }
}

/// Whoever adds a way to read or write files takes the door.
#[test]
fn files_are_read_and_written_at_one_door() {
    let mut pending = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("src")];
    while let Some(path) = pending.pop() {
        if path.is_dir() {
            let entries = fs::read_dir(&path).unwrap();
            pending.extend(entries.map(|entry| entry.unwrap().path()));
            continue;
        }
        let name = path.to_string_lossy().replace('\\', "/");
        // The server gives out what lies in its folder and writes nothing.
        let is_door = ["src/bytes.rs", "/output/guard.rs", "/output/whole.rs"];
        if is_door.iter().any(|door| name.ends_with(door))
            || name.contains("/serve/")
            || !name.ends_with(".rs")
        {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let code = text.split("#[cfg(test)]").next().unwrap();
        for word in [
            "fs::read(",
            "read_to_string(",
            "File::open",
            "fs::write(",
            "File::create",
            "io::stdin()",
            "fs::rename",
            "fs::copy",
        ] {
            // The window is told of a file that is not there before it opens.
            let is_known = name.ends_with("/command/view.rs") && word == "File::open";
            assert!(is_known || !code.contains(word), "{name}: {word}");
        }
    }
}
