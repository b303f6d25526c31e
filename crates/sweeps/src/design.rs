//! Which run of a study has which values and which seed: a function of the study and the run's index alone.

use crate::sampling::Sampler;
use laws::Noise;
use scene::{Override, Study, StudyParameter, Values};

/// The runs of a study, counted from 0: seeds within samples within cells, the last varied key before the others.
#[derive(Debug, Clone)]
pub struct Design {
    study: Study,
    axes: Vec<DesignAxis>,
    sampler: Sampler,
}

/// Keys whose values go together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DesignAxis {
    /// Which of the study's keys.
    pub parameters: Vec<usize>,
    /// How many values each has.
    pub len: u64,
}

/// What one run has that others have not.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RunPoint {
    /// The run, counted from 0.
    pub index: u64,
    /// The combination of values that are not drawn.
    pub cell: u64,
    /// Which draw of the others.
    pub sample: u64,
    /// Seed of its scene.
    pub seed: u64,
    /// The values of all keys, in the order of the study, as overrides have them.
    pub values: Vec<String>,
}

impl Design {
    /// Of a study without faults.
    pub fn new(study: Study) -> Self {
        let mut axes: Vec<DesignAxis> = vec![];
        let mut zipped: Option<usize> = None;
        for (index, StudyParameter { values, .. }) in study.parameters.iter().enumerate() {
            match values {
                Values::Grid { values, .. } => {
                    axes.push(DesignAxis { parameters: vec![index], len: values.len() as u64 });
                }
                Values::Zipped(values) => {
                    let axis = *zipped.get_or_insert_with(|| {
                        axes.push(DesignAxis { parameters: vec![], len: values.len() as u64 });
                        axes.len() - 1
                    });
                    axes[axis].parameters.push(index);
                }
                Values::Drawn { .. } | Values::Same(_) => {}
            }
        }
        let sampler = Sampler::new(&study);
        Self { study, axes, sampler }
    }

    /// The study.
    pub fn study(&self) -> &Study {
        &self.study
    }

    /// The keys that span the cells, the slowest first.
    pub fn axes(&self) -> &[DesignAxis] {
        &self.axes
    }

    /// Runs in a cell.
    pub fn runs_per_cell(&self) -> u64 {
        self.study.samples * self.study.seeds
    }

    /// The place of a cell along each axis.
    pub fn places(&self, cell: u64) -> Vec<u64> {
        let mut rest = cell;
        let mut places: Vec<u64> = self
            .axes
            .iter()
            .rev()
            .map(|axis| {
                let place = rest % axis.len;
                rest /= axis.len;
                place
            })
            .collect();
        places.reverse();
        places
    }

    /// The cell at a place along each axis.
    pub fn cell_at(&self, places: &[u64]) -> u64 {
        self.axes.iter().zip(places).fold(0, |cell, (axis, place)| cell * axis.len + place)
    }

    /// What run `index` has that others have not.
    pub fn point(&self, index: u64) -> RunPoint {
        let study = &self.study;
        let (rest, cell) = (index / study.seeds, index / self.runs_per_cell());
        let sample = rest % study.samples;
        RunPoint { index, cell, sample, seed: self.seed(index), values: self.values(cell, sample) }
    }

    /// The seed of a run's scene.
    fn seed(&self, index: u64) -> u64 {
        Noise { seed: self.study.seed, robot: RUNS, sample: index }.bits(0) >> 1
    }

    /// The values of all keys in a sample of a cell.
    fn values(&self, cell: u64, sample: u64) -> Vec<String> {
        let parameters = &self.study.parameters;
        let mut values = vec![String::new(); parameters.len()];
        for (axis, place) in self.axes.iter().zip(self.places(cell)) {
            for &index in &axis.parameters {
                if let Values::Grid { values: all, .. } | Values::Zipped(all) = &parameters[index].values {
                    values[index].clone_from(&all[place as usize]);
                }
            }
        }
        for (index, drawn) in self.sampler.draw(cell, sample) {
            values[index] = drawn;
        }
        for (index, parameter) in parameters.iter().enumerate() {
            if let Values::Same(key) = &parameter.values
                && let Some(other) = parameters.iter().position(|other| other.key == *key)
            {
                let value = values[other].clone();
                values[index] = value;
            }
        }
        values
    }

    /// The overrides of a run, its seed among them.
    ///
    /// # Errors
    /// Where a value is none: the text says which.
    pub fn overrides(&self, point: &RunPoint) -> Result<Vec<Override>, String> {
        let mut overrides = self.study.set.clone();
        let keys = self.study.parameters.iter().map(|parameter| parameter.key.as_str());
        let all =
            keys.zip(point.values.iter().map(String::as_str)).map(|(key, value)| format!("{key}={value}"));
        for text in all.chain([format!("seed={}", point.seed)]) {
            overrides.push(text.parse().map_err(|error: scene::OverrideError| error.to_string())?);
        }
        Ok(overrides)
    }
}

/// Apart from the numbers that samples are drawn with.
const RUNS: u64 = u64::MAX;

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Sampling;

    fn design(parameters: &[(&str, &str)], samples: u64, seeds: u64) -> Design {
        let parameter = |(key, values): &(&str, &str)| StudyParameter {
            key: (*key).to_owned(),
            values: values.parse().expect("values"),
        };
        let parameters = parameters.iter().map(parameter).collect();
        Design::new(Study { parameters, samples, seeds, ..Study::of_scene("circle-three", "t") })
    }

    #[test]
    fn the_last_key_is_the_first_to_change_and_seeds_change_before_it() {
        let design =
            design(&[("a.a", "1,2"), ("a.b", "zip:x,y,z"), ("a.c", "zip:u,v,w"), ("a.d", "=a.a")], 1, 2);
        let values = |index| design.point(index).values;
        assert_eq!(values(0), ["1", "x", "u", "1"]);
        assert_eq!((values(1), values(2)), (values(0), vec!["1".into(), "y".into(), "v".into(), "1".into()]));
        assert_eq!(values(11), ["2", "z", "w", "2"]);
        assert_eq!(design.study().runs(), 12);
        for cell in 0..6 {
            assert_eq!(design.cell_at(&design.places(cell)), cell);
        }
    }

    #[test]
    fn seeds_differ_and_are_what_scenes_take() {
        let design = design(&[("a.a", "1,2")], 1, 500);
        let seeds: std::collections::BTreeSet<u64> =
            (0..1000).map(|index| design.point(index).seed).collect();
        assert_eq!(seeds.len(), 1000);
        assert!(seeds.iter().all(|seed| i64::try_from(*seed).is_ok()));
        let other = Study { seed: 2, ..design.study().clone() };
        assert_ne!(Design::new(other).point(0).seed, design.point(0).seed);
    }

    /// A Latin hypercube has one number in each of as many shares, and a Sobol sequence one in each of a power of two.
    #[test]
    fn samples_fill_their_range() {
        for sampling in [Sampling::LatinHypercube, Sampling::Sobol] {
            let plain = design(
                &[("a.a", "uniform:0..64"), ("a.b", "log-uniform:1..16"), ("a.c", "normal:0,1")],
                64,
                1,
            );
            let design = Design::new(Study { sampling, ..plain.study().clone() });
            let numbers = |key: usize| -> Vec<f64> {
                (0..64).map(|index| design.point(index).values[key].parse().expect("a number")).collect()
            };
            let mut shares: Vec<u64> = numbers(0).into_iter().map(|value| value as u64).collect();
            shares.sort_unstable();
            assert_eq!(shares, (0..64).collect::<Vec<u64>>(), "{sampling:?}");
            assert_eq!(numbers(1).into_iter().filter(|value| *value < 4.0).count(), 32);
            assert_eq!(numbers(2).into_iter().filter(|value| *value < 0.0).count(), 32);
        }
    }

    #[test]
    fn draws_depend_on_cell_and_sample_alone() {
        let design = design(&[("a.a", "1,2"), ("a.b", "uniform:0..1")], 3, 2);
        let value = |index: u64| design.point(index).values[1].clone();
        assert_eq!(value(0), value(1));
        let all: std::collections::BTreeSet<String> = (0..12).map(value).collect();
        assert_eq!(all.len(), 6);
    }
}
