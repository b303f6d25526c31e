//! The text of a scene in a link: deflated, in the base64 of addresses.

use super::LinkError;
use base64::Engine;
use base64::alphabet::URL_SAFE;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use miniz_oxide::deflate::compress_to_vec;
use miniz_oxide::inflate::{TINFLStatus, decompress_to_vec_with_limit};

/// Longest text that is unpacked, bytes.
pub(super) const MOST_TEXT: usize = 1_000_000;
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

/// A text packed.
pub(super) fn pack(text: &str) -> String {
    BASE64.encode(compress_to_vec(text.as_bytes(), LEVEL))
}

/// The text that was packed.
pub(super) fn unpack(packed: &str) -> Result<String, LinkError> {
    let cut = || LinkError::CutOff("its scene ends in the middle".to_owned());
    let whole = packed.trim_end_matches('=');
    // Of four characters the last one alone says nothing.
    let whole = if whole.len() % 4 == 1 { whole.get(..whole.len() - 1) } else { Some(whole) };
    let bytes = whole.and_then(|whole| BASE64.decode(whole).ok());
    let bytes = bytes.ok_or(LinkError::Damaged("it has characters that no packed scene has"))?;
    let text = decompress_to_vec_with_limit(&bytes, MOST_TEXT).map_err(|error| match error.status {
        TINFLStatus::FailedCannotMakeProgress | TINFLStatus::NeedsMoreInput => cut(),
        TINFLStatus::HasMoreOutput => LinkError::Damaged("it unpacks to more than 1 MB"),
        _ => LinkError::Damaged("it cannot be unpacked"),
    })?;
    String::from_utf8(text).map_err(|_| LinkError::Damaged("it unpacks to what is no text"))
}
