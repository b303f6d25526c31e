//! Opening the lab on a web page, and what it has of the browser: its address, its storage, and the question before a tab with
//! unsaved changes is closed.

use crate::app::LabApp;
use crate::app_state::AppState;
use crate::autosave::{Autosave, RecoverableWork, work_of};
use crate::options::Options;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use wasm_bindgen::prelude::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::{Event, EventTarget, HtmlCanvasElement, Storage, WebGl2RenderingContext};
use web_time::Instant;

/// Keys of the browser's storage under which tabs keep unsaved work begin with this; the time at which the tab was opened
/// follows, ms.
const WORK: &str = "echelon-work-";
/// Why nothing is drawn where there is neither WebGPU nor WebGL 2.
const NO_WEBGL: &str = "This browser offers neither WebGPU nor WebGL 2, with which the lab draws. Allow it to use the graphics \
                        card, or take another browser. `echelon lab` opens the same window without a browser.";
/// Why nothing is drawn any more where the browser has taken the device away.
const LOST: &str =
    "The browser has taken the graphics device away. Load the page again: it offers your unsaved changes.";

/// What draws, by the extension `WEBGL_debug_renderer_info`.
const UNMASKED_RENDERER: u32 = 0x9246;

/// Whether the scene has changes that are not saved.
static UNSAVED: AtomicBool = AtomicBool::new(false);
/// Whether unsaved work is kept at all.
static KEEPS: AtomicBool = AtomicBool::new(true);

thread_local! {
    /// The canvas, and what it says of itself.
    static SHOWN: RefCell<Option<(HtmlCanvasElement, String)>> = const { RefCell::new(None) };
}

/// Shows the lab in the canvas of the page that has this id, until the page is left. The canvas may say under which key this
/// tab keeps unsaved work, `data-work`, with "" where it keeps none, and which tabs are open besides, `data-open`. The address may carry a link, of
/// which the simplest names a scene that comes with the program, `#circle-three`. What goes wrong stands in the console, and
/// in the element with the id `fault` if there is one.
pub fn open_on_page(canvas: &'static str) {
    let began = Instant::now();
    std::panic::set_hook(Box::new(|info| {
        tell(&format!(
            "The lab ended because of a bug: {info}. Load the page again: it offers your unsaved changes."
        ));
    }));
    wasm_bindgen_futures::spawn_local(async move {
        let found = document().and_then(|document| document.get_element_by_id(canvas));
        let Some(canvas) = found.and_then(|element| element.dyn_into::<HtmlCanvasElement>().ok()) else {
            return tell(&format!("The page has no canvas with the id {canvas}."));
        };
        // A browser complains in its console where it is asked for a card that is not there.
        let backends = if draws_on_card() && offers_webgpu().await {
            wgpu::Backends::BROWSER_WEBGPU
        } else if webgl(&canvas).is_some() {
            wgpu::Backends::GL
        } else {
            return tell(NO_WEBGL);
        };
        SHOWN.set(Some((canvas.clone(), String::new())));
        listen(&canvas, "webglcontextlost", |_| tell(LOST));
        if let Some(window) = web_sys::window() {
            listen(&window, "beforeunload", |event| {
                if UNSAVED.load(Relaxed) {
                    event.prevent_default();
                }
            });
        }
        let place =
            canvas.get_attribute("data-work").unwrap_or_else(|| format!("{WORK}{:.0}", js_sys::Date::now()));
        let open = canvas.get_attribute("data-open").unwrap_or_default();
        let web = eframe::WebOptions {
            wgpu_options: WgpuConfiguration { wgpu_setup: setup(backends), ..WgpuConfiguration::default() },
            // It would cost as much as the rest on a processor that draws.
            dithering: false,
            ..eframe::WebOptions::default()
        };
        let make: eframe::AppCreator<'static> = Box::new(move |context| {
            let ended = Arc::new(Mutex::new(None));
            let options = Options { scene: named().map(PathBuf::from), ..Options::default() };
            let keeps = !place.is_empty();
            KEEPS.store(keeps, Relaxed);
            let left = if keeps { left(&open) } else { None };
            let autosave = Autosave::at(keeps.then(|| PathBuf::from(place)));
            let mut lab = LabApp::new(context, &options, autosave, left, began, ended)?;
            // Beside the text of a lesson, the text says what to try.
            lab.hints &= keeps;
            if storage().is_none() && keeps {
                let words = "The browser keeps nothing for this page: unsaved changes end with it";
                lab.app_state.say(words, true);
            }
            Ok(Box::new(lab))
        });
        if let Err(error) = eframe::WebRunner::new().start(canvas, web, make).await {
            let why = error.as_string().unwrap_or_else(|| format!("{error:?}"));
            tell(&format!(
                "The lab cannot be shown: {why}. `echelon lab` opens the same window without a browser."
            ));
        }
    });
}

fn document() -> Option<web_sys::Document> {
    web_sys::window()?.document()
}

/// Whether the browser draws on a graphics card; a processor draws faster with WebGL than with WebGPU.
fn draws_on_card() -> bool {
    let canvas = document().and_then(|document| document.create_element("canvas").ok());
    let context = canvas.and_then(|canvas| webgl(canvas.unchecked_ref()));
    let name = context.and_then(|context| {
        // Chromium tells the name where this is asked for, others always.
        let asked = context.get_extension("WEBGL_debug_renderer_info").ok().flatten();
        let parameter = asked.map_or(WebGl2RenderingContext::RENDERER, |_| UNMASKED_RENDERER);
        context.get_parameter(parameter).ok()?.as_string()
    });
    name.is_some_and(|name| !rendering::draws_on_processor(&name))
}

/// Whether the browser has a device for WebGPU. It offers one to pages of this machine and to those by https.
async fn offers_webgpu() -> bool {
    web_sys::window().is_some_and(|window| window.is_secure_context())
        && wgpu::util::is_browser_webgpu_supported().await
}

/// What draws into the canvas with WebGL 2. What is drawn here comes from a texture, so it needs neither samples nor depth of
/// its own. (Without alpha, a browser would convert every pixel.)
fn webgl(canvas: &HtmlCanvasElement) -> Option<WebGl2RenderingContext> {
    let attributes = js_sys::Object::new();
    for name in ["antialias", "depth", "stencil"] {
        // A plain object takes every property.
        let _ = js_sys::Reflect::set(&attributes, &name.into(), &JsValue::FALSE);
    }
    canvas.get_context_with_context_options("webgl2", &attributes).ok()??.dyn_into().ok()
}

/// Calls `act` for every event of this name, as long as the page is shown.
fn listen(target: &EventTarget, name: &str, act: impl FnMut(Event) + 'static) {
    let act = Closure::<dyn FnMut(Event)>::new(act);
    // Every target takes listeners.
    let _ = target.add_event_listener_with_callback(name, act.as_ref().unchecked_ref());
    act.forget();
}

/// The link in the address, from its `#` on.
fn named() -> Option<String> {
    let hash = web_sys::window()?.location().hash().ok()?;
    (hash.len() > 1).then_some(hash)
}

/// Keeps the page informed: its title, what the canvas shows, for those who cannot see it, and whether closing it loses work;
/// `offers` says whether it offers the work of a tab that was closed.
pub(crate) fn show_state(app_state: &AppState, offers: bool) {
    UNSAVED.store(KEEPS.load(Relaxed) && app_state.unsaved(), Relaxed);
    let Some(scene) = app_state.scene() else { return };
    let branch = app_state.branches.get(app_state.branch).map_or("", |branch| &branch.name);
    let moves = if app_state.playing { "playing" } else { "paused" };
    let status = app_state.status.as_ref().map_or_else(String::new, |status| format!(". {}", status.text));
    let offer = if offers { ". Unsaved work of a closed tab is offered" } else { "" };
    let words =
        format!("{}: {:.2} s, {moves}, branch {branch}{status}{offer}", scene.title, app_state.time());
    SHOWN.with_borrow_mut(|shown| {
        let Some((canvas, said)) = shown.as_mut().filter(|(_, said)| *said != words) else { return };
        // Without it the page is as it was.
        let _ = canvas.set_attribute("aria-label", &words);
        *said = words;
        let title = format!("{} — Echelon", scene.title);
        if let Some(document) = document().filter(|document| document.title() != title) {
            document.set_title(&title);
        }
    });
}

/// The browser's storage; `None` where it is denied.
fn storage() -> Option<Storage> {
    web_sys::window()?.local_storage().ok()?
}

/// Keeps unsaved work in the browser's storage, if there is one.
pub(crate) fn put(place: &Path, text: &str) -> Result<(), String> {
    let Some(storage) = storage() else { return Ok(()) };
    let why = |error: JsValue| {
        error.dyn_into::<js_sys::Error>().map_or_else(|_| "no reason given".into(), |e| e.message().into())
    };
    storage.set_item(&place.to_string_lossy(), text).map_err(why)
}

/// Removes unsaved work.
pub(crate) fn discard(place: &Path) {
    if let Some(storage) = storage() {
        // It may not exist.
        let _ = storage.remove_item(&place.to_string_lossy());
    }
}

/// The newest work of a tab that was closed; `open` names those that are not, with spaces between.
fn left(open: &str) -> Option<RecoverableWork> {
    let storage = storage()?;
    let keys = (0..storage.length().ok()?).filter_map(|index| storage.key(index).ok()?);
    let opened = |key: &String| key.strip_prefix(WORK).and_then(|time| time.parse::<u64>().ok());
    let closed = keys.filter(|key| open.split(' ').all(|open| open != key));
    let (_, key) = closed.filter_map(|key| Some((opened(&key)?, key))).max()?;
    work_of(PathBuf::from(&key), &storage.get_item(&key).ok()??)
}

/// A device with what the pictures need, within the limits of WebGL 2.
fn setup(backends: wgpu::Backends) -> WgpuSetup {
    let mut new = WgpuSetupCreateNew::without_display_handle();
    new.instance_descriptor.backends = backends;
    new.power_preference = wgpu::PowerPreference::HighPerformance;
    new.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("echelon lab"),
        required_limits: wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
        memory_hints: wgpu::MemoryHints::MemoryUsage,
        ..wgpu::DeviceDescriptor::default()
    });
    WgpuSetup::CreateNew(new)
}

/// Files of the page that are fetched by name.
pub(crate) struct Fetched {
    sender: Sender<(&'static str, Vec<u8>)>,
    receiver: Receiver<(&'static str, Vec<u8>)>,
}

impl Default for Fetched {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self { sender, receiver }
    }
}

impl Fetched {
    /// Fetches a file of the page; `None`, since it comes later. One that is missing never comes.
    pub(crate) fn fetch(
        &self,
        name: &'static str,
        file: String,
        ctx: &egui::Context,
    ) -> Option<egui::ColorImage> {
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        wasm_bindgen_futures::spawn_local(async move {
            if let Ok(bytes) = fetch(&file).await {
                // A page that is left does not wait for it.
                let _ = sender.send((name, bytes));
                ctx.request_repaint();
            }
        });
        None
    }

    /// The next file that came.
    pub(crate) fn next(&self) -> Option<(&'static str, Vec<u8>)> {
        self.receiver.try_recv().ok()
    }
}

async fn fetch(file: &str) -> Result<Vec<u8>, JsValue> {
    let window = web_sys::window().ok_or("there is no page")?;
    let response = wasm_bindgen_futures::JsFuture::from(window.fetch_with_str(file)).await?;
    let buffer = response.unchecked_into::<web_sys::Response>().array_buffer()?;
    Ok(js_sys::Uint8Array::new(&wasm_bindgen_futures::JsFuture::from(buffer).await?).to_vec())
}

/// Tells the reader of the page what went wrong.
fn tell(text: &str) {
    web_sys::console::error_1(&text.into());
    if let Some(place) = document().and_then(|document| document.get_element_by_id("fault")) {
        place.set_text_content(Some(text));
    }
}
