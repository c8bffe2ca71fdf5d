//! The list of the clips in a folder: what is in it, and how it is written.

use std::hash::{DefaultHasher, Hasher};
use std::path::Path;

use hyper::body::Bytes;
use serde_json::json;
use walkdir::{DirEntry, WalkDir};

use super::files;

/// Below this many folders nothing is looked for.
const DEEPEST: usize = 32;

/// How much is listed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Clips beyond this many are counted, not listed: a longer list is of no use to a page.
    pub(super) most_clips: usize,
    /// After this many names of files and folders the search ends.
    pub(super) most_names: usize,
}

/// The clips in a folder and below.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct List {
    /// What the folder is called.
    folder: String,
    clips: Vec<Clip>,
    /// How many more clips were seen than are listed.
    left_out: usize,
    /// Whether the search ended before everything was seen.
    ended_early: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Clip {
    /// The path below the folder, with slashes.
    name: String,
    bytes: u64,
}

/// A list as it is sent.
#[derive(Clone, Debug)]
pub(super) struct Written {
    /// For the page, and for programs.
    pub(super) json: Bytes,
    /// For people.
    pub(super) html: Bytes,
    /// What tells this list from others, for an `ETag`.
    pub(super) mark: String,
    /// What is not in the list, for people.
    pub(super) shortage: Option<String>,
}

impl List {
    /// Lists a folder, whose path is canonical. Folders come in the order of their names, and in them
    /// files.
    pub(super) fn of(root: &Path, extent: Extent) -> Self {
        let folder = root.file_name().unwrap_or(root.as_os_str());
        let mut list = Self {
            folder: folder.to_string_lossy().into_owned(),
            clips: Vec::new(),
            left_out: 0,
            ended_early: false,
        };
        // What is listed is given out: the same names, and for links the same question.
        let entries = WalkDir::new(root)
            .max_depth(DEEPEST)
            .sort_by_file_name()
            .into_iter()
            .filter_entry(|entry| {
                entry.depth() == 0 || entry.file_name().to_str().is_some_and(files::is_plain)
            });
        for (seen, entry) in entries.enumerate() {
            if seen >= extent.most_names {
                list.ended_early = true;
                break;
            }
            let Some(entry) = entry.ok().filter(|entry| files::is_clip(entry.path())) else {
                continue;
            };
            if list.clips.len() >= extent.most_clips {
                list.left_out += usize::from(!entry.file_type().is_dir());
            } else if let (Some(bytes), Some(name)) =
                (size_in_bytes(root, &entry), name_below(root, &entry))
            {
                list.clips.push(Clip { name, bytes });
            }
        }
        list
    }

    /// What is not in the list, for people; nothing if it is whole.
    fn shortage(&self) -> Option<String> {
        let listed = self.clips.len();
        match (self.left_out, self.ended_early) {
            (0, false) => None,
            (left_out, false) => Some(format!(
                "only the first {listed} of {} clips are listed",
                listed + left_out
            )),
            (_, true) => Some(format!(
                "only the first {listed} clips are listed: the folder was not searched completely"
            )),
        }
    }

    /// Writes it.
    pub(super) fn write(&self) -> Written {
        let shortage = self.shortage();
        let clips: Vec<_> = self.clips.iter().map(|clip| {
            json!({ "name": clip.name, "bytes": clip.bytes, "url": address_of(&clip.name) })
        }).collect();
        let mut json = json!({ "folder": self.folder, "clips": clips });
        if let Some(shortage) = &shortage {
            json["shortage"] = shortage.as_str().into();
        }
        let json = json.to_string();
        let mut hasher = DefaultHasher::new();
        hasher.write(json.as_bytes());
        Written {
            mark: format!("{:016x}", hasher.finish()),
            html: self.to_html(shortage.as_deref()).into(),
            json: json.into(),
            shortage,
        }
    }

    /// Every clip as a link that opens it in the viewer, one to its text, and one that downloads it.
    fn to_html(&self, shortage: Option<&str>) -> String {
        let mut page = String::from(
            "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Clips</title>\
             <meta name=\"color-scheme\" content=\"light dark\">\
             <style>body{font:16px/1.6 system-ui,sans-serif;margin:2rem}\
             td{padding-right:1.5rem}td.size{text-align:right}</style><h1>Clips</h1>",
        );
        if let Some(shortage) = shortage {
            page += &format!(
                "<p>{}; serve a subfolder to see the others.</p>",
                capitalized(&escaped(shortage))
            );
        }
        page += "<table>";
        for clip in &self.clips {
            let address = address_of(&clip.name);
            page += &format!(
                "<tr><td><a href=\"/?url={}\">{}</a><td class=\"size\">{}<td><a href=\"{address}\">text</a>\
                 <td><a href=\"{address}?download\" download>download</a>",
                files::encoded(&address),
                escaped(&clip.name),
                size_text(clip.bytes),
            );
        }
        page + "</table></html>\n"
    }
}

/// The size of the file that a clip's name stands for; nothing where it stands for something else.
fn size_in_bytes(root: &Path, entry: &DirEntry) -> Option<u64> {
    let kind = entry.file_type();
    if kind.is_symlink() {
        files::linked_clip_bytes(root, entry.path())
    } else if kind.is_file() {
        Some(entry.metadata().ok()?.len())
    } else {
        None
    }
}

/// A path below `root` with slashes.
fn name_below(root: &Path, entry: &DirEntry) -> Option<String> {
    let relative = entry.path().strip_prefix(root).ok()?;
    let names: Option<Vec<&str>> = relative.iter().map(|name| name.to_str()).collect();
    Some(names?.join("/"))
}

fn address_of(name: &str) -> String {
    format!("/clips/{}", files::encoded(name))
}

/// A size as people say it.
fn size_text(bytes: u64) -> String {
    match bytes {
        0..1_000 => format!("{bytes} B"),
        1_000..1_000_000 => format!("{} kB", bytes / 1_000),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

fn capitalized(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(chars).collect()
    })
}

/// Text as HTML shows it.
fn escaped(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => html += "&amp;",
            '<' => html += "&lt;",
            '>' => html += "&gt;",
            '"' => html += "&quot;",
            '\'' => html += "&#39;",
            _ => html.push(c),
        }
    }
    html
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::path::PathBuf;

    const ALL: Extent = Extent {
        most_clips: 100,
        most_names: 1000,
    };

    fn folder_with(names: &[&str]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().canonicalize().unwrap();
        for name in names {
            let path = root.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "xyz").unwrap();
        }
        (folder, root)
    }

    fn names(list: &List) -> Vec<&str> {
        list.clips.iter().map(|clip| clip.name.as_str()).collect()
    }

    #[test]
    fn only_clips_are_listed_and_their_addresses_find_them() {
        let (_folder, root) = folder_with(&[
            "b é#1.bvh",
            "a.BVH",
            "notes.txt",
            "sub/c.bvh",
            "robot.urdf",
            ".hidden/d.bvh",
            ".e.bvh",
            "a\\f.bvh",
            "folder.bvh/g.txt",
        ]);
        let list = List::of(&root, ALL);
        assert_eq!(
            names(&list),
            ["a.BVH", "b é#1.bvh", "robot.urdf", "sub/c.bvh"]
        );
        let written: serde_json::Value = serde_json::from_slice(&list.write().json).unwrap();
        assert_eq!(written.get("shortage"), None);
        for clip in written["clips"].as_array().unwrap() {
            let address = clip["url"]
                .as_str()
                .unwrap()
                .strip_prefix("/clips/")
                .unwrap();
            assert_eq!(files::clip(&root, address).unwrap().metadata.len(), 3);
        }
        assert!(files::clip(&root, "notes.txt").is_err());
        assert!(files::clip(&root, "sub").is_err());
    }

    #[test]
    #[cfg(unix)]
    fn a_link_is_listed_when_what_it_leads_to_would_be() {
        let (_folder, root) = folder_with(&["a.bvh", ".b.bvh", ".c/d.bvh", "e.txt"]);
        for (to, name) in [
            ("a.bvh", "good.bvh"),
            (".b.bvh", "hidden.bvh"),
            (".c/d.bvh", "deep.bvh"),
            ("e.txt", "kind.bvh"),
            ("gone.bvh", "nowhere.bvh"),
            ("loop.bvh", "loop.bvh"),
            ("/etc/hostname", "out.bvh"),
            (".c", "folder.bvh"),
        ] {
            std::os::unix::fs::symlink(to, root.join(name)).unwrap();
        }
        let list = List::of(&root, ALL);
        assert_eq!(names(&list), ["a.bvh", "good.bvh"]);
        for address in [
            "hidden.bvh",
            "deep.bvh",
            "kind.bvh",
            "nowhere.bvh",
            "loop.bvh",
            "out.bvh",
            "folder.bvh/d.bvh",
        ] {
            assert!(files::clip(&root, address).is_err(), "{address}");
        }
    }

    #[test]
    fn a_list_that_is_cut_says_so() {
        let (_folder, root) = folder_with(&["a.bvh", "b.bvh", "c.bvh", "d.txt"]);
        let cut = List::of(
            &root,
            Extent {
                most_clips: 2,
                ..ALL
            },
        );
        assert_eq!(names(&cut), ["a.bvh", "b.bvh"]);
        let written = cut.write();
        assert_eq!(
            written.shortage.as_deref(),
            Some("only the first 2 of 3 clips are listed")
        );
        let json: serde_json::Value = serde_json::from_slice(&written.json).unwrap();
        assert_eq!(json["shortage"], "only the first 2 of 3 clips are listed");
        assert!(String::from_utf8_lossy(&written.html).contains("Only the first 2 of 3 clips"));
        let ended = List::of(
            &root,
            Extent {
                most_names: 2,
                ..ALL
            },
        );
        assert!(
            ended
                .write()
                .shortage
                .unwrap()
                .contains("not searched completely")
        );
        let whole = List::of(
            &root,
            Extent {
                most_clips: 3,
                most_names: 5,
            },
        );
        assert_eq!(whole.write().shortage, None);
    }

    #[test]
    fn a_name_is_not_markup() {
        assert_eq!(
            escaped("<a href='\"&'>"),
            "&lt;a href=&#39;&quot;&amp;&#39;&gt;"
        );
    }

    #[test]
    fn lists_that_differ_have_different_marks() {
        let (_folder, root) = folder_with(&["a.bvh"]);
        let before = List::of(&root, ALL).write().mark;
        assert_eq!(List::of(&root, ALL).write().mark, before);
        fs::write(root.join("a.bvh"), "longer").unwrap();
        assert_ne!(List::of(&root, ALL).write().mark, before);
    }
}
