//! An open graphics device, and what it says of errors.

#[cfg(not(target_family = "wasm"))]
pub(crate) mod adapters;
pub(crate) mod atlas;
pub(crate) mod camera_renderer;
pub(crate) mod encode;
pub(crate) mod model;
pub(crate) mod passes;
pub(crate) mod props;
pub(crate) mod resources;
pub(crate) mod robot_groups;
pub(crate) mod robot_models;
pub(crate) mod target;
pub(crate) mod world_passes;

use crate::Error;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::{AdapterInfo as Info, DeviceType};

/// What the machine offers, for humans.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterInfo {
    /// The adapter's name.
    pub name: String,
    /// `vulkan`, `gl`, `metal` or `dx12`.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether it draws on the processor.
    pub software: bool,
}

impl AdapterInfo {
    fn new(info: &Info) -> Self {
        Self {
            name: info.name.clone(),
            backend: info.backend.to_str().to_owned(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            software: info.device_type == DeviceType::Cpu || draws_on_processor(&info.name),
        }
    }
}

/// Whether an adapter of this name draws on the processor: GL and browsers tell the name alone, with others around it.
pub fn draws_on_processor(name: &str) -> bool {
    let name = name.to_lowercase();
    ["llvmpipe", "softpipe", "swiftshader", "basic render"].iter().any(|known| name.contains(known))
}

/// An open graphics device.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// The logical device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    info: AdapterInfo,
    fault: Arc<Mutex<DeviceFault>>,
}

/// Errors that a device has reported.
#[derive(Debug, Default)]
struct DeviceFault {
    /// Since the last query.
    error: Option<String>,
    /// Permanent.
    lost: Option<String>,
}

impl Gpu {
    /// Takes over a device that a window has opened, with any limits from those of WebGL 2 on. Once for each device: it
    /// replaces what the device does about errors, by default to end the process, and every renderer on the device takes
    /// this or a clone of it. Errors of others on that device surface in the next draw, too.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, info: &Info) -> Self {
        let fault = Arc::new(Mutex::new(DeviceFault::default()));
        let seen = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error| {
            held(&seen).error.get_or_insert_with(|| error.to_string());
        }));
        let seen = Arc::clone(&fault);
        device.set_device_lost_callback(move |_, why| {
            held(&seen).lost.get_or_insert_with(|| format!("it was lost ({why})"));
        });
        Self { device, queue, info: AdapterInfo::new(info), fault }
    }

    /// Adapter, backend and driver in one line, for a manifest.
    pub fn description(&self) -> String {
        format!("{} ({}, {})", self.info.name, self.info.backend, self.info.driver)
    }

    /// What was opened.
    pub fn info(&self) -> &AdapterInfo {
        &self.info
    }

    /// Why the device is gone, if it is.
    pub fn lost(&self) -> Option<String> {
        held(&self.fault).lost.clone()
    }

    /// The error that the device reported since the last call, if any; a device that is lost says so every time.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let mut fault = held(&self.fault);
        let error = fault.error.take();
        fault.lost.clone().or(error).map_or(Ok(()), |text| Err(Error::Device(text)))
    }
}

fn held(fault: &Mutex<DeviceFault>) -> MutexGuard<'_, DeviceFault> {
    fault.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::draws_on_processor;

    #[test]
    fn software_is_known_by_its_name_in_a_browser() {
        let vulkan = "Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE))";
        assert!(draws_on_processor(&format!("ANGLE (Google, {vulkan}, SwiftShader driver)")));
        assert!(draws_on_processor("ANGLE (Mesa, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5)"));
        assert!(draws_on_processor("ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11, D3D11)"));
        assert!(!draws_on_processor("ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)"));
    }
}
