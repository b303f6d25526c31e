//! The symbols of the panels: name, unit, equation, and the effect of a larger value.

use eframe::egui::{self, RichText, Ui};

/// A tunable quantity.
#[derive(Debug, Clone, Copy)]
pub struct Symbol {
    /// The paper's symbol.
    pub sign: &'static str,
    /// Its name, also for screen readers and tests.
    pub name: &'static str,
    /// Unit; empty for pure numbers.
    pub unit: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// The effect of a larger value.
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
        /// All of them, in order.
        pub const ALL: &[Symbol] = &[$($id),*];
    };
}

symbols! {
    DISTANCE = "ℓ", "Distance", "m", "e₁ = ℓᵈ − ℓ (eq 14)",
        "The follower falls back; on the outside of a bend it must drive faster.";
    BEARING = "ψ", "Bearing", "°", "e₂ = ψᵈ − ψ (eq 14); seen from the leader's heading, left is positive",
        "The follower moves around its leader to the left.";
    GAIN = "K", "Gain", "1/s", "r = ė + K e (eq 18); ϖ = −g⁻¹[… + 2K ė + K² e …] (eqs 20, 22, 42)",
        "Errors decay faster, like e^(−Kt), and commands grow; with lags and slow sensing the follower oscillates.";
    ROBUST = "β", "Robust gain", "m/s², rad/s²", "β tanh(κ e) in eqs 22 and 42; Lemma 4.1 asks for β > ‖g_v V‖ + ‖d/dt g_v V‖ / k",
        "The law rejects the leader's unknown motion more strongly: smaller errors, more effort, and chatter if sampled slowly.";
    SLOPE = "κ", "Slope", "1/m, 1/rad", "β tanh(κ e); κ → ∞ is the sign(e) of the theorems",
        "Smaller steady-state errors, closer to the theorem, and commands that switch more sharply.";
    EPSILON = "ε", "Observer time constant", "s", "dŝ₁/dt = ŝ₂ + (α₁/ε)(s − ŝ₁), dŝ₂/dt = … + (α₂/ε²)(s − ŝ₁) (eqs 31, 32)",
        "The observer becomes slower and passes less noise. With a smaller ε it is more accurate, passes more noise, and peaks like 1/ε at the start.";
    ALPHA_ONE = "α₁", "Observer damping", "", "s² + α₁ s + α₂ must be stable (eq 34)",
        "The observer oscillates less and follows more slowly.";
    ALPHA_TWO = "α₂", "Observer stiffness", "", "s² + α₁ s + α₂ must be stable (eq 34)",
        "The observer follows faster, and oscillates once α₁² < 4 α₂.";
    SPEED_MIN = "v_min", "Minimum speed", "m/s", "det g = v/ℓ: the laws are singular at rest",
        "Followers cannot slow down as much, for example on the inside of a bend.";
    SPEED_MAX = "v_max", "Maximum speed", "m/s", "v_min ≤ v ≤ v_max, the sat{} of eq 42",
        "Followers can catch up faster, and hold set points farther outside in a bend.";
    TURN_MAX = "ω_max", "Maximum turn rate", "rad/s", "|ω| ≤ ω_max, the sat{} of eq 42",
        "Commands saturate less often.";
    ACCELERATION_MAX = "a_max", "Maximum acceleration", "m/s²", "|dv/dt| ≤ a_max, the sat{} of eq 42",
        "Commands saturate less often.";
    RATE = "f", "Measurement rate", "1/s", "each measurement corrects the observer",
        "The estimate follows more closely; cameras take more computing time.";
    LATENCY = "τ", "Latency", "s", "a measurement is applied at the time it was taken, and the steps since then are repeated",
        "The follower learns later what its leader does; with high gains it oscillates.";
    DROPS = "p", "Dropout probability", "", "a measurement arrives with probability 1 − p",
        "The estimate coasts more often.";
    DISTANCE_NOISE = "σ_ℓ", "Distance noise", "m", "ℓ + σ_ℓ·n",
        "Rate estimates become less accurate, more so with a small ε.";
    BEARING_NOISE = "σ_ψ", "Bearing noise", "°", "ψ + σ_ψ·n",
        "Rate estimates become less accurate, more so with a small ε.";
    PIXEL_NOISE = "σ_px", "Corner noise", "px", "standard deviation of every corner of a tag",
        "The leader's distance and heading become less certain, first at long range.";
    HEADING_LENGTH = "λ", "Heading length", "m", "H(s) = (1 + (2λ − τ)s) / (1 + λs)² from θᵢ to θ̄, s along the leader's path",
        "A turn of the leader arrives later and more smoothly.";
    HEADING_LAG = "τ", "Heading lag", "m", "on a circle of radius R, θ̄ is τ/R behind θᵢ; τ = d/2 follows the leader's track",
        "Swings die out along a chain; on curves the whole formation is turned more against its leader.";
    BARRIER_MARGIN = "D", "Margin", "m", "h = |p + c h − o| − (R + Rₒ + D + c)",
        "The robot keeps farther away from everything.";
    POINT_AHEAD = "c", "Point ahead", "m", "the barrier is on the point p + c h, whose velocity depends on ω at any speed",
        "The robot steers away earlier, and keeps more room ahead of it.";
    BARRIER_GAIN = "α", "Barrier gain", "1/s", "dh/dt ≥ −α h",
        "Room is used up faster: the filter acts later and harder. At most what the robot can brake, over its largest speed.";
    BARRIER_HORIZON = "T_h", "Horizon", "s", "dh/dt is that of the speed v + T_h a",
        "Braking counts for more against steering.";
    VIEW_DISTANCE = "ℓ_max", "View distance", "m", "a barrier of second order with a double pole at −2 1/s",
        "The leader may get farther away.";
    VIEW_ANGLE = "ψ_max", "View angle", "°", "the leader's angle off the middle of the picture, of a camera that turns after it",
        "The leader may get nearer to the rim of the picture.";
}

impl Symbol {
    /// The symbol with its tool tip.
    pub fn label(&self, ui: &mut Ui) -> egui::Response {
        let text = RichText::new(self.sign).size(15.0);
        ui.add(egui::Label::new(text).sense(egui::Sense::hover())).on_hover_ui(|ui| self.tip(ui))
    }

    /// The content of the tool tip.
    pub fn tip(&self, ui: &mut Ui) {
        ui.set_max_width(340.0);
        let unit = if self.unit.is_empty() { "a number".to_owned() } else { format!("in {}", self.unit) };
        ui.label(RichText::new(format!("{}  {}, {unit}", self.sign, self.name)).strong());
        ui.label(RichText::new(self.equation).italics());
        ui.label(format!("Larger: {}", self.growing));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_symbols_share_a_name() {
        // Screen readers and tests find a control by its name.
        let mut names: Vec<_> = ALL.iter().map(|symbol| symbol.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), ALL.len());
    }
}
