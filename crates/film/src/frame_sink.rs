//! The interface of all film encoders.

use crate::Error;
use vocabulary::Picture;

/// Takes pictures in order; dropped before `finish`, it leaves nothing behind.
pub(crate) trait FrameSink: Send {
    fn add(&mut self, picture: &Picture) -> Result<(), Error>;
    fn finish(self: Box<Self>) -> Result<(), Error>;
    /// As `finish`, but a later program may go on, where that can be.
    fn pause(self: Box<Self>) -> Result<(), Error> {
        self.finish()
    }
}
