//! Finding and opening a graphics adapter, with or without a display. A page gets its device from the browser instead.

use super::{AdapterInfo, Gpu};
use crate::Error;
use wgpu::{Adapter, AdapterInfo as Info, Backend, Backends, DeviceType, Instance};

/// Which adapter to draw with.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// A hardware adapter before a software one, Vulkan before GL.
    #[default]
    Auto,
    /// The first that fits; case does not count. `vulkan`, `gl`, `metal` and `dx12` are backends, `vulkan:llvmpipe` is one of
    /// a backend whose name or driver contains a word, a word alone one of any backend, and a number its place in
    /// [`adapters`]. `lavapipe` is `vulkan:llvmpipe`, and `opengl` is `gl`, as people call them.
    Named(String),
}

impl AdapterChoice {
    /// Those of some adapters that it means, the one it would take first; for a window, which may not take all.
    pub fn among(&self, adapters: &[Adapter]) -> Vec<Adapter> {
        let mut all: Vec<_> = adapters.iter().map(|adapter| (adapter.get_info(), adapter)).collect();
        all.sort_by_key(|(info, _)| rank(info));
        let fits = |(place, (info, _)): &(usize, (Info, &Adapter))| match self {
            Self::Auto => true,
            Self::Named(name) => fits(&AdapterInfo::new(info), *place, name),
        };
        all.into_iter().enumerate().filter(fits).map(|(_, (_, adapter))| adapter.clone()).collect()
    }
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

/// All adapters of this machine, in the order in which `Auto` would take them.
pub fn adapters() -> Vec<AdapterInfo> {
    sorted(Backends::all()).iter().map(|a| AdapterInfo::new(&a.get_info())).collect()
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
}

fn choose(choice: &AdapterChoice) -> Result<Adapter, Error> {
    match choice {
        // Asking the backends one after the other saves starting those that are not needed.
        AdapterChoice::Auto => [Backends::VULKAN | Backends::METAL | Backends::DX12, Backends::GL]
            .into_iter()
            .find_map(|backends| sorted(backends).into_iter().next())
            .ok_or_else(|| Error::NoAdapter { wanted: None, found: found() }),
        AdapterChoice::Named(name) => {
            let meant = choice.among(&sorted(Backends::all())).into_iter().next();
            meant.ok_or_else(|| Error::NoAdapter { wanted: Some(name.clone()), found: found() })
        }
    }
}

const BACKENDS: [&str; 4] = ["vulkan", "gl", "metal", "dx12"];

/// Names that people know them by, and what they are called here.
const ALIASES: [(&str, &str); 2] = [("lavapipe", "vulkan:llvmpipe"), ("opengl", "gl")];

/// Whether an adapter at a place of the list is the one that a name means.
fn fits(info: &AdapterInfo, place: usize, name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let name =
        ALIASES.iter().find(|(alias, _)| *alias == name).map_or(name, |(_, known)| (*known).to_owned());
    let name = name.strip_prefix("opengl:").map_or(name.clone(), |word| format!("gl:{word}"));
    if name.bytes().all(|byte| byte.is_ascii_digit()) {
        return name.parse() == Ok(place);
    }
    if BACKENDS.contains(&name.as_str()) {
        return info.backend == name;
    }
    let (backend, word) = match name.split_once(':') {
        Some((backend, word)) if BACKENDS.contains(&backend) => (Some(backend), word.trim()),
        _ => (None, name.as_str()),
    };
    // What stands in brackets are versions, which change with every driver.
    let called = |text: &str| text.split(" (").next().unwrap_or_default().to_lowercase().contains(word);
    backend.is_none_or(|backend| info.backend == backend)
        && word.chars().any(char::is_alphabetic)
        && (called(&info.name) || called(&info.driver))
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
    let numbered = |(place, a): (usize, &AdapterInfo)| format!("{place}: {}, {}", a.backend, a.name);
    let all: Vec<_> = adapters().iter().enumerate().map(numbered).collect();
    if all.is_empty() {
        "this machine has none. A software one comes with `apt-get install mesa-vulkan-drivers` (Debian, Ubuntu)".into()
    } else {
        format!("this machine has {}", all.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(name: &str, backend: &str, driver: &str) -> AdapterInfo {
        AdapterInfo { name: name.into(), backend: backend.into(), driver: driver.into(), software: true }
    }

    /// The place of the adapter that a name means on a machine with lavapipe and its GL sister.
    fn found(all: &[AdapterInfo], name: &str) -> Option<usize> {
        all.iter().enumerate().position(|(place, info)| fits(info, place, name))
    }

    #[test]
    fn a_name_means_one_adapter() {
        let vulkan =
            adapter("llvmpipe (LLVM 15.0.6, 256 bits)", "vulkan", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)");
        let gl = adapter("llvmpipe (LLVM 15.0.6, 256 bits)", "gl", "4.5 (Core Profile) Mesa 22.3.6");
        let card = adapter("NVIDIA H200", "vulkan", "NVIDIA 570.1");
        let all = [card.clone(), vulkan, gl.clone()];
        for (name, place) in [
            ("vulkan", Some(0)),
            ("gl", Some(2)),
            ("metal", None),
            ("llvmpipe", Some(1)),
            ("vulkan:llvmpipe", Some(1)),
            ("GL:LLVMpipe", Some(2)),
            ("lavapipe", Some(1)),
            ("OpenGL", Some(2)),
            ("opengl:llvmpipe", Some(2)),
            ("h200", Some(0)),
            ("0", Some(0)),
            ("2", Some(2)),
            // A number is a place, and no part of a version.
            ("3", None),
            ("15", None),
            ("15.0.6", None),
            ("22.3", None),
            ("vulkan:", None),
            ("", None),
        ] {
            assert_eq!(found(&all, name), place, "{name}");
        }
        // A backend that is named and not there is not replaced by another.
        for name in ["vulkan:llvmpipe", "lavapipe"] {
            assert_eq!(found(&[card.clone(), gl.clone()], name), None);
        }
        assert_eq!(found(&[card], "opengl"), None);
    }
}
