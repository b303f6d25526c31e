//! A control law for Echelon, in Rust: `docs/law-modules.md`. Numbers are in m, s and rad.
#![no_std]

pub use math::*;

/// What a law is told of one leader.
#[repr(C)]
#[derive(Debug)]
pub struct Leader {
    pub distance: f64,
    pub bearing: f64,
    pub view_angle: f64,
    pub distance_rate: f64,
    pub bearing_rate: f64,
    pub wanted_distance: f64,
    pub wanted_bearing: f64,
    pub wanted_distance_rate: f64,
    pub wanted_bearing_rate: f64,
    pub wanted_distance_acceleration: f64,
    pub wanted_bearing_acceleration: f64,
    /// This and what follows are told to laws that know "motion" only.
    pub speed: f64,
    pub acceleration: f64,
    pub turn_rate: f64,
    pub turn_acceleration: f64,
    pub heading: f64,
    pub frame_turn_rate: f64,
    pub frame_turn_acceleration: f64,
}

/// What a law with `N` leaders is told at an instant.
#[repr(C)]
#[derive(Debug)]
pub struct Told<const N: usize = 1> {
    pub time: f64,
    pub period: f64,
    pub own_speed: f64,
    pub own_acceleration: f64,
    pub own_turn_rate: f64,
    pub leaders: [Leader; N],
}

/// What the follower asks for, in m/s² and rad/s.
#[repr(C)]
#[derive(Debug)]
pub struct Command {
    pub acceleration: f64,
    pub turn_rate: f64,
}

/// Room through which the numbers go in and out.
#[repr(C)]
pub struct Region(core::cell::UnsafeCell<[f64; 1024]>);

// A module has one thread.
unsafe impl Sync for Region {}

impl Region {
    #[doc(hidden)]
    pub const NEW: Self = Self(core::cell::UnsafeCell::new([0.0; 1024]));
}

/// The exports of a law: its declaration, the text of which is JSON, and its functions. Those after `decide` may be left out.
/// Structs of its numbers are `#[repr(C)]`, of `f64`, in the order of the declaration; `()` where there are none.
#[macro_export]
macro_rules! law {
    (declaration: $text:literal, told: $told:ty, parameters: $parameters:ty, memory: $memory:ty, shown: $shown:ty,
     decide: $decide:path $(, start: $start:path)? $(, derive: $derive:path)? $(,)?) => {
        const _: () = {
            static REGION: $crate::Region = $crate::Region::NEW;

            #[unsafe(export_name = "region")]
            extern "C" fn exported_region() -> *const $crate::Region {
                &REGION
            }

            #[unsafe(export_name = "declaration")]
            extern "C" fn exported_declaration() -> *const u8 {
                concat!($text, "\0").as_ptr()
            }

            #[unsafe(export_name = "decide")]
            extern "C" fn exported_decide(told: &$told, own: &$parameters, memory: &mut $memory, shown: &mut $shown,
                                 command: &mut $crate::Command) {
                *command = $decide(told, own, memory, shown);
            }

            $(#[unsafe(export_name = "start")]
            extern "C" fn exported_start(told: &$told, own: &$parameters, memory: &mut $memory) {
                *memory = $start(told, own);
            })?

            $(#[unsafe(export_name = "derive")]
            extern "C" fn exported_derive(told: &$told, own: &$parameters, memory: &$memory, rates: &mut $memory,
                                 command: &mut $crate::Command) {
                *command = $derive(told, own, memory, rates);
            })?
        };
    };
}

/// Elementary functions of the program, the same on every machine.
mod math {
    #[link(wasm_import_module = "env")]
    unsafe extern "C" {
        pub safe fn sin(x: f64) -> f64;
        pub safe fn cos(x: f64) -> f64;
        pub safe fn tan(x: f64) -> f64;
        pub safe fn asin(x: f64) -> f64;
        pub safe fn acos(x: f64) -> f64;
        pub safe fn atan(x: f64) -> f64;
        pub safe fn atan2(y: f64, x: f64) -> f64;
        pub safe fn exp(x: f64) -> f64;
        pub safe fn ln(x: f64) -> f64;
        pub safe fn tanh(x: f64) -> f64;
        pub safe fn pow(x: f64, y: f64) -> f64;
        pub safe fn sqrt(x: f64) -> f64;
        pub safe fn floor(x: f64) -> f64;
        pub safe fn hypot(x: f64, y: f64) -> f64;
        /// An angle brought into (−π, π].
        pub safe fn wrap(angle: f64) -> f64;
        /// Normally distributed, mean 0, variance 1; another for each index, sample and robot.
        pub safe fn noise(index: u32) -> f64;
    }
}

#[panic_handler]
#[cfg(target_arch = "wasm32")]
fn broken_off(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
