//! What a custom law carries and shows, as a message.

use super::record::{FieldValue, Fields, Record};
use vocabulary::{LawQuantity, LawState};

impl Record for LawState {
    const NAME: &'static str = "Law";

    fn list<F: Fields>(&mut self, f: &mut F) -> Option<()> {
        let lines =
            |part: fn(&LawQuantity) -> &str| self.quantities.iter().map(part).collect::<Vec<_>>().join("\n");
        // One line each: names and units have no line breaks.
        let (mut names, mut units) = (lines(|own| &own.name), lines(|own| &own.unit));
        f.text("names", &mut names)?;
        f.text("units", &mut units)?;
        f.field("values", FieldValue::Series(&mut self.values))?;
        f.text("fault", &mut self.fault)?;
        let count = self.values.len();
        let quantity =
            |(name, unit): (&str, &str)| LawQuantity { name: name.to_owned(), unit: unit.to_owned() };
        let all: Vec<_> = names.split('\n').zip(units.split('\n')).map(quantity).take(count).collect();
        (all.len() == count).then_some(())?;
        if *self.quantities != all {
            self.quantities = all.into();
        }
        Some(())
    }
}
