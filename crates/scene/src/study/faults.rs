//! What a study cannot be.

use super::{MOST_RUNS, Sampling, Study, Values};
use std::collections::BTreeSet;

/// Something that is wrong with a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyFault {
    /// The varied key at fault; `None` where it is the whole.
    pub key: Option<String>,
    /// What is wrong, and what would be right.
    pub text: String,
}

/// Most samples of a Sobol sequence.
const MOST_SOBOL: u64 = 1 << 16;
/// Most samples of a Latin hypercube, whose orders are kept in memory.
const MOST_HYPERCUBE: u64 = 10_000_000;
/// Most keys that are varied.
const MOST_PARAMETERS: usize = 100;

impl Study {
    /// Everything that is wrong with it, as far as it can be told without its scene.
    pub fn faults(&self) -> Vec<StudyFault> {
        let mut faults = vec![];
        for (index, parameter) in self.parameters.iter().enumerate() {
            let fault = self.parameter_fault(index);
            faults.extend(fault.map(|text| StudyFault { key: Some(parameter.key.clone()), text }));
        }
        let whole = |text: String| StudyFault { key: None, text };
        if self.parameters.len() > MOST_PARAMETERS {
            faults.push(whole(format!(
                "at most {MOST_PARAMETERS} keys can be varied, not {}",
                self.parameters.len()
            )));
        }
        let drawn = self.parameters.iter().any(|p| matches!(p.values, Values::Drawn { .. }));
        if self.samples > 1 && !drawn {
            let text = "samples are of numbers that are drawn, and nothing is: vary a key as uniform:A..B, log-uniform:A..B \
                or normal:MEAN,DEVIATION; runs that differ by their seed alone are `seeds`";
            faults.push(whole(text.to_owned()));
        }
        let most = match self.sampling {
            Sampling::Independent => u64::MAX,
            Sampling::LatinHypercube => MOST_HYPERCUBE,
            Sampling::Sobol => MOST_SOBOL,
        };
        if self.samples > most {
            faults.push(whole(format!(
                "this kind of sampling has at most {most} samples, not {}",
                self.samples
            )));
        }
        if self.runs() > MOST_RUNS {
            let text = format!(
                "{} cells × {} samples × {} seeds are more than {MOST_RUNS} runs: vary fewer keys, or with fewer values",
                self.cells(),
                self.samples,
                self.seeds
            );
            faults.push(whole(text));
        }
        faults
    }

    fn parameter_fault(&self, index: usize) -> Option<String> {
        let parameter = self.parameters.get(index)?;
        let key = &parameter.key;
        if key.split('.').any(|part| part.trim().is_empty()) || key.contains('=') {
            return Some(format!(
                "`{key}` is no path of a key: write it as in law.k or robots.follower-1.distance"
            ));
        }
        if key == "seed" {
            return Some(
                "seeds are not varied by name: `seeds` says how many runs differ by their seed".to_owned(),
            );
        }
        let set = self.set.iter().map(|change| change.parts().0.trim());
        let others = self.parameters.iter().take(index).map(|other| other.key.as_str());
        if let Some(other) = others.chain(set).find(|other| contradicts(other, key)) {
            return Some(if other == key {
                format!("`{key}` is given twice")
            } else {
                format!("`{key}` and `{other}` contradict each other: one is part of the other")
            });
        }
        match &parameter.values {
            Values::Grid { values, .. } => {
                let mut seen = BTreeSet::new();
                let twice = values.iter().find(|value| !seen.insert(value.as_str()))?;
                Some(format!("`{key}` has the value {twice} twice"))
            }
            Values::Zipped(values) => {
                let first = self.parameters.iter().find_map(|other| match &other.values {
                    Values::Zipped(others) => Some((other, others.len())),
                    _ => None,
                });
                let (other, count) = first.filter(|(_, count)| *count != values.len())?;
                Some(format!(
                    "`{key}` has {} zipped values and `{}` has {count}: lists that are zipped have as many values as each other",
                    values.len(),
                    other.key
                ))
            }
            Values::Same(other) => {
                let named = self.parameters.iter().find(|parameter| parameter.key == *other);
                match named.map(|named| &named.values) {
                    Some(Values::Same(_)) => {
                        Some(format!("`{key}` is the same as `{other}`, which has no values of its own"))
                    }
                    Some(_) => None,
                    None => Some(format!("`{key}` is the same as `{other}`, which is not varied")),
                }
            }
            Values::Drawn { .. } => None,
        }
    }
}

/// Whether one path is the other, or leads to it.
fn contradicts(a: &str, b: &str) -> bool {
    let within = |outer: &str, inner: &str| {
        inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    };
    within(a, b) || within(b, a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::StudyParameter;

    fn study(parameters: &[(&str, &str)]) -> Study {
        let parameter = |(key, values): &(&str, &str)| StudyParameter {
            key: (*key).to_owned(),
            values: values.parse().expect("values"),
        };
        Study {
            parameters: parameters.iter().map(parameter).collect(),
            ..Study::of_scene("circle-three", "t")
        }
    }

    fn fault(study: &Study) -> String {
        let faults = study.faults();
        assert_eq!(faults.len(), 1, "{faults:?}");
        faults[0].text.clone()
    }

    #[test]
    fn runs_are_counted() {
        let plain =
            study(&[("law.k", "1..10/19"), ("law.beta", "1,2"), ("a.b", "zip:1,2,3"), ("a.c", "zip:4,5,6")]);
        assert_eq!((plain.cells(), plain.faults()), (19 * 2 * 3, vec![]));
        let drawn =
            Study { samples: 10, seeds: 20, ..study(&[("law.k", "1,2"), ("law.beta", "uniform:1..2")]) };
        assert_eq!((drawn.cells(), drawn.runs(), drawn.faults()), (2, 400, vec![]));
    }

    #[test]
    fn what_contradicts_itself_is_refused() {
        for (parameters, wanted) in [
            (vec![("law.k", "1,2"), ("law.k", "3,4")], "given twice"),
            (vec![("law", "{ k = 1 }"), ("law.k", "3,4")], "contradict"),
            (vec![("a.b", "zip:1,2"), ("a.c", "zip:1,2,3")], "as many values"),
            (vec![("a.b", "=a.c")], "not varied"),
            (vec![("a.b", "=a.c"), ("a.c", "=a.b")], "no values of its own"),
            (vec![("law.k", "1,1")], "twice"),
            (vec![("seed", "1..10/10")], "`seeds`"),
            (vec![("law..k", "1,2")], "no path"),
        ] {
            let study = study(&parameters);
            assert!(
                study.faults().iter().any(|fault| fault.text.contains(wanted)),
                "{parameters:?}: {:?}",
                study.faults()
            );
        }
        let set = vec!["law.k=2".parse().expect("an override")];
        assert!(fault(&Study { set, ..study(&[("law.k", "1,2")]) }).contains("given twice"));
    }

    #[test]
    fn studies_that_would_never_end_are_refused() {
        let many = study(&[("a.a", "1..2/10000"), ("a.b", "1..2/10000"), ("a.c", "1..2/10000")]);
        assert!(fault(&many).contains("1000000000000 cells"), "{:?}", many.faults());
        assert!(fault(&Study { samples: 5, ..study(&[("law.k", "1,2")]) }).contains("`seeds`"));
        let sobol =
            Study { samples: 100_000, sampling: Sampling::Sobol, ..study(&[("law.k", "uniform:1..2")]) };
        assert!(fault(&sobol).contains("65536"));
    }
}
