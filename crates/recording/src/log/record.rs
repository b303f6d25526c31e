//! Messages of our own: each lists its fields once, and is written, read and described by that list.
//!
//! The encoding is that of Protocol Buffers. Fields are numbered in the order of the list, and those that are zero are
//! left out; negative zero is not zero, so every f64 comes back bit for bit.

use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet,
};
use vocabulary::Word;

/// What has fields.
pub(super) trait Record {
    /// Name of the message, without its package.
    const NAME: &'static str;

    /// Shows `fields` every field in order; `None` where what was read makes no sense.
    fn list<F: Fields>(&mut self, fields: &mut F) -> Option<()>;
}

/// The value of a field.
pub(super) enum FieldValue<'a> {
    Number(&'a mut f64),
    /// As many as there are.
    Numbers(&'a mut [f64]),
    Series(&'a mut Vec<f64>),
    Count(&'a mut u64),
    Flag(&'a mut bool),
    Text(&'a mut String),
    /// Index of one of these words, the first of which is the default.
    Choice(&'a mut usize, &'a [&'static str]),
}

/// Whoever goes through the fields of a message: names end in their unit.
pub(super) trait Fields {
    fn field(&mut self, name: &'static str, value: FieldValue<'_>) -> Option<()>;

    fn each<T: Record + Default>(&mut self, name: &'static str, values: &mut Vec<T>) -> Option<()>;

    fn number(&mut self, name: &'static str, value: &mut f64) -> Option<()> {
        self.field(name, FieldValue::Number(value))
    }

    /// Numbers that are a field each.
    fn several<const N: usize>(&mut self, names: [&'static str; N], values: [&mut f64; N]) -> Option<()> {
        names.into_iter().zip(values).try_for_each(|(name, value)| self.number(name, value))
    }

    fn numbers(&mut self, name: &'static str, values: &mut [f64]) -> Option<()> {
        self.field(name, FieldValue::Numbers(values))
    }

    fn flag(&mut self, name: &'static str, value: &mut bool) -> Option<()> {
        self.field(name, FieldValue::Flag(value))
    }

    fn text(&mut self, name: &'static str, value: &mut String) -> Option<()> {
        self.field(name, FieldValue::Text(value))
    }

    /// A whole number of any type.
    fn count<T>(&mut self, name: &'static str, value: &mut T) -> Option<()>
    where
        T: Copy + TryInto<u64> + TryFrom<u64>,
    {
        let mut wide = (*value).try_into().ok()?;
        self.field(name, FieldValue::Count(&mut wide))?;
        *value = T::try_from(wide).ok()?;
        Some(())
    }

    fn word<T: Word>(&mut self, name: &'static str, value: &mut T) -> Option<()> {
        let words: Vec<&'static str> = T::WORDS.iter().map(|(word, ..)| *word).collect();
        let mut index = T::WORDS.iter().position(|(_, one, _)| one == value)?;
        self.field(name, FieldValue::Choice(&mut index, &words))?;
        *value = T::WORDS.get(index)?.1;
        Some(())
    }
}

/// Appends `record` to `out`.
pub(super) fn write<T: Record>(record: &mut T, out: &mut Vec<u8>) {
    // What writes never refuses.
    let _ = record.list(&mut FieldWriter { out, field: 0 });
}

/// The record in `data`, all of it.
pub(super) fn read<T: Record + Default>(data: &[u8]) -> Option<T> {
    let mut record = T::default();
    let mut reader = Reader { data, field: 0 };
    record.list(&mut reader)?;
    reader.data.is_empty().then_some(record)
}

const VARINT: u32 = 0;
const FIXED: u32 = 1;
const BYTES: u32 = 2;

struct FieldWriter<'a> {
    out: &'a mut Vec<u8>,
    field: u32,
}

fn put_varint(out: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

impl FieldWriter<'_> {
    fn tag(&mut self, wire: u32) {
        put_varint(self.out, u64::from(self.field << 3 | wire));
    }

    fn varint(&mut self, value: u64) {
        if value != 0 {
            self.tag(VARINT);
            put_varint(self.out, value);
        }
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.tag(BYTES);
        put_varint(self.out, bytes.len() as u64);
        self.out.extend_from_slice(bytes);
    }

    fn doubles(&mut self, values: &[f64]) {
        if !values.is_empty() {
            self.tag(BYTES);
            put_varint(self.out, 8 * values.len() as u64);
            self.out.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        }
    }
}

impl Fields for FieldWriter<'_> {
    fn field(&mut self, _: &'static str, value: FieldValue<'_>) -> Option<()> {
        self.field += 1;
        match value {
            FieldValue::Number(value) if value.to_bits() == 0 => {}
            FieldValue::Number(value) => {
                self.tag(FIXED);
                self.out.extend_from_slice(&value.to_le_bytes());
            }
            FieldValue::Numbers(values) if values.iter().all(|value| value.to_bits() == 0) => {}
            FieldValue::Numbers(values) => self.doubles(values),
            FieldValue::Series(values) => self.doubles(values),
            FieldValue::Count(value) => self.varint(*value),
            FieldValue::Flag(value) => self.varint(u64::from(*value)),
            FieldValue::Choice(index, _) => self.varint(*index as u64),
            FieldValue::Text(text) if text.is_empty() => {}
            FieldValue::Text(text) => self.bytes(text.as_bytes()),
        }
        Some(())
    }

    fn each<T: Record + Default>(&mut self, _: &'static str, values: &mut Vec<T>) -> Option<()> {
        self.field += 1;
        let mut inner = vec![];
        for value in values {
            inner.clear();
            write(value, &mut inner);
            self.bytes(&inner);
        }
        Some(())
    }
}

struct Reader<'a> {
    data: &'a [u8],
    field: u32,
}

fn take_varint(data: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (first, rest) = data.split_first()?;
        *data = rest;
        value |= u64::from(first & 0x7f) << shift;
        if first & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

impl<'a> Reader<'a> {
    /// Whether the current field comes next, as `wire`; it is entered if so.
    fn comes(&mut self, wire: u32) -> Option<bool> {
        let mut ahead = self.data;
        if ahead.is_empty() {
            return Some(false);
        }
        let tag = take_varint(&mut ahead)?;
        let ours = tag == u64::from(self.field << 3 | wire);
        if ours {
            self.data = ahead;
        }
        Some(ours)
    }

    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.data.split_at_checked(count)?;
        self.data = rest;
        Some(taken)
    }

    fn varint(&mut self) -> Option<u64> {
        if self.comes(VARINT)? { take_varint(&mut self.data) } else { Some(0) }
    }

    fn bytes(&mut self) -> Option<&'a [u8]> {
        if !self.comes(BYTES)? {
            return Some(&[]);
        }
        let count = take_varint(&mut self.data)?;
        self.take(usize::try_from(count).ok()?)
    }
}

fn numbers_of(bytes: &[u8]) -> Option<impl ExactSizeIterator<Item = f64> + '_> {
    let (values, rest) = bytes.as_chunks::<8>();
    rest.is_empty().then(|| values.iter().map(|value| f64::from_le_bytes(*value)))
}

impl Fields for Reader<'_> {
    fn field(&mut self, _: &'static str, value: FieldValue<'_>) -> Option<()> {
        self.field += 1;
        match value {
            FieldValue::Number(value) => {
                let comes = self.comes(FIXED)?;
                *value = if comes { f64::from_le_bytes(self.take(8)?.try_into().ok()?) } else { 0.0 };
            }
            FieldValue::Numbers(values) => {
                let found = numbers_of(self.bytes()?)?;
                if found.len() == 0 {
                    values.fill(0.0);
                } else {
                    (found.len() == values.len()).then_some(())?;
                    values.iter_mut().zip(found).for_each(|(value, found)| *value = found);
                }
            }
            FieldValue::Series(values) => {
                values.clear();
                values.extend(numbers_of(self.bytes()?)?);
            }
            FieldValue::Count(value) => *value = self.varint()?,
            FieldValue::Flag(value) => *value = self.varint()? != 0,
            FieldValue::Text(text) => std::str::from_utf8(self.bytes()?).ok()?.clone_into(text),
            FieldValue::Choice(index, words) => {
                *index = usize::try_from(self.varint()?).ok().filter(|index| *index < words.len())?;
            }
        }
        Some(())
    }

    fn each<T: Record + Default>(&mut self, _: &'static str, values: &mut Vec<T>) -> Option<()> {
        values.clear();
        self.field += 1;
        while self.comes(BYTES)? {
            let count = take_varint(&mut self.data)?;
            values.push(read(self.take(usize::try_from(count).ok()?)?)?);
        }
        Some(())
    }
}

/// Collects what a message is made of.
#[derive(Default)]
struct Description {
    message: DescriptorProto,
    others: Vec<DescriptorProto>,
}

/// Prefix of the names of our messages.
pub(super) const PACKAGE: &str = "echelon";

/// Full name and descriptor of a message, as the log carries them.
pub(super) fn schema<T: Record + Default>() -> (String, Vec<u8>) {
    let mut messages = describe::<T>();
    let mut known = std::collections::BTreeSet::new();
    messages.retain(|message| known.insert(message.name().to_owned()));
    let file = FileDescriptorProto {
        name: Some(format!("{PACKAGE}/{}.proto", T::NAME)),
        package: Some(PACKAGE.to_owned()),
        syntax: Some("proto3".to_owned()),
        message_type: messages,
        ..FileDescriptorProto::default()
    };
    let set = FileDescriptorSet { file: vec![file] };
    (format!("{PACKAGE}.{}", T::NAME), prost::Message::encode_to_vec(&set))
}

fn describe<T: Record + Default>() -> Vec<DescriptorProto> {
    let mut description = Description::default();
    description.message.name = Some(T::NAME.to_owned());
    // What describes never refuses.
    let _ = T::default().list(&mut description);
    let mut all = vec![description.message];
    all.append(&mut description.others);
    all
}

impl Description {
    /// An enum of `words` for the field `name`, whose name in capitals it gets.
    fn enumerate(&mut self, name: &str, words: &[&str]) -> String {
        let kind: String = name.split('_').map(|part| part[..1].to_uppercase() + &part[1..]).collect();
        let value = |(number, word): (usize, &&str)| EnumValueDescriptorProto {
            name: Some((*word).to_owned()),
            number: Some(number as i32),
            ..EnumValueDescriptorProto::default()
        };
        self.message.enum_type.push(EnumDescriptorProto {
            name: Some(kind.clone()),
            value: words.iter().enumerate().map(value).collect(),
            ..EnumDescriptorProto::default()
        });
        kind
    }

    fn add(&mut self, name: &str, kind: Type, label: Label, of: Option<String>) {
        let number = self.message.field.len() as i32 + 1;
        self.message.field.push(FieldDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            label: Some(label.into()),
            r#type: Some(kind.into()),
            type_name: of,
            json_name: Some(name.to_owned()),
            ..FieldDescriptorProto::default()
        });
    }
}

impl Fields for Description {
    fn field(&mut self, name: &'static str, value: FieldValue<'_>) -> Option<()> {
        let (kind, label) = match value {
            FieldValue::Number(_) => (Type::Double, Label::Optional),
            FieldValue::Numbers(_) | FieldValue::Series(_) => (Type::Double, Label::Repeated),
            FieldValue::Count(_) => (Type::Uint64, Label::Optional),
            FieldValue::Flag(_) => (Type::Bool, Label::Optional),
            FieldValue::Text(_) => (Type::String, Label::Optional),
            FieldValue::Choice(_, words) => {
                // Names of values share the scope of their message: two fields of the same words have one enum.
                let same = |known: &&EnumDescriptorProto| {
                    known.value.iter().map(EnumValueDescriptorProto::name).eq(words.iter().copied())
                };
                let kind = match self.message.enum_type.iter().find(same) {
                    Some(known) => known.name().to_owned(),
                    None => self.enumerate(name, words),
                };
                let of = format!(".{PACKAGE}.{}.{kind}", self.message.name());
                self.add(name, Type::Enum, Label::Optional, Some(of));
                return Some(());
            }
        };
        self.add(name, kind, label, None);
        Some(())
    }

    fn each<T: Record + Default>(&mut self, name: &'static str, _: &mut Vec<T>) -> Option<()> {
        self.others.extend(describe::<T>());
        self.add(name, Type::Message, Label::Repeated, Some(format!(".{PACKAGE}.{}", T::NAME)));
        Some(())
    }
}
