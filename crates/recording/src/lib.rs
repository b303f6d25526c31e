//! Run folders: tables, metrics, digest.
