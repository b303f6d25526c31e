//! The boxes of an .mp4 with one H.264 track (ISO/IEC 14496-12 and -15).
//!
//! Muxers at hand keep all frames in memory until the end; this one keeps five bytes a frame. The index comes
//! first, so that a film starts to play while it is still being loaded.

/// Ticks of the track's clock to a frame; the clock runs at the frame rate times this, so frame times are exact.
const TICKS: u32 = 1000;

/// Sizes of the frames so far, and the parameter sets of the encoder.
#[derive(Debug)]
pub(crate) struct Mp4Track {
    width: u32,
    height: u32,
    /// Ticks a second.
    clock: u32,
    sizes: Vec<u32>,
    /// Numbers of the frames at which playing can start, from 1.
    keys: Vec<u32>,
    sequence: Vec<u8>,
    picture: Vec<u8>,
}

impl Mp4Track {
    pub(crate) fn new(width: u32, height: u32, rate: f64) -> Self {
        let clock = (rate * f64::from(TICKS)).round() as u32;
        Self { width, height, clock, sizes: vec![], keys: vec![], sequence: vec![], picture: vec![] }
    }

    /// With frames that are there already.
    pub(crate) fn going_on(mut self, found: &crate::kept_frames::FilmJournal) -> Self {
        [self.sequence, self.picture] = found.parameters.clone();
        for (size, key) in &found.sizes {
            self.sizes.push(*size);
            if *key {
                self.keys.push(self.sizes.len() as u32);
            }
        }
        self
    }

    /// Sequence and picture parameters of the encoder.
    pub(crate) fn parameters(&self) -> [&[u8]; 2] {
        [&self.sequence, &self.picture]
    }

    pub(crate) fn frames(&self) -> usize {
        self.sizes.len()
    }

    /// Takes in a frame in the encoder's format (start codes) and returns it in the file's (lengths).
    pub(crate) fn add(&mut self, stream: &[u8], key: bool) -> Vec<u8> {
        let mut frame = Vec::with_capacity(stream.len() + 16);
        for unit in units(stream) {
            match unit[0] & 31 {
                7 => self.sequence = unit.to_vec(),
                8 => self.picture = unit.to_vec(),
                _ => {
                    frame.extend((unit.len() as u32).to_be_bytes());
                    frame.extend(unit);
                }
            }
        }
        if !frame.is_empty() {
            self.sizes.push(frame.len() as u32);
            if key {
                self.keys.push(self.sizes.len() as u32);
            }
        }
        frame
    }

    /// Everything in front of the frames, which then follow in one piece.
    pub(crate) fn head(&self) -> Vec<u8> {
        let kind = boxed(*b"ftyp", &[b"isom", &512_u32.to_be_bytes(), b"isomiso2avc1mp41"]);
        let frames: u64 = self.sizes.iter().map(|s| u64::from(*s)).sum();
        // The place of the frames depends on the index's length, not on its content.
        let index = self.index(0).len() as u64;
        let at = kind.len() as u64 + index + 16;
        let mut head = kind;
        head.extend(self.index(at));
        // A length of 1 announces one of 64 bits.
        head.extend(1_u32.to_be_bytes());
        head.extend(b"mdat");
        head.extend((frames + 16).to_be_bytes());
        head
    }

    fn duration(&self) -> u64 {
        self.sizes.len() as u64 * u64::from(TICKS)
    }

    fn index(&self, frames_at: u64) -> Vec<u8> {
        let times = [0_u64.to_be_bytes(), 0_u64.to_be_bytes()].concat();
        let length = self.duration().to_be_bytes();
        let identity = words(&[0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000]);
        let clock = self.clock.to_be_bytes();
        let movie = full(
            *b"mvhd",
            0x0100_0000,
            &[
                &times,
                &clock,
                &length,
                &words(&[0x1_0000, 0x0100_0000, 0, 0]),
                &identity,
                &[0; 24],
                &words(&[2]),
            ],
        );
        let size = words(&[self.width << 16, self.height << 16]);
        let header =
            full(*b"tkhd", 0x0100_0003, &[&times, &words(&[1, 0]), &length, &[0; 16], &identity, &size]);
        // Language: und, as three letters of five bits.
        let media = full(*b"mdhd", 0x0100_0000, &[&times, &clock, &length, &[0x55, 0xc4, 0, 0]]);
        let handler = full(*b"hdlr", 0, &[&[0; 4], b"vide", &[0; 12], b"video\0"]);
        let source = full(*b"dref", 0, &[&words(&[1]), &full(*b"url ", 1, &[])]);
        let information = boxed(
            *b"minf",
            &[&full(*b"vmhd", 1, &[&[0; 8]]), &boxed(*b"dinf", &[&source]), &self.table(frames_at)],
        );
        let media = boxed(*b"mdia", &[&media, &handler, &information]);
        boxed(*b"moov", &[&movie, &boxed(*b"trak", &[&header, &media])])
    }

    fn table(&self, frames_at: u64) -> Vec<u8> {
        let count = self.sizes.len() as u32;
        let keys = [words(&[self.keys.len() as u32]), words(&self.keys)].concat();
        boxed(
            *b"stbl",
            &[
                &full(*b"stsd", 0, &[&words(&[1]), &self.description()]),
                &full(*b"stts", 0, &[&words(&[1, count, TICKS])]),
                &full(*b"stss", 0, &[&keys]),
                // One chunk holds all frames.
                &full(*b"stsc", 0, &[&words(&[1, 1, count, 1])]),
                &full(*b"stsz", 0, &[&words(&[0, count]), &words(&self.sizes)]),
                &full(*b"co64", 0, &[&words(&[1]), &frames_at.to_be_bytes()]),
            ],
        )
    }

    fn description(&self) -> Vec<u8> {
        let short = |n: u32| (n as u16).to_be_bytes();
        let trajectory: Vec<u8> = self.sequence.get(1..4).unwrap_or(&[66, 0, 31]).to_vec();
        let parameters = boxed(
            *b"avcC",
            &[
                &[1],
                &trajectory,
                // Lengths of four bytes; one sequence and one picture parameter set.
                &[0xff, 0xe1],
                &short(self.sequence.len() as u32),
                &self.sequence,
                &[1],
                &short(self.picture.len() as u32),
                &self.picture,
            ],
        );
        // BT.709 in video range, as the pictures are converted.
        let colour = boxed(*b"colr", &[b"nclx", &[0, 1, 0, 1, 0, 1, 0]]);
        boxed(
            *b"avc1",
            &[
                &[0, 0, 0, 0, 0, 0, 0, 1],
                &[0; 16],
                &short(self.width),
                &short(self.height),
                &words(&[0x48_0000, 0x48_0000, 0]),
                &[0, 1],
                &[0; 32],
                &[0, 24, 0xff, 0xff],
                &parameters,
                &colour,
            ],
        )
    }
}

/// The units of a stream with start codes, without those.
fn units(stream: &[u8]) -> Vec<&[u8]> {
    let mut starts = Vec::new();
    let mut k = 0;
    while k + 3 <= stream.len() {
        if stream[k..k + 3] == [0, 0, 1] {
            starts.push(k);
            k += 3;
        } else {
            k += 1;
        }
    }
    let ends = starts.iter().skip(1).copied().chain([stream.len()]);
    let unit = |(start, end): (usize, usize)| {
        let bytes = &stream[start + 3..end];
        // Zeros in front of the next start code belong to that.
        let kept = bytes.iter().rposition(|b| *b != 0).map_or(0, |last| last + 1);
        &bytes[..kept]
    };
    starts.iter().copied().zip(ends).map(unit).filter(|u| !u.is_empty()).collect()
}

fn boxed(name: [u8; 4], parts: &[&[u8]]) -> Vec<u8> {
    let body: usize = parts.iter().map(|p| p.len()).sum();
    let mut out = Vec::with_capacity(body + 8);
    out.extend((body as u32 + 8).to_be_bytes());
    out.extend(name);
    for part in parts {
        out.extend(*part);
    }
    out
}

/// A box with version (upper byte) and flags.
fn full(name: [u8; 4], version: u32, parts: &[&[u8]]) -> Vec<u8> {
    boxed(name, &[&version.to_be_bytes(), &parts.concat()])
}

fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_be_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn start_codes_become_lengths() {
        let mut track = Mp4Track::new(64, 32, 30.0);
        let stream = [0, 0, 0, 1, 0x67, 66, 0, 31, 0, 0, 0, 1, 0x68, 9, 0, 0, 1, 0x65, 7, 8];
        assert_eq!(track.add(&stream, true), [0, 0, 0, 3, 0x65, 7, 8]);
        assert_eq!(
            (track.sequence.as_slice(), track.picture.as_slice()),
            (&[0x67, 66, 0, 31][..], &[0x68, 9][..])
        );
        assert_eq!((track.sizes, track.keys), (vec![7], vec![1]));
    }
}
