//! What is not for eyes, as text: deflated, in the base64 of addresses. Links carry scenes so, and scenes WebAssembly modules.

use base64::Engine;
use base64::alphabet::URL_SAFE;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_with_limit};

/// Most bytes that are unpacked.
const MOST_BYTES: usize = 1_000_000;
/// Effort of packing: the most.
const LEVEL: u8 = 10;
/// Without padding, which addresses would have to escape. A cut text may leave bits over.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &URL_SAFE,
    GeneralPurposeConfig::new()
        .with_encode_padding(false)
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// What is wrong with packed text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Damage {
    /// It ends in the middle.
    CutOff,
    /// Anything else, in words that go on behind "it".
    Other(&'static str),
}

/// Bytes packed.
pub(crate) fn pack(bytes: &[u8]) -> String {
    BASE64.encode(compress_to_vec(bytes, LEVEL))
}

/// The bytes that were packed.
pub(crate) fn unpack(packed: &str) -> Result<Vec<u8>, Damage> {
    let whole = packed.trim_end_matches('=');
    // Of four characters the last one alone says nothing.
    let whole = if whole.len() % 4 == 1 { whole.get(..whole.len() - 1) } else { Some(whole) };
    let bytes = whole.and_then(|whole| BASE64.decode(whole).ok());
    let bytes = bytes.ok_or(Damage::Other("has characters that nothing packed has"))?;
    decompress_to_vec_with_limit(&bytes, MOST_BYTES).map_err(|error| match error.status {
        TINFLStatus::FailedCannotMakeProgress | TINFLStatus::NeedsMoreInput => Damage::CutOff,
        TINFLStatus::HasMoreOutput => Damage::Other("unpacks to more than 1 MB"),
        _ => Damage::Other("cannot be unpacked"),
    })
}
