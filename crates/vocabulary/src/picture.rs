//! Pictures in memory.

/// An sRGB picture, 8 bits a channel, rows from the top, no padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `4 · width · height` bytes, red green blue alpha.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Red, green and blue of the pixel at column `x`, row `y`; `None` outside.
    pub fn rgb(&self, x: u32, y: u32) -> Option<[u8; 3]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        let pixel = self.rgba.get(at..at + 3)?;
        Some([pixel[0], pixel[1], pixel[2]])
    }
}
