//! Where work runs: on a thread, or, on a page, after the picture that is being drawn.

/// Runs `work` away from the caller.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn start(work: impl FnOnce() + Send + 'static) {
    // Where no thread can be had, the work is not lost: the window waits for it.
    let work = std::sync::Arc::new(std::sync::Mutex::new(Some(work)));
    let shared = std::sync::Arc::clone(&work);
    let run = move || {
        if let Some(work) = shared.lock().ok().and_then(|mut work| work.take()) {
            work();
        }
    };
    if std::thread::Builder::new()
        .name("read".into())
        .spawn(run.clone())
        .is_err()
    {
        run();
    }
}

/// Runs `work` when the page has nothing else to do.
#[cfg(target_arch = "wasm32")]
pub(super) fn start(work: impl FnOnce() + 'static) {
    use wasm_bindgen::JsCast as _;
    use wasm_bindgen::closure::Closure;

    let callback = Closure::once_into_js(work);
    let later = web_sys::window().and_then(|window| {
        // Long enough for the picture with the progress on it to be shown.
        window
            .set_timeout_with_callback_and_timeout_and_arguments_0(callback.unchecked_ref(), 30)
            .ok()
    });
    if later.is_none() {
        let run: &js_sys::Function = callback.unchecked_ref();
        drop(run.call0(&wasm_bindgen::JsValue::NULL));
    }
}
