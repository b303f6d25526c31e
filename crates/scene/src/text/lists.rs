//! Forms made of other forms: pairs and lists.

use crate::text::{Form, Node, Reporter};
use serde_json::{Value as Json, json};

/// Two values of the same form, such as [distance, bearing], or one for both.
pub(crate) struct Pair<F>(pub(crate) F);

impl<F: Form<Out = f64>> Form for Pair<F> {
    type Out = [f64; 2];

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<[f64; 2]> {
        match node.as_list() {
            Some(_) => Couple(&self.0, &self.0).read(node, reporter),
            None => self.0.read(node, reporter).map(|both| [both, both]),
        }
    }

    fn schema(&self) -> Json {
        json!({ "anyOf": [self.0.schema(), Couple(&self.0, &self.0).schema()] })
    }
}

/// Exactly two values, such as [distance, bearing].
pub(crate) struct Couple<F, G>(pub(crate) F, pub(crate) G);

impl<F: Form, G: Form<Out = F::Out>> Form for Couple<F, G> {
    type Out = [F::Out; 2];

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let items: Option<&[Node; 2]> = node.as_list().and_then(|items| items.try_into().ok());
        let [first, second] = reporter.expect(items, node, || "a list of two values".to_owned())?;
        let (first, second) = (self.0.read(first, reporter), self.1.read(second, reporter));
        Some([first?, second?])
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array", "minItems": 2, "maxItems": 2, "prefixItems": [self.0.schema(), self.1.schema()],
        })
    }
}

/// Exactly three values, such as [x, y, heading].
pub(crate) struct Triple<F, G, H>(pub(crate) F, pub(crate) G, pub(crate) H);

impl<F: Form<Out = f64>, G: Form<Out = f64>, H: Form<Out = f64>> Form for Triple<F, G, H> {
    type Out = [f64; 3];

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<[f64; 3]> {
        let items: Option<&[Node; 3]> = node.as_list().and_then(|items| items.try_into().ok());
        let [first, second, third] = reporter.expect(items, node, || "a list of three values".to_owned())?;
        let (first, second) = (self.0.read(first, reporter), self.1.read(second, reporter));
        let third = self.2.read(third, reporter);
        Some([first?, second?, third?])
    }

    fn schema(&self) -> Json {
        let items = [self.0.schema(), self.1.schema(), self.2.schema()];
        json!({ "type": "array", "minItems": 3, "maxItems": 3, "prefixItems": items })
    }
}

/// Any number of values between two counts.
pub(crate) struct List<F> {
    form: F,
    least: usize,
    most: usize,
}

/// A list of `least` to `most` values.
pub(crate) const fn list<F: Form>(form: F, least: usize, most: usize) -> List<F> {
    List { form, least, most }
}

impl<F: Form> Form for List<F> {
    type Out = Vec<F::Out>;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<Self::Out> {
        let Self { form, least, most } = self;
        let items = node.as_list().filter(|items| (*least..=*most).contains(&items.len()));
        let items = reporter.expect(items, node, || format!("a list of {least} to {most} values"))?;
        // All items are read before giving up, so that every error is reported.
        let read: Vec<_> = items.iter().map(|item| form.read(item, reporter)).collect();
        read.into_iter().collect()
    }

    fn schema(&self) -> Json {
        json!({
            "type": "array", "minItems": self.least, "maxItems": self.most, "items": self.form.schema(),
        })
    }
}

impl<F: Form> Form for &F {
    type Out = F::Out;

    fn read(&self, node: &Node, reporter: &mut Reporter) -> Option<F::Out> {
        (*self).read(node, reporter)
    }

    fn schema(&self) -> Json {
        (*self).schema()
    }
}
