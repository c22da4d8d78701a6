//! The descriptors that readers decode with say what the messages are.

use gotai::record::schema;
use gotai::rows::{self, BodyRow, columns};
use prost::Message;
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::{Label, Type};
use quote::ToTokens;
use std::collections::BTreeMap;

/// Name, number, type and whether it repeats, of every field.
type Fields = Vec<(String, i32, Type, bool)>;

/// The structs of `record/schema.rs`, by what their `#[prost(…)]` say.
fn messages() -> BTreeMap<String, Fields> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/src/record/schema.rs");
    let file = syn::parse_file(&std::fs::read_to_string(path).unwrap()).unwrap();
    let fields = |item: &syn::ItemStruct| -> Fields { item.fields.iter().filter_map(field).collect() };
    let structs = file.items.iter().filter_map(|item| match item {
        syn::Item::Struct(item) => Some((item.ident.to_string(), fields(item))),
        _ => None,
    });
    structs.filter(|(_, fields)| !fields.is_empty()).collect()
}

/// Of a field with `#[prost(double, repeated, tag = "2")]`.
fn field(field: &syn::Field) -> Option<(String, i32, Type, bool)> {
    let attribute = field.attrs.iter().find(|attribute| attribute.path().is_ident("prost"))?;
    let words = attribute.meta.require_list().unwrap().tokens.to_string().replace([' ', '"'], "");
    let words: Vec<&str> = words.split(',').collect();
    let kind = match words[0] {
        "double" => Type::Double,
        "uint64" => Type::Uint64,
        "string" => Type::String,
        "message" => Type::Message,
        other => panic!("a type that this test does not know: {other}"),
    };
    let number = words.iter().find_map(|word| word.strip_prefix("tag=")).unwrap().parse().unwrap();
    Some((field.ident.to_token_stream().to_string(), number, kind, words.contains(&"repeated")))
}

#[test]
fn descriptors_say_what_the_messages_are() {
    let set = FileDescriptorSet::decode(schema::descriptor_set().as_slice()).unwrap();
    let of_field = |field: &prost_types::FieldDescriptorProto| {
        (field.name().to_string(), field.number(), field.r#type(), field.label() == Label::Repeated)
    };
    let described: BTreeMap<String, Fields> = set.file[0]
        .message_type
        .iter()
        .map(|message| (message.name().to_string(), message.field.iter().map(of_field).collect()))
        .collect();
    let messages = messages();
    assert_eq!(messages.len(), 6);
    assert_eq!(described, messages);
}

/// A body's vectors are called the same in a recording, in columns and in JSON.
#[test]
fn a_body_has_the_same_names_in_every_file() {
    let row = rows::cells(&BodyRow::default());
    let keys: Vec<&str> = row.keys().map(String::as_str).collect();
    let headings: Vec<_> = columns::STATE.iter().map(|heading| heading.name.trim_start_matches("<body>.")).collect();
    assert_eq!(headings, keys);
    let lengths: Vec<_> = columns::STATE.iter().map(|heading| heading.parts.len()).collect();
    assert_eq!(lengths, row.values().map(|vector| vector.as_array().unwrap().len()).collect::<Vec<_>>());
    let message: Vec<_> = messages()["BodyState"].iter().skip(1).map(|(name, ..)| name.clone()).collect();
    assert_eq!(message, keys);
}
