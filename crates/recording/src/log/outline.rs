//! What stands outside the chunks of a log, and where those are.

use super::{NAME, OURS};
use crate::Error;
use mcap::records::{Header, Record as Chunked, op};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// A chunk of messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chunk {
    /// Of its content in the file.
    pub(super) start: u64,
    pub(super) length: u64,
    /// Time of its first message, ns.
    pub(super) begin: u64,
}

/// More than this no record of ours is long, bytes.
pub(super) const LONGEST: u64 = 1 << 30;

/// A record by its code. The library takes for granted that there is a checksum behind an attachment.
pub(super) fn parse(code: u8, body: &[u8]) -> mcap::McapResult<Chunked<'_>> {
    if code == op::ATTACHMENT && !is_closed(body) {
        return Err(mcap::McapError::UnexpectedEof);
    }
    mcap::parse_record(code, body)
}

/// Whether an attachment has all that stands around its data: two times, two texts, a length, and a checksum.
fn is_closed(body: &[u8]) -> bool {
    let after_text = |at: usize| {
        let length = u32::from_le_bytes(body.get(at..at.checked_add(4)?)?.try_into().ok()?);
        at.checked_add(4)?.checked_add(usize::try_from(length).ok()?)
    };
    let least = after_text(16).and_then(after_text).and_then(|at| at.checked_add(8 + 4));
    least.is_some_and(|least| least <= body.len())
}

/// So many bytes of a file.
pub(super) fn body(file: &mut &File, start: u64, length: u64) -> std::io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(start))?;
    let mut bytes = Vec::new();
    file.take(length.min(LONGEST)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// What stands outside the chunks, and where those are.
#[derive(Default)]
pub(super) struct ChunkOutline {
    pub(super) around: Around,
    pub(super) chunks: Vec<Chunk>,
    pub(super) whole: bool,
    /// Another program wrote it: nothing can be said of how it is laid.
    pub(super) foreign: bool,
}

impl ChunkOutline {
    /// Goes through the records of a file.
    pub(super) fn of(file: &mut File, path: &Path) -> Result<Self, Error> {
        let io = |source| Error::io("read", path)(source);
        let about = file.metadata().map_err(io)?;
        let mut magic = [0; 8];
        file.rewind().map_err(io)?;
        if about.is_dir() || file.read_exact(&mut magic).is_err() || magic != *mcap::MAGIC {
            return Err(Error::log(path, "is not a log: it does not begin as MCAP files do"));
        }
        let mut outline = Self::default();
        let (mut at, end) = (mcap::MAGIC.len() as u64, about.len());
        let mut reader = &*file;
        while at + 9 <= end {
            let head = body(&mut reader, at, 9).map_err(io)?;
            let Some((code, length)) = head.split_first() else { break };
            let Ok(length) = length.try_into().map(u64::from_le_bytes) else { break };
            let start = at + 9;
            // A record that reaches beyond the file was being written when the run was cut off.
            if length > end - start {
                break;
            }
            match *code {
                op::CHUNK if length >= 16 => {
                    // Begin, end, size, checksum, and the name of the compression after its length.
                    let head = body(&mut reader, start, 36).map_err(io)?;
                    let begin = head.first_chunk().map_or(0, |begin| u64::from_le_bytes(*begin));
                    outline.foreign |=
                        head.get(28..).is_some_and(|name| name.starts_with(&[4, 0, 0, 0, b'z']));
                    outline.chunks.push(Chunk { start, length, begin });
                }
                op::HEADER if length < LONGEST => {
                    let bytes = body(&mut reader, start, length).map_err(io)?;
                    if let Ok(Chunked::Header(Header { library, .. })) = parse(*code, &bytes) {
                        outline.foreign = !library.starts_with(OURS);
                    }
                }
                op::MESSAGE => outline.foreign = true,
                op::METADATA | op::ATTACHMENT if length < LONGEST => {
                    let bytes = body(&mut reader, start, length).map_err(io)?;
                    if let Ok(item) = parse(*code, &bytes) {
                        outline.around.note(item);
                    }
                }
                op::DATA_END => outline.whole = true,
                _ => {}
            }
            at = start + length;
        }
        Ok(outline)
    }
}

/// What a log says of its run before and after the moments.
#[derive(Default)]
pub(super) struct Around {
    pub(super) format: Option<String>,
    pub(super) manifest: Option<String>,
    pub(super) scene: Option<String>,
}

impl Around {
    pub(super) fn note(&mut self, item: Chunked<'_>) {
        match item {
            Chunked::Metadata(metadata) if metadata.name == NAME => {
                self.format = metadata.metadata.get("format").cloned();
            }
            Chunked::Attachment { header, data, .. } => {
                let text = String::from_utf8(data.into_owned()).ok();
                match &*header.name {
                    // The last one is that of the end.
                    "manifest.json" => self.manifest = text.or(self.manifest.take()),
                    "scene.toml" => self.scene = text.or(self.scene.take()),
                    _ => {}
                }
            }
            _ => {}
        }
    }
}
