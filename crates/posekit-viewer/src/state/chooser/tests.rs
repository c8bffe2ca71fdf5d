//! The chooser on folders of its own.

use std::fs;

use super::*;

/// A folder for one test, removed afterwards.
struct Place(PathBuf);

impl Place {
    fn new(name: &str) -> Self {
        let name = format!("posekit chooser {name} {}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(folder.join("takes/second")).expect("a temporary folder");
        for file in [
            "walk_left.bvh",
            "walk_right.BVH",
            "run.bvh",
            "notes.txt",
            ".hidden.bvh",
            "takes/a.bvh",
        ] {
            fs::write(folder.join(file), "old").expect("written");
        }
        // As paths are told: links in the way to the temporary folder are not followed.
        Self(folder)
    }

    fn chooser(&self, goal: Goal, name: &str) -> Chooser {
        Chooser::new(Ask {
            title: "",
            goal,
            endings: vec!["bvh"],
            name: name.to_owned(),
            folder: self.0.clone(),
            says: None,
            open_files: vec![self.0.join("run.bvh")],
        })
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

fn names(chooser: &Chooser) -> Vec<&str> {
    let rows = (0..chooser.row_count()).filter_map(|row| chooser.row(row));
    rows.map(|item| item.name.as_str()).collect()
}

fn typed(chooser: &mut Chooser, text: &str) {
    chooser.text = text.to_owned();
    chooser.follow_text();
}

#[test]
fn folders_come_first_and_files_of_other_kinds_only_when_asked_for() {
    let place = Place::new("lists");
    let mut chooser = place.chooser(Goal::OpenFiles, "");
    let listed = ["takes", "run.bvh", "walk_left.bvh", "walk_right.BVH"];
    assert_eq!(names(&chooser), listed);
    typed(&mut chooser, "LEFT");
    assert_eq!(names(&chooser), ["walk_left.bvh"]);
    typed(&mut chooser, ".");
    assert!(names(&chooser).contains(&".hidden.bvh"));
    typed(&mut chooser, "");
    chooser.set_shows_all(true);
    assert!(names(&chooser).contains(&"notes.txt"));
    let folders = place.chooser(Goal::OpenFolder, "");
    assert_eq!(names(&folders), ["takes"]);
}

#[test]
fn tab_completes_as_far_as_names_agree_and_goes_into_a_folder() {
    let place = Place::new("completes");
    let mut chooser = place.chooser(Goal::OpenFiles, "");
    typed(&mut chooser, "W");
    chooser.complete();
    assert_eq!(chooser.text, "walk_");
    typed(&mut chooser, "walk_r");
    chooser.complete();
    assert_eq!(chooser.text, "walk_right.BVH");
    assert_eq!(chooser.enter(), Some(vec![place.0.join("walk_right.BVH")]));
    typed(&mut chooser, "ta");
    chooser.complete();
    assert_eq!(chooser.folder(), place.0.join("takes"));
    assert_eq!(chooser.text, "");
    typed(&mut chooser, "no such name");
    chooser.complete();
    assert_eq!(chooser.text, "no such name");
}

#[test]
fn a_path_is_typed_or_pasted_whole() {
    let place = Place::new("pastes");
    let mut chooser = place.chooser(Goal::OpenFiles, "");
    let whole = place.0.join("takes").join("a.bvh");
    typed(&mut chooser, &whole.to_string_lossy());
    assert_eq!(chooser.folder(), place.0.join("takes"));
    assert_eq!(chooser.enter(), Some(vec![whole]));
    typed(&mut chooser, "../");
    assert_eq!(chooser.folder(), place.0);
    typed(&mut chooser, "no such/");
    assert!(chooser.problem().is_some_and(|it| it.contains("no such")));
    assert_eq!(chooser.folder(), place.0);
    typed(&mut chooser, "nothing.bvh");
    assert_eq!(chooser.enter(), None);
    assert!(
        chooser
            .problem()
            .is_some_and(|it| it.starts_with("There is no file"))
    );
}

#[test]
fn several_files_are_ticked() {
    let place = Place::new("ticks");
    let mut chooser = place.chooser(Goal::OpenFiles, "");
    chooser.click(1, true);
    chooser.point(true);
    chooser.point(true);
    chooser.point(true);
    chooser.tick_pointed();
    let both = vec![place.0.join("run.bvh"), place.0.join("walk_left.bvh")];
    assert_eq!(chooser.enter(), Some(both));
    chooser.click(1, true);
    assert!(!chooser.is_ticked(&place.0.join("run.bvh")));
}

#[test]
fn what_is_there_is_replaced_only_after_a_yes() {
    let place = Place::new("replaces");
    let mut chooser = place.chooser(Goal::SaveFile, "run");
    assert_eq!(chooser.enter(), None);
    let path = place.0.join("run.bvh");
    let asked = Question::Replace {
        path: path.clone(),
        is_open: true,
    };
    assert_eq!(chooser.question(), Some(&asked));
    assert_eq!(chooser.enter(), None, "Enter keeps what is there");
    assert_eq!(chooser.question(), None);
    assert_eq!(chooser.enter(), None);
    assert_eq!(chooser.agree(), Some(vec![path]));
    typed(&mut chooser, "new one");
    assert_eq!(chooser.enter(), Some(vec![place.0.join("new one.bvh")]));
}

#[test]
fn a_folder_that_is_not_there_is_made_when_that_is_wanted() {
    let place = Place::new("makes");
    let mut chooser = place.chooser(Goal::SaveFile, "");
    typed(&mut chooser, "new/deep/walk");
    assert!(chooser.problem().is_some());
    assert_eq!(chooser.enter(), None);
    let folder = place.0.join("new/deep");
    assert_eq!(
        chooser.question(),
        Some(&Question::MakeFolder(folder.clone()))
    );
    assert!(!folder.exists());
    assert_eq!(chooser.agree(), Some(vec![folder.join("walk.bvh")]));
    assert!(folder.is_dir());
    typed(&mut chooser, "");
    assert_eq!(chooser.enter(), None);
    assert!(chooser.problem().is_some_and(|it| it.contains("name")));
}

#[test]
fn a_file_that_is_write_protected_is_not_offered_to_be_replaced() {
    let place = Place::new("protected");
    let path = place.0.join("mine.bvh");
    fs::write(&path, "old").expect("written");
    let protect = |on: bool| {
        let mut permissions = fs::metadata(&path).expect("there").permissions();
        permissions.set_readonly(on);
        fs::set_permissions(&path, permissions).expect("set");
    };
    protect(true);
    let mut chooser = place.chooser(Goal::SaveFile, "");
    typed(&mut chooser, "mine");
    assert_eq!(chooser.enter(), None);
    assert_eq!(chooser.question(), None);
    assert!(
        chooser
            .problem()
            .is_some_and(|it| it.contains("write-protected"))
    );
    protect(false);
    assert_eq!(chooser.enter(), None);
    assert!(chooser.question().is_some());
}

#[cfg(unix)]
#[test]
fn a_folder_that_may_not_be_written_to_is_refused() {
    use std::os::unix::fs::PermissionsExt as _;
    let place = Place::new("rights");
    let locked = place.0.join("takes");
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).expect("set");
    let may_all = fs::write(locked.join("as root"), "").is_ok();
    let mut chooser = place.chooser(Goal::SaveFile, "");
    typed(&mut chooser, "takes/new");
    let taken = chooser.enter();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o755)).expect("set");
    if may_all {
        // Rights do not hold for root.
        assert_eq!(taken, Some(vec![locked.join("new.bvh")]));
    } else {
        assert_eq!(taken, None);
        assert!(
            chooser
                .problem()
                .is_some_and(|it| it.contains("permission"))
        );
    }
    assert_eq!(
        fs::read_dir(&locked).expect("listed").count(),
        2 + usize::from(may_all)
    );
}

#[test]
fn a_folder_that_is_gone_is_replaced_by_the_nearest_that_is_there() {
    let place = Place::new("gone");
    let ask = Ask {
        folder: place.0.join("gone/deeper"),
        ..place.chooser(Goal::OpenFiles, "").ask
    };
    assert_eq!(Chooser::new(ask).folder(), place.0);
}

#[test]
fn a_folder_is_chosen_by_enter() {
    let place = Place::new("chooses");
    let mut chooser = place.chooser(Goal::OpenFolder, "");
    assert_eq!(chooser.enter(), Some(vec![place.0.clone()]));
    chooser.click(0, false);
    assert_eq!(chooser.enter(), Some(vec![place.0.join("takes")]));
    typed(&mut chooser, "second");
    assert_eq!(chooser.enter(), Some(vec![place.0.join("takes/second")]));
    typed(&mut chooser, "a.bvh");
    assert_eq!(chooser.enter(), None);
    assert!(
        chooser
            .problem()
            .is_some_and(|it| it.ends_with("is not a folder"))
    );
}

#[test]
fn endings_are_added_where_they_are_not_there() {
    let ended = |name: &str, ending| {
        let path = with_ending(Path::new("/a").join(name), &[ending]);
        path.file_name()
            .map(|name| name.to_string_lossy().into_owned())
    };
    for (name, ending, whole) in [
        ("walk", "bvh", "walk.bvh"),
        ("walk.BVH", "bvh", "walk.BVH"),
        ("walk.v2", "bvh", "walk.v2.bvh"),
        ("a", "posekit.toml", "a.posekit.toml"),
        ("a.toml", "posekit.toml", "a.posekit.toml"),
        ("a.posekit", "posekit.toml", "a.posekit.toml"),
        ("a.posekit.toml", "posekit.toml", "a.posekit.toml"),
        ("\u{e9}.toml", "posekit.toml", "\u{e9}.posekit.toml"),
    ] {
        assert_eq!(ended(name, ending).as_deref(), Some(whole), "{name}");
    }
}
