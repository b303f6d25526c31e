//! Opening the lab on a web page.

use crate::app::LabApp;
use crate::options::Options;
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex};
use wasm_bindgen::{JsCast, JsValue};
use web_sys::HtmlCanvasElement;
use web_time::Instant;

/// Shows the lab in the canvas of the page that has this id, until the page is left. What goes wrong stands in the console,
/// and in the element with the id `fault` if there is one.
pub fn open_on_page(canvas: &'static str) {
    let began = Instant::now();
    std::panic::set_hook(Box::new(|info| tell(&format!("the lab ended because of a bug: {info}"))));
    wasm_bindgen_futures::spawn_local(async move {
        let document = web_sys::window().and_then(|window| window.document());
        let found = document.and_then(|document| document.get_element_by_id(canvas));
        let Some(canvas) = found.and_then(|element| element.dyn_into::<HtmlCanvasElement>().ok()) else {
            return tell(&format!("the page has no canvas with the id {canvas}"));
        };
        let web = eframe::WebOptions {
            wgpu_options: WgpuConfiguration { wgpu_setup: setup(), ..WgpuConfiguration::default() },
            // It would cost as much as the rest on a processor that draws.
            dithering: false,
            ..eframe::WebOptions::default()
        };
        let make: eframe::AppCreator<'static> = Box::new(move |context| {
            let ended = Arc::new(Mutex::new(None));
            Ok(Box::new(LabApp::new(context, &Options::default(), None, began, ended)?))
        });
        if let Err(error) = eframe::WebRunner::new().start(canvas, web, make).await {
            let why = error.as_string().unwrap_or_else(|| format!("{error:?}"));
            tell(&format!("the lab cannot be shown: {why}. It needs WebGL 2"));
        }
    });
}

/// A device with what the pictures need, within the limits of WebGL 2.
fn setup() -> WgpuSetup {
    let mut new = WgpuSetupCreateNew::without_display_handle();
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
    let document = web_sys::window().and_then(|window| window.document());
    if let Some(place) = document.and_then(|document| document.get_element_by_id("fault")) {
        place.set_text_content(Some(text));
    }
}
