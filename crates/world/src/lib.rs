//! Vehicles and how they move.
