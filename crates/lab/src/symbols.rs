//! What every symbol of a panel means: name, unit, equation, and what happens when it grows.

use eframe::egui::{self, RichText, Ui};

/// A quantity that can be tuned.
#[derive(Debug, Clone, Copy)]
pub struct Symbol {
    /// As in the paper.
    pub sign: &'static str,
    /// In words; also its name for screen readers and tests.
    pub name: &'static str,
    /// Unit; empty for pure numbers.
    pub unit: &'static str,
    /// Where it stands in the laws.
    pub equation: &'static str,
    /// What happens when it grows.
    pub growing: &'static str,
}

macro_rules! symbols {
    ($($id:ident = $sign:literal, $name:literal, $unit:literal, $equation:literal, $growing:literal;)*) => {
        $(
            #[doc = $name]
            pub const $id: Symbol = Symbol {
                sign: $sign, name: $name, unit: $unit, equation: $equation, growing: $growing,
            };
        )*
        /// All of them.
        pub const ALL: &[Symbol] = &[$($id),*];
    };
}

symbols! {
    DISTANCE = "ℓ", "Distance", "m", "e₁ = ℓᵈ − ℓ (eq 14)",
        "The follower falls back; on the outside of a bend it has to drive faster.";
    BEARING = "ψ", "Bearing", "°", "e₂ = ψᵈ − ψ (eq 14); seen from the leader's heading, left is positive",
        "The follower moves round its leader, to the left.";
    GAIN = "K", "Gain", "1/s", "r = ė + K e (eq 18); ϖ = −g⁻¹[… + 2K ė + K² e …] (eqs 20, 22, 42)",
        "Errors die out faster, like e^(−Kt), and commands grow; against lags and slow sensing it begins to swing.";
    ROBUST = "β", "Robust gain", "m/s², rad/s²", "β tanh(κ e) in eqs 22 and 42; Lemma 4.1 asks for β > ‖g_v V‖ + ‖d/dt g_v V‖ / k",
        "The leader's unknown motion is pushed away harder: smaller errors, more effort, and chatter if sampled slowly.";
    SLOPE = "κ", "Slope", "1/m, 1/rad", "β tanh(κ e); κ → ∞ is the sign(e) of the theorems",
        "Smaller errors at rest, nearer to the theorem, and commands that switch more sharply.";
    EPSILON = "ε", "Observer time constant", "s", "dŝ₁/dt = ŝ₂ + (α₁/ε)(s − ŝ₁), dŝ₂/dt = … + (α₂/ε²)(s − ŝ₁) (eqs 31, 32)",
        "The observer becomes slower and calmer. Falling, it becomes exact, passes more noise on, and peaks like 1/ε at the start.";
    ALPHA_ONE = "α₁", "Observer damping", "", "s² + α₁ s + α₂ has to be stable (eq 34)",
        "The observer swings less and follows more slowly.";
    ALPHA_TWO = "α₂", "Observer stiffness", "", "s² + α₁ s + α₂ has to be stable (eq 34)",
        "The observer follows faster, and swings once α₁² < 4 α₂.";
    SPEED_MIN = "v_min", "Slowest speed", "m/s", "det g = v/ℓ: the laws are singular at rest",
        "Followers cannot slow down as much, on the inside of a bend for example.";
    SPEED_MAX = "v_max", "Fastest speed", "m/s", "v_min ≤ v ≤ v_max, the sat{} of eq 42",
        "Followers can catch up faster, and hold places farther outside in a bend.";
    TURN_MAX = "ω_max", "Fastest turn", "rad/s", "|ω| ≤ ω_max, the sat{} of eq 42",
        "Commands are cut less often.";
    ACCELERATION_MAX = "a_max", "Largest acceleration", "m/s²", "|dv/dt| ≤ a_max, the sat{} of eq 42",
        "Commands are cut less often.";
    RATE = "f", "Measurements a second", "1/s", "the observer is corrected by each measurement",
        "The estimate follows more closely; cameras cost more.";
    LATENCY = "τ", "Latency", "s", "a measurement is put in at its own time, and what has passed since is run again",
        "The follower knows later what its leader does; high gains begin to swing.";
    DROPS = "p", "Lost measurements", "", "a measurement arrives with probability 1 − p",
        "The estimate coasts more often.";
    DISTANCE_NOISE = "σ_ℓ", "Noise of the distance", "m", "ℓ + σ_ℓ·n",
        "Rates are estimated worse, the more the smaller ε is.";
    BEARING_NOISE = "σ_ψ", "Noise of the bearing", "°", "ψ + σ_ψ·n",
        "Rates are estimated worse, the more the smaller ε is.";
    PIXEL_NOISE = "σ_px", "Noise of a corner", "px", "every corner of a tag is off by this",
        "Distance and heading of the leader become uncertain, far away first.";
}

impl Symbol {
    /// The sign with its tool tip.
    pub fn label(&self, ui: &mut Ui) -> egui::Response {
        let text = RichText::new(self.sign).size(15.0);
        ui.add(egui::Label::new(text).sense(egui::Sense::hover())).on_hover_ui(|ui| self.tip(ui))
    }

    /// What the tool tip says.
    pub fn tip(&self, ui: &mut Ui) {
        ui.set_max_width(340.0);
        let unit = if self.unit.is_empty() { "a number".to_owned() } else { format!("in {}", self.unit) };
        ui.label(RichText::new(format!("{}  {}, {unit}", self.sign, self.name)).strong());
        ui.label(RichText::new(self.equation).italics());
        ui.label(format!("Growing: {}", self.growing));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_symbols_share_a_name() {
        // Screen readers and tests find a control by it.
        let mut names: Vec<_> = ALL.iter().map(|symbol| symbol.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), ALL.len());
    }
}
