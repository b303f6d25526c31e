//! Parameters of the law and of the observer of one edge. The defaults are the paper's; on wheels, whose actuators lag,
//! they are gains that settle.

use super::{VehicleKind, WrittenLaw};
use crate::law_file::{LawFileForm, LawModuleForm, LawTextForm, ParametersForm};
use crate::text::{
    Couple, Flag, Form, Node, Pair, Reporter, angle, keys, number, settings, table,
    words::{Words, word},
};
use laws::{Knowledge, Parameter};
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use vocabulary::{HeadingReference, LawKind, ObserverKind, ObserverStart, words};

settings! {
    /// Parameters of a control law. A pair is for [distance, bearing]; one value stands for both. On wheels the gains
    /// that are not said are those that fit the kind of vehicle.
    pub struct Law from LawPart {
        /// Which of the built-in laws.
        pub kind: LawKind = LawKind::OutputFeedback, word::<LawKind>(), Live;
        /// In their place a custom law: the name of one that comes with the program, or else of a law file or a WebAssembly
        /// module beside the scene.
        pub file: Option<WrittenLaw> = None, LawFileForm, Live;
        /// In their place a custom law: its text.
        pub text: Option<WrittenLaw> = None, LawTextForm, Live;
        /// In their place a custom law: a WebAssembly module, packed; `echelon run` writes it so where `file` names one.
        pub module: Option<WrittenLaw> = None, LawModuleForm, Live;
        /// Parameters of the custom law by name, in the units that it declares; its defaults where they are left out.
        pub parameters: BTreeMap<String, f64> = BTreeMap::new(), ParametersForm, Live;
        /// Gains K = diag(k1, k2), 1/s.
        pub k: [f64; 2] = [5.0; 2], Pair(number("1/s").above(0.0)), Live;
        /// Gains of the switching term (β), [m/s², rad/s²].
        pub beta: [f64; 2] = [5.0; 2], Pair(number("m/s² or rad/s²").from(0.0)), Live;
        /// Form of the switching term.
        pub switching: SwitchingKind = SwitchingKind::Tanh, word::<SwitchingKind>(), Live;
        /// Slope of tanh, [1/m, 1/rad].
        pub slope: [f64; 2] = [24.53; 2], Pair(number("1/m or 1/rad").above(0.0)), Live;
        /// Least distance used in divisions (ℓ_min), m.
        pub distance_min: f64 = 0.1, number("m").above(0.0), Live;
        /// Against what heading the bearing is held.
        pub heading: HeadingReference = HeadingReference::Leader, word::<HeadingReference>(), Live;
        /// With `heading = "path"`: the length over which a turn of the leader arrives (λ), m.
        pub heading_length: f64 = 1.0, number("m").from(0.01).up_to(1000.0), Live;
        /// With `heading = "path"`: how far the heading lags on a circle, as a length (τ), m; it is then τ over the radius
        /// behind. At most twice `heading_length`.
        pub heading_lag: f64 = 1.0, number("m").from(0.0).up_to(2000.0), Live;
        /// Whether the follower stops with its leader, stands and starts again; it needs `heading = "path"`. It then has no
        /// `speed_min`.
        pub standing: bool = false, Flag, Live;
    }
}

words! {
    /// Form of the switching term.
    pub enum SwitchingKind {
        /// β tanh(slope · e), as in the paper's simulations.
        Tanh = "tanh",
        /// β sign(e), as in the paper's theorems.
        Sign = "sign",
    }
}

settings! {
    /// Parameters of the high-gain observer (eqs 31-32). A pair is for [distance, bearing]; one value stands for both.
    #[derive(Copy)]
    pub struct Observer from ObserverPart {
        /// Time constant (ε), s.
        pub epsilon: [f64; 2] = [0.001; 2], Pair(number("s").above(0.0).up_to(100.0)), Live;
        /// α1 of s² + α1 s + α2; above 0 for stability.
        pub alpha1: [f64; 2] = [2.0; 2], Pair(number("").above(0.0)), Live;
        /// α2 of s² + α1 s + α2; above 0 for stability.
        pub alpha2: [f64; 2] = [1.0; 2], Pair(number("").above(0.0)), Live;
        /// How measurements become an estimate; they come with every sensing but `truth`.
        pub kind: ObserverKind = ObserverKind::HighGain, word::<ObserverKind>(), Live;
        /// With measurements: whether ε follows from how certain each measurement is, ε⁵ = 3σ²T/(32 δ²), instead of
        /// being `epsilon`; true where `epsilon` is not written.
        pub adaptive: bool = true, Flag, Live;
        /// With measurements: size of what the observer does not know (δ = |g_v V_i|), [m/s², rad/s²].
        pub disturbance: [f64; 2] = [1.0; 2], Pair(number("m/s² or rad/s²").above(0.0).up_to(1e4)), Live;
        /// With measurements: a measurement farther from the prediction than this many standard deviations is not
        /// believed.
        pub gate: f64 = 6.0, number("").above(0.0).up_to(1e6), Live;
        /// Where the estimate of [distance, bearing] starts; that of their rates starts at 0.
        pub start: ObserverStart = ObserverStart::Measured, StartForm;
    }
}

impl Law {
    /// The custom law that takes the place of the built-in ones, if one does.
    pub fn custom(&self) -> Option<&WrittenLaw> {
        self.module.as_ref().or(self.text.as_ref()).or(self.file.as_ref())
    }

    /// The same law without a file of its own: it stands here.
    #[must_use]
    pub fn in_scene(&self) -> Self {
        match self.file.as_ref().filter(|law| law.is_apart()) {
            Some(law) => {
                let own = Some(law.in_scene());
                let (text, module) = if law.text().is_some() { (own, None) } else { (None, own) };
                Self { file: None, text, module, ..self.clone() }
            }
            None => self.clone(),
        }
    }

    /// Which of the built-in laws it is; `None` where a custom law takes their place.
    pub fn built_in(&self) -> Option<LawKind> {
        self.custom().is_none().then_some(self.kind)
    }

    /// What the law has to know of its leaders.
    pub fn knows(&self) -> Knowledge {
        match (self.custom(), self.kind) {
            (Some(law), _) => law.declaration().knows,
            (None, LawKind::FullState) => Knowledge::Motion,
            (None, LawKind::RobustState) => Knowledge::Rates,
            (None, LawKind::OutputFeedback) => Knowledge::Output,
        }
    }

    /// Whether it takes the rates of distance and bearing from the observer.
    pub fn observes(&self) -> bool {
        self.knows() == Knowledge::Output
    }

    /// How many leaders it looks at.
    pub fn leaders(&self) -> usize {
        self.custom().map_or(1, |law| law.declaration().leaders)
    }

    /// Values of the custom law's parameters, in the order and in the units of its declaration; empty for a built-in law.
    pub fn values(&self) -> Vec<f64> {
        let declared = self.custom().map_or(&[][..], |law| &law.declaration().parameters);
        let value = |parameter: &Parameter| {
            self.parameters.get(&parameter.name).copied().unwrap_or(parameter.default)
        };
        declared.iter().map(value).collect()
    }

    /// The same in m, s and rad, as the law is told them.
    pub fn told_values(&self) -> Vec<f64> {
        let declared = self.custom().map_or(&[][..], |law| &law.declaration().parameters);
        declared.iter().zip(self.values()).map(|(parameter, value)| parameter.as_told(value)).collect()
    }

    /// The gains that fit a kind of vehicle: the paper's for a unicycle; on wheels they were found with `echelon tune`
    /// and rounded.
    pub fn fitting(kind: VehicleKind) -> Self {
        match kind {
            VehicleKind::Unicycle => Self::default(),
            VehicleKind::Car => Self { k: [3.0; 2], beta: [3.0; 2], slope: [10.0; 2], ..Self::default() },
            VehicleKind::Differential => {
                Self { k: [2.0; 2], beta: [1.5; 2], slope: [8.0; 2], ..Self::default() }
            }
            // At some metres a second and ten metres apart; a radian of bearing is ten metres there.
            VehicleKind::FullSizeCar => {
                Self { k: [1.0; 2], beta: [2.5, 0.25], slope: [2.0, 10.0], ..Self::default() }
            }
        }
    }
}

impl Observer {
    /// The time constant that fits a kind of vehicle.
    pub fn fitting(kind: VehicleKind) -> Self {
        let epsilon = match kind {
            VehicleKind::Unicycle => 0.001,
            VehicleKind::Car | VehicleKind::Differential => 0.02,
            VehicleKind::FullSizeCar => 0.05,
        };
        Self { epsilon: [epsilon; 2], ..Self::default() }
    }
}

/// "measured", { at = […] } or { offset = […] }.
struct StartForm;

/// The start without numbers.
const MEASURED: Words<ObserverStart> =
    Words(&[("measured", ObserverStart::Measured, "At the first measurement, s(0).")]);

keys! {
    /// A start away from the first measurement, which shows the observer's peaking.
    struct StartKeys {
        /// [distance, bearing] at which the estimate starts, [m, rad].
        at: [f64; 2] = Couple(number("m").above(0.0), angle()), optional;
        /// What is added to the first measurement, [m, rad].
        offset: [f64; 2] = Couple(number("m"), angle()), optional;
    }
}

impl Form for StartForm {
    type Out = ObserverStart;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<ObserverStart> {
        if node.as_table().is_none() {
            return MEASURED.read(node, reporter);
        }
        let keys = table::<StartKeys>().read(node, reporter)?;
        match (keys.at, keys.offset) {
            (Some(at), None) => Some(ObserverStart::At(at.value)),
            (None, Some(offset)) => Some(ObserverStart::Offset(offset.value)),
            _ => {
                reporter.report(node.span, "`start` takes either `at` or `offset`, as [distance, bearing]");
                None
            }
        }
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [MEASURED.schema(), table::<StartKeys>().schema()] })
    }
}
