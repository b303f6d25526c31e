//! What a sweep of the present scene varies, and what is shown of it.

use crate::numbers::plain;
use scene::{Study, StudyParameter};
use sweeps::ChartQuantity;

/// A key that varies, and its range.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSide {
    /// Its path in the scene.
    pub key: String,
    /// First value, in degrees for angles.
    pub from: f64,
    /// Last value.
    pub to: f64,
    /// Number of values.
    pub count: u32,
    /// Whether the values have equal ratios.
    pub logarithmic: bool,
    /// Whether they are angles in degrees.
    pub degrees: bool,
}

/// What a sweep varies, and what is shown of it.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepPlan {
    /// One key, or two.
    pub sides: Vec<SweepSide>,
    /// Runs of every combination.
    pub seeds: u32,
    /// What is shown.
    pub quantity: ChartQuantity,
}

/// Most runs of a sweep in the window, whose rows stay in memory.
pub const MOST_RUNS: u64 = 20_000;

impl SweepSide {
    /// Its values as `--vary` has them.
    pub fn values(&self) -> String {
        let Self { from, to, count, logarithmic, degrees, .. } = self;
        let [kind, unit] = [if *logarithmic { "log:" } else { "" }, if *degrees { " deg" } else { "" }];
        format!("{kind}{}..{}{unit}/{count}", plain(*from), plain(*to))
    }
}

impl SweepPlan {
    /// Number of its runs.
    pub fn runs(&self) -> u64 {
        let counts = self.sides.iter().map(|side| u64::from(side.count));
        counts.fold(u64::from(self.seeds), u64::saturating_mul)
    }

    /// The study, of a scene that is called so.
    ///
    /// # Errors
    /// What is wrong with it, as far as that can be told without the scene.
    pub fn study(&self, scene: &str) -> Result<Study, String> {
        let parameter = |side: &SweepSide| {
            let values = side.values().parse().map_err(|error| format!("{}: {error}", side.key))?;
            Ok(StudyParameter { key: side.key.trim().to_owned(), values })
        };
        let parameters = self.sides.iter().map(parameter).collect::<Result<Vec<_>, String>>()?;
        let study = Study { parameters, seeds: u64::from(self.seeds), ..Study::of_scene(scene, scene) };
        if let Some(fault) = study.faults().first() {
            return Err(fault.text.clone());
        }
        let runs = study.runs();
        if runs > MOST_RUNS {
            return Err(format!(
                "These are {runs} runs; the window makes {MOST_RUNS} at most. Take fewer values or seeds, or copy the command: \
                 `echelon sweep` makes as many as you like."
            ));
        }
        Ok(study)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(key: &str, [from, to]: [f64; 2]) -> SweepSide {
        SweepSide { key: key.to_owned(), from, to, count: 3, logarithmic: false, degrees: false }
    }

    #[test]
    fn sides_are_written_as_a_command_line_has_them() {
        let angle = SweepSide { degrees: true, ..side("robots.b.bearing", [-135.0, -90.0]) };
        let gain = SweepSide { logarithmic: true, ..side("observer.epsilon", [0.0001, 0.01]) };
        assert_eq!(
            [angle.values(), gain.values(), side("law.k", [1.0, 9.5]).values()],
            ["-135..-90 deg/3", "log:0.0001..0.01/3", "1..9.5/3"]
        );
    }

    #[test]
    fn what_is_wrong_is_said_in_one_line() {
        let plan = |sides| SweepPlan { sides, seeds: 1, quantity: ChartQuantity::Met };
        let wrong = |sides: Vec<SweepSide>| plan(sides).study("t").expect_err("wrong");
        assert!(wrong(vec![side("law.k", [2.0, 1.0])]).contains("does not rise"));
        assert!(wrong(vec![side("law.k", [1.0, f64::NAN])]).starts_with("law.k: "));
        let log = SweepSide { logarithmic: true, ..side("law.k", [0.0, 1.0]) };
        assert!(wrong(vec![log]).contains("above 0"));
        assert!(wrong(vec![SweepSide { count: 1, ..side("law.k", [0.0, 1.0]) }]).contains("from 2 to"));
        assert!(wrong(vec![side("", [0.0, 1.0])]).contains("no path of a key"));
        assert!(!wrong(vec![side("law.k", [1.0, 2.0]); 2]).is_empty());
        let many = SweepSide { count: 200, ..side("law.k", [1.0, 2.0]) };
        let wide = SweepSide { key: "law.beta".to_owned(), ..many.clone() };
        assert!(wrong(vec![many, wide]).contains("40000 runs"));
    }
}
