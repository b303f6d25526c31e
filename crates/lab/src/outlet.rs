//! Where a file goes that the user asked for: onto the disk, or, on a page, to the browser's downloads.

use eframe::egui;
use std::path::{Path, PathBuf};

/// Writes a file, whole or not at all.
///
/// # Errors
/// Why it cannot be written.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    output::write_whole(path, bytes).map_err(|error| error.to_string())
}

/// Gives a file to the browser, which downloads it under its name.
///
/// # Errors
/// What the browser said.
#[cfg(target_family = "wasm")]
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    download(path, bytes).map_err(|error| format!("{} cannot be downloaded: {error:?}", path.display()))
}

#[cfg(target_family = "wasm")]
fn download(path: &Path, bytes: &[u8]) -> Result<(), wasm_bindgen::JsValue> {
    use wasm_bindgen::JsCast;
    let parts = js_sys::Array::of1(&js_sys::Uint8Array::from(bytes));
    let blob = web_sys::Blob::new_with_u8_array_sequence(&parts)?;
    let url = web_sys::Url::create_object_url_with_blob(&blob)?;
    let document = web_sys::window().and_then(|window| window.document()).ok_or("there is no page")?;
    let link = document.create_element("a")?.unchecked_into::<web_sys::HtmlAnchorElement>();
    link.set_href(&url);
    link.set_download(&path.file_name().unwrap_or_default().to_string_lossy());
    link.click();
    web_sys::Url::revoke_object_url(&url)
}

/// Copies a link for others to open, on a page with the address of the page before it: what was copied.
pub(crate) fn share(ctx: &egui::Context, link: &str) -> String {
    let text = address() + link;
    ctx.copy_text(text.clone());
    text
}

/// The address of the page; nothing where there is none.
#[cfg(target_family = "wasm")]
fn address() -> String {
    let place = web_sys::window().and_then(|window| window.location().href().ok());
    place.and_then(|place| place.split('#').next().map(str::to_owned)).unwrap_or_default()
}

/// The address of the page: a window has none.
#[cfg(not(target_family = "wasm"))]
fn address() -> String {
    String::new()
}

/// The first of `stem-001.ending`, `stem-002.ending`, … that does not exist in `folder`.
pub(crate) fn free(folder: &Path, stem: &str, ending: &str) -> PathBuf {
    let name = |number: u32| {
        let dot = if ending.is_empty() { "" } else { "." };
        folder.join(format!("{stem}-{number:03}{dot}{ending}"))
    };
    (1..=u32::MAX).map(name).find(|path| !path.exists()).unwrap_or_else(|| name(0))
}
