//! Finding and opening a graphics adapter, with or without a display.

use crate::Error;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use wgpu::{Adapter, AdapterInfo as Info, Backend, Backends, DeviceType, Instance};

/// Which adapter to draw with.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// A hardware adapter before a software one, Vulkan before GL.
    #[default]
    Auto,
    /// The first whose backend (`vulkan`, `gl`, `metal`, `dx12`) this is, or whose name contains it; case does not count.
    Named(String),
}

impl From<&str> for AdapterChoice {
    fn from(name: &str) -> Self {
        if name.is_empty() || name.eq_ignore_ascii_case("auto") {
            Self::Auto
        } else {
            Self::Named(name.to_owned())
        }
    }
}

/// What the machine offers, for humans.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterInfo {
    /// As the driver calls itself.
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
            software: info.device_type == DeviceType::Cpu || info.name.contains("llvmpipe"),
        }
    }
}

/// All adapters of this machine, in the order in which `Auto` would take them.
pub fn adapters() -> Vec<AdapterInfo> {
    sorted(Backends::all()).iter().map(|a| AdapterInfo::new(&a.get_info())).collect()
}

/// An open graphics device.
#[derive(Debug, Clone)]
pub struct Gpu {
    /// The logical device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    info: AdapterInfo,
    fault: Arc<Mutex<Fault>>,
}

/// What a device has complained of.
#[derive(Debug, Default)]
struct Fault {
    /// Since somebody asked last.
    error: Option<String>,
    /// For ever.
    lost: Option<String>,
}

impl Gpu {
    /// Opens the adapter of `choice`.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] where none fits, [`Error::Device`] where it cannot be opened.
    pub fn open(choice: &AdapterChoice) -> Result<Self, Error> {
        let adapter = choose(choice)?;
        Self::from_adapter(&adapter)
    }

    /// Opens `adapter`, for a window that has chosen one to fit its surface.
    ///
    /// # Errors
    /// [`Error::Device`] where it cannot be opened.
    pub fn from_adapter(adapter: &Adapter) -> Result<Self, Error> {
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("echelon"),
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| Error::Device(e.to_string()))?;
        Ok(Self::from_device(device, queue, &adapter.get_info()))
    }

    /// Takes over a device that a window has opened, with any limits from those of WebGL 2 on. Once for each device: it
    /// replaces what the device does about errors, by default to end the process, and every renderer on the device takes
    /// this or a clone of it. Errors of others on that device surface in the next draw, too.
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, info: &Info) -> Self {
        let fault = Arc::new(Mutex::new(Fault::default()));
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

fn held(fault: &Mutex<Fault>) -> MutexGuard<'_, Fault> {
    fault.lock().unwrap_or_else(PoisonError::into_inner)
}

fn choose(choice: &AdapterChoice) -> Result<Adapter, Error> {
    match choice {
        // Asking the backends one after the other saves starting those that are not needed.
        AdapterChoice::Auto => [Backends::VULKAN | Backends::METAL | Backends::DX12, Backends::GL]
            .into_iter()
            .find_map(|backends| sorted(backends).into_iter().next())
            .ok_or_else(|| Error::NoAdapter { wanted: None, found: found() }),
        AdapterChoice::Named(name) => sorted(Backends::all())
            .into_iter()
            .find(|a| fits(&a.get_info(), name))
            .ok_or_else(|| Error::NoAdapter { wanted: Some(name.clone()), found: found() }),
    }
}

fn fits(info: &Info, name: &str) -> bool {
    info.backend.to_str().eq_ignore_ascii_case(name)
        || info.name.to_lowercase().contains(&name.to_lowercase())
}

fn sorted(backends: Backends) -> Vec<Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // Validation layers are for developers of drivers; they cost time at every start.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let mut all = pollster::block_on(Instance::new(descriptor).enumerate_adapters(backends));
    all.sort_by_key(|a| rank(&a.get_info()));
    all
}

fn rank(info: &Info) -> (u8, u8) {
    let kind = match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    let backend = match info.backend {
        Backend::Vulkan | Backend::Metal => 0,
        Backend::Dx12 => 1,
        _ => 2,
    };
    (kind, backend)
}

fn found() -> String {
    let all: Vec<_> = adapters().iter().map(|a| format!("{} ({})", a.name, a.backend)).collect();
    if all.is_empty() {
        "this machine has none".into()
    } else {
        format!("this machine has {}", all.join(", "))
    }
}
