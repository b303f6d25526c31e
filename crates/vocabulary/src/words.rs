//! Choices that have a word in scene files, logs and messages.

/// A choice of a few, each with its word.
pub trait Word: Copy + PartialEq + 'static {
    /// Words with what they stand for and what that means. Where two words stand for the same, the first is the name.
    const WORDS: &'static [(&'static str, Self, &'static str)];

    /// The word for this choice.
    fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, known, _)| *known == self).map_or("", |(word, ..)| word)
    }
}

/// Defines an enum whose variants have words, with its default behind its name if it has one. After a bar stands another
/// word for the same.
#[macro_export]
macro_rules! words {
    (
        $(#[doc = $about:literal])*
        $vis:vis enum $name:ident $(= $default:ident)? {
            $( $(#[doc = $doc:literal])* $variant:ident = $word:literal $(| $other:literal)?, )+
        }
    ) => {
        $(#[doc = $about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $vis enum $name { $( $(#[doc = $doc])* $variant, )+ }

        $(impl Default for $name {
            fn default() -> Self {
                Self::$default
            }
        })?

        impl $crate::serde::Serialize for $name {
            fn serialize<S: $crate::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str($crate::Word::word(*self))
            }
        }

        impl $crate::Word for $name {
            const WORDS: &'static [(&'static str, Self, &'static str)] = &[$(
                ($word, Self::$variant, concat!($($doc),*)),
                $( ($other, Self::$variant, concat!("As `", $word, "`.")), )?
            )+];
        }
    };
}
