//! What a module may import: elementary functions, the same as those of everything else, and noise.

use crate::Noise;
use vocabulary::{math, wrap};
use wasmi::{Caller, Engine, Error, Linker, StoreLimits, TrapCode, ValType};

/// The module name under which functions are imported: that of C's undefined functions.
pub(super) const FROM: &str = "env";

/// Instructions that a function counts for, about as long as it takes.
pub(super) const PRICE: u64 = 20;

/// A function that a module may import; all return an `f64`.
#[derive(Clone, Copy)]
pub(super) enum Offer {
    OfOne(fn(f64) -> f64),
    OfTwo(fn(f64, f64) -> f64),
    /// Of an index.
    Noise,
}

/// What a module may import from [`FROM`].
pub(super) const OFFERED: [(&str, Offer); 16] = [
    ("sin", Offer::OfOne(math::sin)),
    ("cos", Offer::OfOne(math::cos)),
    ("tan", Offer::OfOne(math::tan)),
    ("asin", Offer::OfOne(math::asin)),
    ("acos", Offer::OfOne(math::acos)),
    ("atan", Offer::OfOne(math::atan)),
    ("atan2", Offer::OfTwo(math::atan2)),
    ("exp", Offer::OfOne(math::exp)),
    ("ln", Offer::OfOne(math::ln)),
    ("tanh", Offer::OfOne(math::tanh)),
    ("pow", Offer::OfTwo(math::powf)),
    ("sqrt", Offer::OfOne(f64::sqrt)),
    ("floor", Offer::OfOne(f64::floor)),
    ("hypot", Offer::OfTwo(math::hypot)),
    ("wrap", Offer::OfOne(wrap)),
    ("noise", Offer::Noise),
];

/// What goes with a module while it runs.
#[derive(Debug)]
pub(super) struct Host {
    pub(super) limits: StoreLimits,
    pub(super) noise: Noise,
}

impl Offer {
    /// The types of its arguments.
    pub(super) fn arguments(self) -> &'static [ValType] {
        match self {
            Self::OfOne(_) => &[ValType::F64],
            Self::OfTwo(_) => &[ValType::F64; 2],
            Self::Noise => &[ValType::I32],
        }
    }
}

/// A number; where it is none, one whose sign and payload are the same on every machine.
fn plain(number: f64) -> f64 {
    if number.is_nan() { f64::NAN } else { number }
}

/// All that is offered.
pub(super) fn offered(engine: &Engine) -> Result<Linker<Host>, Error> {
    let mut linker = Linker::new(engine);
    for (name, offer) in OFFERED {
        match offer {
            Offer::OfOne(function) => {
                linker.func_wrap(FROM, name, move |mut caller: Caller<'_, Host>, x: f64| {
                    paid(&mut caller).map(|()| plain(function(x)))
                })
            }
            Offer::OfTwo(function) => {
                linker.func_wrap(FROM, name, move |mut caller: Caller<'_, Host>, x: f64, y: f64| {
                    paid(&mut caller).map(|()| plain(function(x, y)))
                })
            }
            Offer::Noise => linker.func_wrap(FROM, name, |mut caller: Caller<'_, Host>, index: u32| {
                paid(&mut caller).map(|()| caller.data().noise.normal(u64::from(index)))
            }),
        }?;
    }
    Ok(linker)
}

/// Takes the price of a function; fails where there is too little fuel left.
fn paid(caller: &mut Caller<'_, Host>) -> Result<(), Error> {
    let left = caller.get_fuel()?.checked_sub(PRICE).ok_or(TrapCode::OutOfFuel)?;
    caller.set_fuel(left)
}
