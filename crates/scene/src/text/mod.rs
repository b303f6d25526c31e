//! From characters to a tree that knows where each value stands, and from that tree to typed values.

pub(crate) mod form;
pub(crate) mod keys;
pub(crate) mod kinds;
pub(crate) mod lists;
pub(crate) mod node;
pub(crate) mod reporter;
pub(crate) mod words;

pub(crate) use form::{Flag, Form, Optional, Text, angle, angle_of_turns, angle_within, integer, number};
pub(crate) use keys::{Found, Keys, Part, keys, settings, table};
pub(crate) use lists::{Couple, Pair, Triple, list};
pub(crate) use node::{Node, Value};
pub(crate) use reporter::{Reporter, Span};
