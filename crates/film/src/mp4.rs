//! The boxes of an .mp4 with one H.264 track (ISO/IEC 14496-12 and -15).
//!
//! Muxers at hand keep all frames in memory until the end; this one keeps eight bytes a frame. The index comes
//! first, so that a film starts to play while it is still being loaded.

use crate::kept_frames::FilmJournal;
use crate::video_format::VideoFormat;

/// Ticks of the track's clock to a frame; the clock runs at the frame rate times this, so frame times are exact.
const TICKS: u32 = 1000;

/// What the boxes tell of the film and of its frames so far.
#[derive(Debug)]
pub(crate) struct Mp4Track {
    width: u32,
    height: u32,
    /// Ticks a second.
    clock: u32,
    pub(crate) journal: FilmJournal,
}

impl Mp4Track {
    /// With the frames that are there already.
    pub(crate) fn new(format: VideoFormat, journal: FilmJournal) -> Self {
        let clock = (format.rate * f64::from(TICKS)).round() as u32;
        Self { width: format.width, height: format.height, clock, journal }
    }

    /// Takes in a frame in the encoder's format (start codes) and returns it in the file's (lengths).
    pub(crate) fn add(&mut self, stream: &[u8], key: bool) -> Vec<u8> {
        let mut frame = Vec::with_capacity(stream.len() + 16);
        for unit in units(stream) {
            match unit[0] & 31 {
                7 => self.journal.parameters[0] = unit.to_vec(),
                8 => self.journal.parameters[1] = unit.to_vec(),
                _ => {
                    frame.extend((unit.len() as u32).to_be_bytes());
                    frame.extend(unit);
                }
            }
        }
        if !frame.is_empty() {
            self.journal.sizes.push((frame.len() as u32, key));
        }
        frame
    }

    /// Everything in front of the frames, which then follow in one piece.
    pub(crate) fn head(&self) -> Vec<u8> {
        let kind = boxed(*b"ftyp", &[b"isom", &512_u32.to_be_bytes(), b"isomiso2avc1mp41"]);
        let frames = self.journal.bytes();
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
        self.journal.sizes.len() as u64 * u64::from(TICKS)
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
        let (sizes, count) = (&self.journal.sizes, self.journal.sizes.len() as u32);
        // Frames count from 1.
        let keys: Vec<u32> =
            (1..).zip(sizes).filter(|(_, (_, key))| *key).map(|(number, _)| number).collect();
        let sizes: Vec<u32> = sizes.iter().map(|(size, _)| *size).collect();
        boxed(
            *b"stbl",
            &[
                &full(*b"stsd", 0, &[&words(&[1]), &self.description()]),
                &full(*b"stts", 0, &[&words(&[1, count, TICKS])]),
                &full(*b"stss", 0, &[&words(&[keys.len() as u32]), &words(&keys)]),
                // One chunk holds all frames.
                &full(*b"stsc", 0, &[&words(&[1, 1, count, 1])]),
                &full(*b"stsz", 0, &[&words(&[0, count]), &words(&sizes)]),
                &full(*b"co64", 0, &[&words(&[1]), &frames_at.to_be_bytes()]),
            ],
        )
    }

    fn description(&self) -> Vec<u8> {
        let short = |n: u32| (n as u16).to_be_bytes();
        let [sequence, picture] = &self.journal.parameters;
        // The profile and the level of the stream.
        let parameters = boxed(
            *b"avcC",
            &[
                &[1],
                sequence.get(1..4).unwrap_or(&[66, 0, 31]),
                // Lengths of four bytes; one sequence and one picture parameter set.
                &[0xff, 0xe1],
                &short(sequence.len() as u32),
                sequence,
                &[1],
                &short(picture.len() as u32),
                picture,
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
        let format = VideoFormat { width: 64, height: 32, rate: 30.0 };
        let mut track = Mp4Track::new(format, FilmJournal::default());
        let stream = [0, 0, 0, 1, 0x67, 66, 0, 31, 0, 0, 0, 1, 0x68, 9, 0, 0, 1, 0x65, 7, 8];
        assert_eq!(track.add(&stream, true), [0, 0, 0, 3, 0x65, 7, 8]);
        assert_eq!(track.journal.parameters, [vec![0x67, 66, 0, 31], vec![0x68, 9]]);
        assert_eq!(track.journal.sizes, [(7, true)]);
    }
}
