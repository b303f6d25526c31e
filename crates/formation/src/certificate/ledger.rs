//! What the statements need to know of an edge, gathered as it goes: flat in time, however long the run.

use super::constants::Constants;
use super::tally::{BoundEvent, Largest, Margin, Outside, OutsideLate, Tally};
use super::witness::WitnessRow;

/// V may rise from sample to sample by this share of its largest value: what is left of the trapezoids' error.
const ROUNDING: f64 = 1e-6;

/// The largest that a run went through, of which the constants are made.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Peaks {
    /// ‖η‖ at the first sample.
    pub(super) first_observer_error: f64,
    /// Largest ‖g_s‖.
    pub(super) rate_gain: f64,
    /// Largest ‖g_v V_i‖.
    pub(super) effect: f64,
    /// Largest ‖r‖.
    pub(super) filtered: f64,
}

/// All samples of one edge, in sums.
#[derive(Debug, Clone, Default)]
pub(super) struct Ledger {
    pub(super) samples: u64,
    /// First and last time, s.
    pub(super) span: [f64; 2],
    pub(super) peaks: Peaks,
    /// Of Lemma 4.1, without the last sample, whose margin is not known before the next.
    margin: Margin,
    pub(super) p: Margin,
    pub(super) v: Falls,
    pub(super) w: Falls,
    pub(super) trapped: OutsideLate,
    pub(super) end: Outside,
    /// ‖e‖ + ‖de/dt‖ + ‖η‖: the least and the last.
    pub(super) whole: [f64; 2],
    /// The least W.
    pub(super) least_w: f64,
    pub(super) limited: Tally,
    pub(super) chatters: Tally,
    pub(super) at_speed_bound: Tally,
    pub(super) stands: Tally,
    pub(super) filtered: Tally,
    pub(super) too_close: Tally,
    last: WitnessRow,
}

/// Whether a quantity falls from sample to sample.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Falls {
    largest: f64,
    rises: Outside,
    least: Largest,
}

impl Falls {
    /// From a value to the next, where something lies above a bound.
    fn note(&mut self, time: f64, [before, now]: [f64; 2], above: f64, bound: f64) {
        self.largest = self.largest.max(before.abs()).max(now.abs());
        let event = BoundEvent { time, values: [now - before, above] };
        self.rises.note(event, [ROUNDING * self.largest, bound]);
        self.least.note(event, bound);
    }

    /// First and last sample after which it rose, s, and the least fall, where the other lay above the bound.
    pub(super) fn found(&self, bound: f64) -> (Option<[f64; 2]>, Option<f64>) {
        (self.rises.ends([ROUNDING * self.largest, bound]), self.least.above(bound).map(|rise| -rise))
    }
}

impl Ledger {
    /// Takes in the next sample and what is now known of the one before; then come the bounds.
    pub(super) fn push(&mut self, row: &WitnessRow, before: Option<&WitnessRow>) {
        if let Some(before) = before {
            self.margin.note(before.time, before.margin);
        } else {
            self.span[0] = row.time;
            self.peaks.first_observer_error = row.observer_error;
        }
        self.samples += 1;
        self.span[1] = row.time;
        self.peaks.rate_gain = self.peaks.rate_gain.max(row.rate_gain);
        self.peaks.effect = self.peaks.effect.max(row.effect);
        self.peaks.filtered = self.peaks.filtered.max(row.filtered);
        self.p.note(row.time, row.p);
        self.limited.note(row.time, row.limited);
        self.chatters.note(row.time, row.chatters);
        self.at_speed_bound.note(row.time, row.at_speed_bound);
        self.stands.note(row.time, row.stands);
        self.filtered.note(row.time, row.diverted);
        self.too_close.note(row.time, row.too_close);
        self.last = *row;
    }

    /// Takes in what depends on bounds, as they are with the sample that was pushed last.
    pub(super) fn judge(&mut self, before: Option<&WitnessRow>, constants: Option<&Constants>) {
        let row = self.last;
        if let Some(before) = before {
            // Where no observer runs, V has to fall everywhere.
            let reach = constants.map_or(f64::INFINITY, |_| before.reach());
            self.v.note(before.time, [before.v, row.v], reach, constants.map_or(0.0, |c| c.sigma_1));
        }
        let Some(constants) = constants else { return };
        if let Some(before) = before {
            self.w.note(before.time, [before.w, row.w], before.w, constants.trap);
        }
        let known = constants.rho > 0.0;
        self.trapped.note(row.time, row.w, constants.trap, known.then_some(constants.t_epsilon));
        let event = BoundEvent { time: row.time, values: [row.whole(), f64::INFINITY] };
        self.end.note(event, [constants.delta_0, 0.0]);
        let first = before.is_none();
        let least = |least: f64, now: f64| if first { now } else { least.min(now) };
        self.whole = [least(self.whole[0], row.whole()), row.whole()];
        self.least_w = least(self.least_w, row.w);
    }

    /// The room of Lemma 4.1.
    pub(super) fn margin(&self) -> Margin {
        let mut margin = self.margin;
        if self.samples > 0 {
            margin.note(self.last.time, self.last.margin);
        }
        margin
    }
}
