//! The file chooser of the window itself, for systems that have none, and for those who like it better: a
//! folder that is listed, and a name or path that is typed.
//!
//! As soon as what is typed begins with a folder that exists, that folder is listed and its name leaves the
//! text: paths can be typed and pasted whole. `~` is the home folder.

mod listing;

use std::collections::BTreeSet;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

pub use listing::{Item, is_write_protected};
use listing::{check_writable, has_ending, list};

/// What is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// Files that are there: one or more.
    OpenFiles,
    /// A folder that is there.
    OpenFolder,
    /// A file that is written.
    SaveFile,
}

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Ask {
    /// The heading.
    pub title: &'static str,
    /// What is chosen.
    pub goal: Goal,
    /// How the names of the files meant end, after a dot; what is saved gets the first of them.
    pub endings: Vec<&'static str>,
    /// The name proposed.
    pub name: String,
    /// The folder that is listed first.
    pub folder: PathBuf,
    /// Why it is asked here and not by the system, where that needs saying.
    pub says: Option<&'static str>,
    /// Files that are open in the window: writing over one of them is said.
    pub open_files: Vec<PathBuf>,
}

/// Something to be answered before it goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// The file is there already: is it replaced?
    Replace {
        /// The file.
        path: PathBuf,
        /// Whether the window has it open.
        is_open: bool,
    },
    /// The folder is not there: is it made?
    MakeFolder(PathBuf),
}

/// The chooser.
#[derive(Debug)]
pub struct Chooser {
    ask: Ask,
    folder: PathBuf,
    items: Vec<Item>,
    /// Which items are listed, in their order.
    rows: Vec<usize>,
    /// What is typed.
    pub text: String,
    /// The row that the arrows have gone to.
    pointed: Option<usize>,
    ticked: BTreeSet<PathBuf>,
    shows_all: bool,
    is_new: bool,
    problem: Option<String>,
    question: Option<Question>,
}

impl Chooser {
    /// A chooser that lists a folder; its nearest parent that can be listed where that cannot be.
    #[must_use]
    pub fn new(ask: Ask) -> Self {
        let mut chooser = Self {
            folder: PathBuf::new(),
            items: Vec::new(),
            rows: Vec::new(),
            text: ask.name.clone(),
            pointed: None,
            ticked: BTreeSet::new(),
            shows_all: false,
            is_new: true,
            problem: None,
            question: None,
            ask,
        };
        let wanted = chooser.ask.folder.clone();
        for folder in wanted.ancestors() {
            if let Ok(items) = list(folder) {
                chooser.take(folder.to_owned(), items);
                return chooser;
            }
        }
        chooser.go_to(&wanted);
        chooser
    }

    /// What is asked for.
    #[must_use]
    pub fn ask(&self) -> &Ask {
        &self.ask
    }

    /// Whether it was not shown before this was asked.
    pub fn take_is_new(&mut self) -> bool {
        std::mem::take(&mut self.is_new)
    }

    /// The folder that is listed.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What is wrong with what was asked for.
    #[must_use]
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// What is to be answered.
    #[must_use]
    pub fn question(&self) -> Option<&Question> {
        self.question.as_ref()
    }

    /// How many rows there are.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.rows.len()
    }

    /// What a row shows.
    #[must_use]
    pub fn row(&self, row: usize) -> Option<&Item> {
        self.rows.get(row).and_then(|index| self.items.get(*index))
    }

    /// The row that the arrows have gone to.
    #[must_use]
    pub fn pointed(&self) -> Option<usize> {
        self.pointed
    }

    /// Whether an item is one of several that are opened.
    #[must_use]
    pub fn is_ticked(&self, path: &Path) -> bool {
        self.ticked.contains(path)
    }

    /// How many files are ticked.
    #[must_use]
    pub fn ticked_count(&self) -> usize {
        self.ticked.len()
    }

    /// Whether files of all kinds are listed, and hidden ones.
    #[must_use]
    pub fn shows_all(&self) -> bool {
        self.shows_all
    }

    /// Lists files of all kinds, or no longer.
    pub fn set_shows_all(&mut self, shows_all: bool) {
        self.shows_all = shows_all;
        self.list_rows();
    }

    /// Lists another folder. Where that cannot be, says why and stays.
    pub fn go_to(&mut self, folder: &Path) -> bool {
        match list(folder) {
            Ok(items) => {
                self.take(folder.to_owned(), items);
                true
            }
            Err(why) => {
                self.problem = Some(why);
                false
            }
        }
    }

    /// Lists the folder above.
    pub fn go_up(&mut self) {
        let above = self.folder.parent().map(Path::to_owned);
        if let Some(above) = above {
            self.go_to(&above);
        }
    }

    fn take(&mut self, folder: PathBuf, items: Vec<Item>) {
        if folder != self.folder {
            self.ticked.clear();
        }
        self.folder = folder;
        self.items = items;
        self.problem = None;
        self.question = None;
        self.list_rows();
    }

    /// What is typed has changed: folders in it that exist are gone into, the list follows.
    pub fn follow_text(&mut self) {
        self.problem = None;
        self.question = None;
        let cut = self.text.rfind(std::path::is_separator);
        if let Some(cut) = cut {
            let (head, tail) = self.text.split_at(cut + 1);
            let tail = tail.to_owned();
            let folder = self.placed(head);
            if folder.is_dir() {
                if self.go_to(&folder) {
                    self.text = tail;
                }
            } else {
                self.problem = Some(format!("There is no folder {}", folder.display()));
            }
        }
        self.list_rows();
    }

    /// Where a text leads from the folder that is listed.
    fn placed(&self, text: &str) -> PathBuf {
        let at_home = text
            .strip_prefix('~')
            .filter(|rest| rest.is_empty() || rest.starts_with(std::path::is_separator));
        let path = match (at_home, home()) {
            (Some(rest), Some(home)) => home.join(rest.trim_start_matches(std::path::is_separator)),
            _ => self.folder.join(text),
        };
        crate::state::animate::place::absolute(&path)
    }

    fn list_rows(&mut self) {
        self.pointed = None;
        let folded = self.text.to_lowercase();
        let is_meant = |item: &Item| {
            let is_kind = match self.ask.goal {
                Goal::OpenFolder => !item.is_file,
                Goal::OpenFiles | Goal::SaveFile => {
                    !item.is_file || self.shows_all || item.ends_in(&self.ask.endings)
                }
            };
            // Who types a dot asks for what is hidden.
            is_kind && (!item.is_hidden() || self.shows_all || folded.starts_with('.'))
        };
        let is_found: Box<dyn Fn(&Item) -> bool> = match self.ask.goal {
            // A name that is to be written may be like none of those that are there.
            Goal::SaveFile => Box::new(|_| true),
            Goal::OpenFiles | Goal::OpenFolder => Box::new(|item| item.contains(&folded)),
        };
        let items = self.items.iter().enumerate();
        let listed = items.filter(|(_, item)| is_meant(item) && is_found(item));
        self.rows = listed.map(|(index, _)| index).collect();
    }

    /// The arrows go some rows down, or up.
    pub fn point(&mut self, down: bool) {
        let last = match self.rows.len().checked_sub(1) {
            Some(last) => last,
            None => return,
        };
        self.pointed = Some(match (self.pointed, down) {
            (None, true) => 0,
            (None, false) => last,
            (Some(row), true) => (row + 1).min(last),
            (Some(row), false) => row.saturating_sub(1),
        });
    }

    /// Completes what is typed: by the row that the arrows have gone to, or as far as all names that begin
    /// like it go on alike.
    pub fn complete(&mut self) {
        if let Some(item) = self.pointed.and_then(|row| self.row(row)) {
            let path = item.path.clone();
            if item.is_file {
                self.text = item.name.clone();
                self.problem = None;
                self.question = None;
            } else if self.go_to(&path) {
                self.text.clear();
                self.list_rows();
            }
            return;
        }
        let folded = self.text.to_lowercase();
        let rows = self.rows.iter().map(|index| &self.items[*index]);
        let alike: Vec<&Item> = rows.filter(|item| item.starts_with(&folded)).collect();
        match alike.as_slice() {
            [] => {}
            [only] if !only.is_file => {
                let path = only.path.clone();
                if self.go_to(&path) {
                    self.text.clear();
                    self.list_rows();
                }
            }
            [first, others @ ..] => {
                let mut common = first.name.as_str();
                for other in others {
                    common = &common[..common_length(common, &other.name)];
                }
                if common.len() >= self.text.len() {
                    self.text = common.to_owned();
                    self.follow_text();
                }
            }
        }
    }

    /// A row was clicked: a folder is gone into, a file is named; with `ticks` it is one of several.
    pub fn click(&mut self, row: usize, ticks: bool) {
        let Some(item) = self.row(row).cloned() else {
            return;
        };
        if !item.is_file {
            if self.go_to(&item.path) && self.ask.goal != Goal::SaveFile {
                self.text.clear();
                self.list_rows();
            }
            return;
        }
        self.problem = None;
        self.question = None;
        if ticks && self.ask.goal == Goal::OpenFiles {
            if !self.ticked.remove(&item.path) {
                self.ticked.insert(item.path);
            }
        } else {
            self.text = item.name;
            self.pointed = Some(row);
        }
    }

    /// Ticks the row that the arrows have gone to, or no longer.
    pub fn tick_pointed(&mut self) {
        if let Some(row) = self.pointed {
            let is_file = self.row(row).is_some_and(|item| item.is_file);
            if is_file {
                self.click(row, true);
            }
        }
    }

    /// Enter: what is named is taken, if it can be. The files or the folder that were chosen.
    pub fn enter(&mut self) -> Option<Vec<PathBuf>> {
        self.problem = None;
        if let Some(question) = self.question.clone() {
            // The answer that loses nothing is the one that Enter gives.
            return match question {
                Question::Replace { .. } => {
                    self.question = None;
                    None
                }
                Question::MakeFolder(_) => self.agree(),
            };
        }
        let pointed = self.pointed.and_then(|row| self.row(row)).cloned();
        if let Some(item) = &pointed
            && !item.is_file
        {
            if self.go_to(&item.path) && self.ask.goal != Goal::SaveFile {
                self.text.clear();
                self.list_rows();
            }
            return None;
        }
        if !self.ticked.is_empty() {
            return Some(self.ticked.iter().cloned().collect());
        }
        if let Some(item) = pointed {
            return self.take_path(item.path);
        }
        let text = self.text.trim().to_owned();
        if text.is_empty() {
            return match self.ask.goal {
                Goal::OpenFolder => Some(vec![self.folder.clone()]),
                Goal::OpenFiles => self.refuse("Type the name of a file, or click one"),
                Goal::SaveFile => self.refuse("Type a name for the file"),
            };
        }
        // A name may begin or end with a blank; where there is such a file it is the one meant.
        let exact = self.placed(&self.text);
        let path = if exact.exists() {
            exact
        } else {
            self.placed(&text)
        };
        self.take_path(path)
    }

    fn take_path(&mut self, path: PathBuf) -> Option<Vec<PathBuf>> {
        if path.is_dir() {
            if self.ask.goal == Goal::OpenFolder {
                return Some(vec![path]);
            }
            if self.go_to(&path) {
                self.text.clear();
                self.list_rows();
            }
            return None;
        }
        match self.ask.goal {
            Goal::OpenFiles if path.exists() => Some(vec![path]),
            Goal::OpenFolder if path.exists() => {
                self.refuse(&format!("{} is not a folder", path.display()))
            }
            Goal::OpenFolder => self.refuse(&format!("There is no folder {}", path.display())),
            Goal::OpenFiles => {
                // One row is left: that is the one meant.
                let only = (self.rows.len() == 1)
                    .then(|| self.row(0).cloned())
                    .flatten();
                match only {
                    Some(item) if item.is_file => Some(vec![item.path]),
                    Some(item) => self.take_path(item.path),
                    None => self.refuse(&format!("There is no file {}", path.display())),
                }
            }
            Goal::SaveFile => self.take_place(with_ending(path, &self.ask.endings)),
        }
    }

    /// A place for a file: is there a folder, may it be written to, is there something already?
    fn take_place(&mut self, path: PathBuf) -> Option<Vec<PathBuf>> {
        let folder = path.parent().unwrap_or(&self.folder).to_owned();
        if !folder.exists() {
            self.question = Some(Question::MakeFolder(folder));
            return None;
        }
        if let Err(why) = check_writable(&folder) {
            return self.refuse(&why);
        }
        if path.is_dir() {
            return self.refuse(&format!("{} is a folder", path.display()));
        }
        if is_write_protected(&path) {
            return self.refuse(&format!("{} is write-protected", path.display()));
        }
        if path.exists() {
            let is_open = self.ask.open_files.contains(&path);
            self.question = Some(Question::Replace { path, is_open });
            return None;
        }
        Some(vec![path])
    }

    fn refuse(&mut self, why: &str) -> Option<Vec<PathBuf>> {
        self.problem = Some(why.to_owned());
        None
    }

    /// The question is answered by yes. What was chosen by that.
    pub fn agree(&mut self) -> Option<Vec<PathBuf>> {
        match self.question.take()? {
            Question::Replace { path, .. } => Some(vec![path]),
            Question::MakeFolder(folder) => match std::fs::create_dir_all(&folder) {
                Ok(()) => {
                    self.follow_text();
                    self.enter()
                }
                Err(error) => {
                    let why = posekit_formats::system::in_words(&error);
                    self.refuse(&format!("{} cannot be made: {why}", folder.display()))
                }
            },
        }
    }

    /// The question is answered by no.
    pub fn decline(&mut self) {
        self.question = None;
    }

    /// Asks about a place that was chosen elsewhere, by a name that is not the whole one: it may be
    /// there already.
    pub fn ask_about(&mut self, path: &Path) -> Option<Vec<PathBuf>> {
        if let Some(folder) = path.parent() {
            self.go_to(folder);
        }
        let name = path.file_name().unwrap_or_default();
        self.text = name.to_string_lossy().into_owned();
        self.take_place(path.to_owned())
    }
}

/// The path of a file that is saved: its ending is added where it is not there.
#[must_use]
pub fn with_ending(path: PathBuf, endings: &[&str]) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(first) = endings.first() else {
        return path;
    };
    if has_ending(&name, first) {
        return path;
    }
    // Of an ending of two parts one may be there.
    let mut stem = &*name;
    if first.contains('.') {
        for part in first.rsplit('.') {
            let cut = stem.len().saturating_sub(part.len() + 1);
            if has_ending(stem, part) && stem.is_char_boundary(cut) {
                stem = &stem[..cut];
            }
        }
    }
    let whole = format!("{stem}.{first}");
    path.with_file_name(whole)
}

/// How many bytes two names have in common at their beginning, in any case of letters.
fn common_length(a: &str, b: &str) -> usize {
    let pairs = a.char_indices().zip(b.chars());
    let differs = |((_, a), b): &((usize, char), char)| !a.to_lowercase().eq(b.to_lowercase());
    let common = pairs.take_while(|pair| !differs(pair)).last();
    common.map_or(0, |((at, char), _)| at + char.len_utf8())
}

/// The home folder of whoever is at the machine.
#[must_use]
pub fn home() -> Option<PathBuf> {
    std::env::home_dir().filter(|home| !home.as_os_str().is_empty())
}

/// A folder as a text that ends like one.
#[must_use]
pub fn folder_text(folder: &Path) -> String {
    let text = folder.display().to_string();
    if text.ends_with(std::path::is_separator) {
        text
    } else {
        format!("{text}{MAIN_SEPARATOR}")
    }
}

#[cfg(test)]
mod tests;
