//! Opening the window, and closing it without losing anything.

use crate::Error;
use crate::app::LabApp;
use crate::autosave::{Autosave, alive, left};
use crate::options::Options;
use crate::window_guard::guarded;
use eframe::egui::ViewportBuilder;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::sync::{Arc, Mutex, PoisonError};
use web_time::Instant;

/// Name under which the window keeps its arrangement.
const NAME: &str = "echelon-lab";

/// Shows the window until it is closed.
///
/// # Errors
/// [`Error::Window`] where there is no window system or no adapter, or where it was lost.
pub fn open(options: Options) -> Result<(), Error> {
    let began = Instant::now();
    let size = options.size.unwrap_or([1280.0, 800.0]);
    let viewport = ViewportBuilder::default()
        .with_title("Echelon")
        .with_app_id(NAME)
        .with_inner_size(size)
        .with_min_inner_size([320.0, 240.0])
        .with_drag_and_drop(true);
    let native = eframe::NativeOptions {
        viewport,
        wgpu_options: WgpuConfiguration {
            wgpu_setup: setup(&options.adapter),
            ..WgpuConfiguration::default()
        },
        // A size that was asked for is not overruled by the last one.
        persist_window: options.size.is_none(),
        // It would cost as much as the rest on a processor that draws.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let abandon = options.abandon.unwrap_or(|_| ());
    let ended = Arc::new(Mutex::new(None));
    let why = Arc::clone(&ended);
    let folder = eframe::storage_dir(NAME);
    let left = folder.as_deref().and_then(|folder| left(folder, alive));
    let autosave = Autosave::new(folder.as_deref());
    let show = || {
        eframe::run_native(
            NAME,
            native,
            Box::new(move |context| {
                let lab = LabApp::new(context, &options, autosave, left, began, why)?;
                Ok(Box::new(lab))
            }),
        )
    };
    let made = guarded(show, abandon).map_err(Error::Window)?;
    let ended: Option<Error> = ended.lock().unwrap_or_else(PoisonError::into_inner).take();
    match (made, ended) {
        (Ok(()), None) => Ok(()),
        (_, Some(why)) => Err(why),
        (Err(error), None) => Err(Error::Window(explained(&error.to_string()))),
    }
}

/// A device with what the pictures need, on the adapter that was asked for.
fn setup(adapter: &str) -> WgpuSetup {
    let mut new = WgpuSetupCreateNew::without_display_handle();
    // Validation layers are for developers of drivers.
    new.instance_descriptor.flags = wgpu::InstanceFlags::empty();
    new.power_preference = wgpu::PowerPreference::HighPerformance;
    new.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("echelon lab"),
        required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
        memory_hints: wgpu::MemoryHints::MemoryUsage,
        ..wgpu::DeviceDescriptor::default()
    });
    let wanted = adapter.to_lowercase();
    if !wanted.is_empty() && wanted != "auto" {
        new.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
            let shows = |adapter: &&wgpu::Adapter| surface.is_none_or(|s| adapter.is_surface_supported(s));
            let meant = rendering::AdapterChoice::from(wanted.as_str()).among(adapters);
            meant.iter().find(shows).cloned().ok_or_else(|| {
                format!("no adapter for `{wanted}` can show a window; `echelon doctor` lists what there is")
            })
        }));
    }
    WgpuSetup::CreateNew(new)
}

/// What a library says, without its own name and the place in its source, which is that of whoever built it.
fn plain(error: &str) -> &str {
    let error = error.rsplit("failed: ").next().unwrap_or(error);
    let at_place = error.split_once("os error at ").and_then(|(_, rest)| rest.split_once(": "));
    at_place.map_or(error, |(_, words)| words).trim_end_matches('.')
}

/// What a person can do where no window can be opened.
fn explained(error: &str) -> String {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let displayed = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].into_iter().any(set);
    let why = if cfg!(target_os = "linux") && !displayed {
        "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)"
    } else {
        plain(error)
    };
    format!(
        "the window cannot be opened: {why}. The lab needs a desktop (X11 or Wayland; Xvfb serves too) and an adapter, see \
         `echelon doctor`; `echelon film` and `echelon capture` need neither"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_show_no_place_of_whoever_built_it() {
        let told = "winit EventLoopError: os error at /home/builder/.cargo/registry/src/index-1/winit-0.30.13/src/mod.rs:788: \
                    Failed to open connection to X server";
        assert_eq!(plain(told), "Failed to open connection to X server");
        assert_eq!(
            plain("wgpu failed: no adapter for `x` can show a window."),
            "no adapter for `x` can show a window"
        );
        assert!(!explained(told).contains("/home"));
    }
}
