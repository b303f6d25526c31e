//! Tags in pictures.
