//! The files of a page: those that were given to the browser, and those of the page's own origin.
//!
//! Bytes come in pieces, with progress, and can be stopped between two of them; while a piece is
//! waited for the page goes on.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use js_sys::{Array, Promise, Reflect, Uint8Array};
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{ReadableStream, ReadableStreamDefaultReader, RequestInit, Response, Url};

use super::job::{self, Opened, Reading, SMALL_BYTES, Stop};
use super::scene::{among, is_scene, read_scene};
use super::{Event, Input, Listed, Listing, Outbox, Progress, Summary, thread};
use crate::state::clip::Source;
use crate::web;
use crate::work::autosave::Kept;

/// Clips larger than this are not fetched just to make a library's preview.
const PREVIEW_LIMIT_BYTES: u64 = 8 << 20;

/// This much is fetched for a library's previews in all.
const PREVIEW_BUDGET_BYTES: u64 = 128 << 20;

/// Between two previews the page has this long for itself.
const PREVIEW_PAUSE_MS: i32 = 40;

/// How often one who waits for a piece looks whether it is still wanted.
const LOOK_MS: i32 = 150;

/// Reads a clip and hands it in.
pub(super) fn read(reading: Reading, input: Input) {
    spawn_local(async move {
        let name = job::name_of(&input);
        let source = match &input {
            Input::Path(address) => Source::File(address.clone()),
            _ => Source::Bytes,
        };
        let watch = Watch {
            progress: &reading.progress,
            began: &|bytes| reading.show_beginning(&name, &source, bytes),
            grew: &|| reading.outbox.wake(),
        };
        match &input {
            Input::Sample(sample) => {
                reading.hand_in(reading.open_sample(sample));
                return;
            }
            Input::Kept(kept) => {
                let opened = open_kept(kept, &watch, &reading.outbox).await;
                reading.hand_in(opened);
                return;
            }
            Input::Together { scene, others } => {
                open_together(&reading, &name, (scene, others)).await;
                return;
            }
            Input::Path(address) if is_scene(&name) => {
                let opened = open_at(&name, address, &watch).await;
                reading.hand_in(opened);
                return;
            }
            _ => {}
        }
        let fetched = match &input {
            Input::Path(address) => fetch(address, &watch).await,
            Input::Browser(file) => stream(&file.stream(), exact(file.size()), &watch).await,
            Input::Bytes { bytes, .. } => Ok(bytes.to_vec()),
            _ => Err(Stop::Failed(NO_PLACE.to_owned())),
        };
        match fetched {
            Ok(bytes) => thread::start(move || {
                reading.hand_in(reading.open(&name, source, bytes));
            }),
            Err(Stop::Failed(why)) => {
                reading.hand_in(Err(Stop::Failed(format!("{name}: {why}"))));
            }
            Err(Stop::Cancelled) => reading.hand_in(Err(Stop::Cancelled)),
        }
    });
}

/// Why a page does not have a file that a scene names.
const NO_PLACE: &str =
    "a page has no folders: open the scene together with the files that it names";

/// A scene and the files that came with it.
async fn open_together(reading: &Reading, name: &str, (scene, others): (&Input, &[Input])) {
    let bytes = match given(scene).await {
        Ok(bytes) => bytes,
        Err(stop) => {
            reading.hand_in(Err(stop));
            return;
        }
    };
    let mut files = Vec::new();
    for other in others {
        // One that cannot be had is told as missing, if the scene names it.
        if let Ok(bytes) = given(other).await {
            files.push((job::name_of(other), bytes));
        }
    }
    let read = read_scene((name, None), &bytes, among(&files));
    let opened = read.map(|read| Opened::Scene(Box::new(read)));
    reading.hand_in(opened.map_err(Stop::Failed));
    reading.open_others(&bytes, others);
}

/// A scene of the page's own origin, and the files that it names, which are looked for from there.
async fn open_at(name: &str, address: &Path, watch: &Watch<'_>) -> Result<Opened, Stop> {
    let told = |stop: Stop, file: &str| match stop {
        Stop::Failed(why) => Stop::Failed(format!("{file}: {why}")),
        cancelled => cancelled,
    };
    let fetched = fetch(address, watch).await;
    let bytes = fetched.map_err(|stop| told(stop, name))?;
    let mut files = Vec::new();
    // What is wrong with the text is told when it is read with its files.
    if let Ok(scene) = posekit_formats::scene::read(&bytes) {
        let folder = address.to_string_lossy();
        let folder = folder.rsplit_once('/').map_or("", |(folder, _)| folder);
        for file in scene.files() {
            if file.starts_with(posekit_formats::scene::SAMPLE_PREFIX) {
                continue;
            }
            let at = if folder.is_empty() {
                PathBuf::from(file)
            } else {
                PathBuf::from(format!("{folder}/{file}"))
            };
            let fetched = fetch(&at, watch).await;
            let bytes = fetched.map_err(|stop| told(stop, file))?;
            let last = file.rsplit('/').next().unwrap_or(file);
            files.push((last.to_owned(), bytes));
        }
    }
    read_scene((name, None), &bytes, among(&files))
        .map(|read| Opened::Scene(Box::new(read)))
        .map_err(Stop::Failed)
}

/// A scene that was kept while it was not saved, with the files of it that the server has. Where others are wanted,
/// what was kept goes to the downloads, to be opened together with them.
async fn open_kept(kept: &Kept, watch: &Watch<'_>, outbox: &Outbox) -> Result<Opened, Stop> {
    let mut files = Vec::new();
    for address in &kept.addresses {
        // One that is gone is told as missing.
        if let Ok(bytes) = fetch(address, watch).await {
            files.push((name_at(address), bytes));
        }
    }
    match kept.open(among(&files)) {
        Ok(read) => Ok(Opened::Scene(Box::new(read))),
        Err(why) => {
            web::hand_over(outbox, &kept.parcel());
            Err(Stop::Failed(why))
        }
    }
}

/// The bytes of a file that was given to the page.
async fn given(input: &Input) -> Result<Vec<u8>, Stop> {
    match input {
        Input::Bytes { bytes, .. } => Ok(bytes.to_vec()),
        Input::Browser(file) => {
            let watch = Watch {
                progress: &Progress::default(),
                began: &|_| {},
                grew: &|| {},
            };
            stream(&file.stream(), exact(file.size()), &watch).await
        }
        _ => Err(Stop::Failed(NO_PLACE.to_owned())),
    }
}

/// Who is told while bytes come in.
struct Watch<'a> {
    progress: &'a Progress,
    /// Told once, of a large file, with what is there of it.
    began: &'a dyn Fn(&[u8]),
    /// Told after every piece of a large file.
    grew: &'a dyn Fn(),
}

/// Looks at clips one after the other. What is asked for here is waited for to its end: the browser would
/// report what is broken off as a failure.
pub(super) fn look_at(files: Vec<Listed>, progress: Arc<Progress>, outbox: Outbox) {
    spawn_local(async move {
        let mut fetched = 0;
        for Listed { path, bytes } in files {
            web::pause(PREVIEW_PAUSE_MS).await;
            if progress.is_cancelled() {
                return;
            }
            let outcome = if fetched < PREVIEW_BUDGET_BYTES {
                let preview = preview_of(&path, bytes).await;
                fetched += preview.as_ref().map_or(0, |bytes| bytes.len() as u64);
                preview.and_then(|bytes| job::summarize(&bytes))
            } else {
                Err("opened only when asked".to_owned())
            };
            let summary = Box::new(Summary { path, outcome });
            if progress.is_cancelled() || !outbox.send(Event::Summary(summary)) {
                return;
            }
        }
        progress.finish();
        outbox.send(Event::FolderDone);
    });
}

/// The bytes of a clip that is small enough to be fetched just for a preview. Its size is what the list says,
/// or, where that is silent, what the server says before it sends anything.
async fn preview_of(address: &Path, bytes: Option<u64>) -> Result<Vec<u8>, String> {
    let told = |stop: Stop| match stop {
        Stop::Failed(why) => why,
        Stop::Cancelled => "not looked at".to_owned(),
    };
    let bytes = match bytes {
        Some(bytes) => Some(bytes),
        None => {
            let head = response_of(&address.to_string_lossy(), "HEAD").await;
            length_of(&head.map_err(told)?)
        }
    };
    if let Some(bytes) = bytes.filter(|&bytes| bytes > PREVIEW_LIMIT_BYTES) {
        return Err(format!("{} MB: opened only when asked", bytes >> 20));
    }
    let watch = Watch {
        // Its own: the list's tells whether the list is still wanted.
        progress: &Progress::default(),
        began: &|_| {},
        grew: &|| {},
    };
    fetch(address, &watch).await.map_err(told)
}

/// The clips that a server offers, out of its list as the page got it: nothing if there are none.
pub(crate) fn listing_of(list: &JsValue) -> Option<Listing> {
    let field = |value: &JsValue, name: &str| Reflect::get(value, &JsValue::from_str(name)).ok();
    let clips = Array::from(&field(list, "clips")?);
    let clips: Vec<_> = clips
        .iter()
        .filter_map(|clip| {
            let name = field(&clip, "name")?.as_string()?;
            let address = field(&clip, "url")?.as_string()?;
            let listed = Listed {
                path: PathBuf::from(address),
                bytes: field(&clip, "bytes").and_then(|bytes| exact(bytes.as_f64()?)),
            };
            Some((listed, name))
        })
        .collect();
    let folder = field(list, "folder").and_then(|folder| folder.as_string());
    (!clips.is_empty()).then(|| Listing {
        clips,
        folder: folder.unwrap_or_else(|| "Clips".to_owned()),
        shortage: field(list, "shortage").and_then(|shortage| shortage.as_string()),
    })
}

/// What the file at an address is called.
pub(crate) fn name_at(address: &Path) -> String {
    let address = address.to_string_lossy();
    let path = address.split(['?', '#']).next().unwrap_or_default();
    let last = path.rsplit('/').next().unwrap_or_default();
    match js_sys::decode_uri_component(last) {
        Ok(name) => name.into(),
        Err(_no_such_code) => last.to_owned(),
    }
}

/// Fetches a file of the page's own origin.
async fn fetch(address: &Path, watch: &Watch<'_>) -> Result<Vec<u8>, Stop> {
    let response = response_of(&address.to_string_lossy(), "GET").await?;
    let Some(body) = response.body() else {
        return Ok(Vec::new());
    };
    stream(&body, length_of(&response), watch).await
}

/// How many bytes the server says that there are. Those of a file that travels packed are more.
fn length_of(response: &Response) -> Option<u64> {
    let length = response.headers().get("content-length").ok().flatten()?;
    length.parse().ok()
}

async fn response_of(address: &str, method: &str) -> Result<Response, Stop> {
    let failed = |why: &str| Stop::Failed(why.to_owned());
    let (Some(window), Some(whole)) = (web_sys::window(), whole_address(address)) else {
        return Err(failed("this is no address"));
    };
    // Another's file would come with this page's authority: it is not fetched.
    if window.location().origin().ok() != Some(whole.origin()) {
        return Err(failed("only files of this page's own origin are opened"));
    }
    let how = RequestInit::new();
    how.set_method(method);
    let response = JsFuture::from(window.fetch_with_str_and_init(&whole.href(), &how))
        .await
        .map_err(|_unreachable| failed("it could not be fetched: the server does not answer"))?;
    let response: Response = response.unchecked_into();
    match response.status() {
        _ if response.ok() => Ok(response),
        404 => Err(failed("there is no such file on the server")),
        status => Err(failed(&format!("the server refused it ({status})"))),
    }
}

fn whole_address(address: &str) -> Option<Url> {
    let base = web_sys::window()?.location().href().ok()?;
    Url::new_with_base(address, &base).ok()
}

/// Collects a stream's bytes. `length` is what the other side says there will be.
async fn stream(
    body: &ReadableStream,
    length: Option<u64>,
    watch: &Watch<'_>,
) -> Result<Vec<u8>, Stop> {
    let broken = |_error: JsValue| Stop::Failed("it broke off while it was read".to_owned());
    let too_large = || Stop::Failed("it is larger than a page's memory".to_owned());
    let length = length.unwrap_or(0);
    // The other half is for reading what was fetched.
    watch.progress.set_total(2 * length);
    let reader: ReadableStreamDefaultReader = body.get_reader().unchecked_into();
    let mut bytes: Vec<u8> = Vec::new();
    let promised = usize::try_from(length).map_err(|_over| too_large())?;
    bytes
        .try_reserve_exact(promised)
        .map_err(|_no_memory| too_large())?;
    loop {
        let Some(piece) = wanted(reader.read(), watch.progress).await else {
            drop(reader.cancel());
            return Err(Stop::Cancelled);
        };
        let piece = piece.map_err(broken)?;
        let value = Reflect::get(&piece, &JsValue::from_str("value")).map_err(broken)?;
        if value.is_undefined() {
            return Ok(bytes);
        }
        let value: Uint8Array = value.unchecked_into();
        let start = bytes.len();
        let added = value.length() as usize;
        bytes.try_reserve(added).map_err(|_no_memory| too_large())?;
        bytes.resize(start + added, 0);
        value.copy_to(&mut bytes[start..]);
        watch.progress.set_done(bytes.len() as u64);
        if bytes.len() as u64 > SMALL_BYTES {
            if start as u64 <= SMALL_BYTES {
                (watch.began)(&bytes);
            }
            (watch.grew)();
        }
    }
}

/// Waits for a promise for as long as its outcome is wanted: `None` when it is not any more.
async fn wanted(promise: Promise, progress: &Progress) -> Option<Result<JsValue, JsValue>> {
    loop {
        if progress.is_cancelled() {
            return None;
        }
        let over = JsValue::NULL;
        let first = Promise::race(&Array::of2(&promise, &web::after(LOOK_MS, &over)));
        let first = JsFuture::from(first).await;
        if !matches!(&first, Ok(value) if value.is_null()) {
            return Some(first);
        }
    }
}

/// A file's size, which the browser gives as a floating-point number.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number of bytes, far below 2^53"
)]
fn exact(size: f64) -> Option<u64> {
    (size >= 0.0).then_some(size as u64)
}
