//! The web page: the same viewer in a canvas.
//!
//! Files come by drop, by dialog, or from the page's own address: `?url=clips/walk.bvh` opens a
//! file of the same origin. Nothing leaves the page: files are read in the browser.

use std::path::{Path, PathBuf};

use js_sys::Promise;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{FileList, HtmlAnchorElement, HtmlCanvasElement, HtmlInputElement, Window};

use crate::app::{Status, Viewer, ViewerOptions};
use crate::load::{Chosen, Event, Input, Outbox, listing_of, name_at};
use crate::state::display::Look;
use crate::state::settings::{Settings, WindowLayout};
use crate::work::files::Parcel;

/// What is saved can be had from the page for this long; browsers take it within moments.
const DOWNLOAD_MS: i32 = 60_000;

/// Which page this is among those of its origin in the browser, and the others that are open.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    /// What this one is called; no other is, or was, called so.
    pub own: String,
    /// What the others are called.
    pub others: Vec<String>,
}

thread_local! {
    static RUNS: std::cell::RefCell<Runs> = const {
        std::cell::RefCell::new(Runs { own: String::new(), others: Vec::new() })
    };
}

pub(crate) fn runs() -> Runs {
    RUNS.with_borrow(Clone::clone)
}

/// Starts the viewer in a canvas. `list` is the server's `clips.json`, or null where it has none. `run` is what this
/// page is called among those that are open in the browser, and `others` what those are called.
///
/// # Errors
/// When the browser offers neither WebGPU nor WebGL2.
#[wasm_bindgen]
pub async fn start(
    canvas: HtmlCanvasElement,
    list: JsValue,
    run: String,
    others: Vec<String>,
) -> Result<(), JsValue> {
    RUNS.set(Runs { own: run, others });
    let options = ViewerOptions {
        inputs: asked_address().map(Input::Path).into_iter().collect(),
        listing: listing_of(&list),
        ..ViewerOptions::default()
    };
    let runner = eframe::WebRunner::new();
    let told = canvas.clone();
    let create: eframe::AppCreator<'static> = Box::new(move |context| {
        Ok(Box::new(Page {
            viewer: Viewer::of_window(context, options),
            canvas: told,
            said: Status::default(),
        }))
    });
    runner
        .start(canvas, eframe::WebOptions::default(), create)
        .await
}

/// The viewer in its canvas, which says in its data attributes what is shown: `data-frame="12"`.
struct Page {
    viewer: Viewer,
    canvas: HtmlCanvasElement,
    said: Status,
}

impl Page {
    /// Writes what has changed.
    fn say(&mut self, ctx: &egui::Context) {
        let status = self.viewer.status(ctx);
        for (name, value) in status.iter() {
            if self.said.get(name) == Some(value) {
                continue;
            }
            // An element takes an attribute of any such name.
            drop(self.canvas.set_attribute(&format!("data-{name}"), value));
        }
        self.said = status;
    }
}

impl eframe::App for Page {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.viewer.ui(ui, frame);
        self.say(ui.ctx());
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.viewer.clear_color(visuals)
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.viewer.save(storage);
    }
}

/// In a window narrower than this, in the page's pixels, the sides would leave no room for the figure.
const NARROW: f64 = 700.0;

/// The settings of somebody who was never here: light or dark as the browser is, and on a phone
/// nothing but the figure.
pub(crate) fn first_settings() -> Settings {
    let width = web_sys::window().and_then(|window| window.inner_width().ok()?.as_f64());
    let sides = width.is_none_or(|width| width >= NARROW);
    let look = match eframe::web::system_theme() {
        Some(egui::Theme::Dark) => Look::Dark,
        _ => Look::Light,
    };
    Settings {
        look,
        layout: WindowLayout {
            left: sides,
            right: sides,
            ..WindowLayout::default()
        },
        ..Settings::default()
    }
}

/// What `?url=` in the page's address names: as a server's list names it, if it is of the page's own
/// origin.
fn asked_address() -> Option<PathBuf> {
    let location = web_sys::window()?.location();
    let parameters = web_sys::UrlSearchParams::new_with_str(&location.search().ok()?).ok()?;
    let asked = parameters.get("url")?;
    let own_path = || {
        let whole = web_sys::Url::new_with_base(&asked, &location.href().ok()?).ok()?;
        let is_own = whole.origin() == location.origin().ok()?;
        is_own.then(|| whole.pathname() + &whole.search())
    };
    Some(own_path().unwrap_or(asked).into())
}

/// Opens what was dropped on the page.
#[must_use]
pub fn dropped_inputs(files: &[egui::DroppedFileHandle]) -> Vec<Input> {
    let files = files.iter().filter_map(|file| file.web_file());
    files.cloned().map(Input::Browser).collect()
}

/// Asks for files to open.
pub fn ask_for_files(outbox: &Outbox) {
    let outbox = outbox.clone();
    // A browser without a document has no dialog either.
    let _no_document = open_dialog(outbox);
}

fn open_dialog(outbox: Outbox) -> Option<()> {
    let document = web_sys::window()?.document()?;
    let input: HtmlInputElement = document.create_element("input").ok()?.dyn_into().ok()?;
    input.set_type("file");
    input.set_accept(".bvh,.urdf,.toml");
    input.set_multiple(true);
    let chosen = input.clone();
    let on_change = Closure::once_into_js(move || {
        let files = chosen.files();
        let count = files.as_ref().map_or(0, FileList::length);
        let files = (0..count).filter_map(|index| files.as_ref()?.get(index));
        let inputs = files.map(Input::Browser).collect();
        outbox.send(Event::Chosen(Chosen::Inputs(inputs)));
    });
    input.set_onchange(Some(on_change.unchecked_ref()));
    input.click();
    Some(())
}

thread_local! {
    /// What the browser calls before the page is left, once it was wanted.
    static LEAVING: std::cell::OnceCell<js_sys::Function> = const { std::cell::OnceCell::new() };
    static IS_ASKED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// Lets the browser ask before the page is left, or no longer: something is in no file.
pub(crate) fn ask_before_leaving(asks: bool) {
    let Some(window) = web_sys::window() else {
        return;
    };
    if IS_ASKED.replace(asks) == asks {
        return;
    }
    if !asks {
        window.set_onbeforeunload(None);
        return;
    }
    LEAVING.with(|leaving| {
        let handler = leaving.get_or_init(|| {
            // Browsers ask when the event is given a value; what it says is not shown.
            let set = |event: JsValue| {
                let given = JsValue::from_str("not saved");
                drop(js_sys::Reflect::set(&event, &"returnValue".into(), &given));
            };
            Closure::<dyn FnMut(JsValue)>::new(set)
                .into_js_value()
                .unchecked_into()
        });
        window.set_onbeforeunload(Some(handler));
    });
}

/// Gives a file to the browser's downloads.
pub fn hand_over(outbox: &Outbox, parcel: &Parcel) {
    let event = match download(parcel) {
        Ok(()) => Event::Written {
            message: format!("{} is in your downloads", parcel.name),
        },
        Err(_refused) => Event::Failed {
            message: format!("{} was not saved", parcel.name),
        },
    };
    outbox.send(event);
}

/// Has the browser save a file of the page's own server, as it is.
pub(crate) fn download_address(outbox: &Outbox, address: &Path) {
    let name = name_at(address);
    if follow_to_save(&address.to_string_lossy(), &name).is_err() {
        let message = format!("{name} was not saved");
        outbox.send(Event::Failed { message });
    }
}

fn follow_to_save(address: &str, name: &str) -> Result<(), JsValue> {
    let window = web_sys::window().ok_or(JsValue::NULL)?;
    let location = window.location();
    let whole = web_sys::Url::new_with_base(address, &location.href()?)?;
    // A browser would show another's file instead of saving it.
    if whole.origin() != location.origin()? {
        return Err(JsValue::NULL);
    }
    whole.search_params().set("download", "");
    let document = window.document().ok_or(JsValue::NULL)?;
    let anchor: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
    anchor.set_href(&whole.href());
    anchor.set_download(name);
    anchor.click();
    Ok(())
}

fn download(parcel: &Parcel) -> Result<(), JsValue> {
    let document = web_sys::window()
        .and_then(|window| window.document())
        .ok_or(JsValue::NULL)?;
    let bytes = js_sys::Uint8Array::from(&*parcel.bytes);
    let blob = web_sys::Blob::new_with_u8_array_sequence(&js_sys::Array::of1(&bytes))?;
    let address = web_sys::Url::create_object_url_with_blob(&blob)?;
    let anchor: HtmlAnchorElement = document.create_element("a")?.dyn_into()?;
    anchor.set_href(&address);
    anchor.set_download(&parcel.name);
    anchor.click();
    spawn_local(async move {
        // The browser takes the bytes in its own time.
        pause(DOWNLOAD_MS).await;
        drop(web_sys::Url::revoke_object_url(&address));
    });
    Ok(())
}

/// Waits while the page goes on.
pub(crate) async fn pause(ms: i32) {
    // A timer does not fail.
    drop(JsFuture::from(after(ms, &JsValue::NULL)).await);
}

/// A promise of `value` after a while.
pub(crate) fn after(ms: i32, value: &JsValue) -> Promise {
    let value = value.clone();
    Promise::new(&mut |resolve, _reject| {
        let window: Option<Window> = web_sys::window();
        let value = value.clone();
        let run = Closure::once_into_js(move || resolve.call1(&JsValue::NULL, &value).is_ok());
        let run = run.unchecked_ref();
        drop(window.map(|w| w.set_timeout_with_callback_and_timeout_and_arguments_0(run, ms)));
    })
}
