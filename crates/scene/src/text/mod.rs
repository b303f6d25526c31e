//! From characters to a tree that knows where each value stands, and from that tree to typed values.

pub(crate) mod form;
pub(crate) mod keys;
pub(crate) mod kinds;
pub(crate) mod lists;
pub(crate) mod node;
pub(crate) mod reporter;
pub(crate) mod words;

pub(crate) use form::{Form, angle, angle_of_turns, angle_within, flag, integer, number, optional, text};
pub(crate) use keys::{Found, Keys, Part, keys, settings, table};
pub(crate) use lists::{couple, list, pair, triple};
pub(crate) use node::{Node, Value};
pub(crate) use reporter::{Reporter, Span};
