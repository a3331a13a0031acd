// SPDX-License-Identifier: MIT
#include "channels/schema.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <vector>

namespace ziggurat::channels {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FileDescriptor;

const Descriptor& outermost(const Descriptor& type) {
  return type.containing_type() ? outermost(*type.containing_type()) : type;
}

/// The types at the top of files that a type uses. Files also have others: without them a schema is
/// a few hundred bytes instead of twenty thousand, which counts with thousands of channels.
struct Used {
  std::set<const Descriptor*> messages;
  std::set<const EnumDescriptor*> enums;
  std::vector<const FileDescriptor*> files;  // those that others use before them

  void add(const Descriptor& type) {
    const Descriptor& top = outermost(type);
    if (messages.insert(&top).second) add_fields(top);
  }

 private:
  void add_fields(const Descriptor& type) {
    for (int i = 0; i < type.nested_type_count(); ++i) add_fields(*type.nested_type(i));
    for (int i = 0; i < type.field_count(); ++i) {
      const auto& field = *type.field(i);
      if (field.message_type()) add(*field.message_type());
      if (field.enum_type()) add(*field.enum_type());
    }
    add_file(*type.file());
  }
  void add(const EnumDescriptor& type) {
    if (type.containing_type()) return add(*type.containing_type());
    enums.insert(&type);
    add_file(*type.file());
  }
  void add_file(const FileDescriptor& file) {
    if (std::ranges::find(files, &file) != files.end()) return;
    for (int i = 0; i < file.dependency_count(); ++i) {
      add_file(*file.dependency(i));
    }
    files.push_back(&file);
  }
};

void remove_repeated_bytes(google::protobuf::DescriptorProto& type) {
  using Field = google::protobuf::FieldDescriptorProto;
  for (auto& nested : *type.mutable_nested_type()) remove_repeated_bytes(nested);
  for (int i = type.field_size(); i-- > 0;) {
    const Field& field = type.field(i);
    if (field.type() == Field::TYPE_BYTES && field.label() == Field::LABEL_REPEATED) {
      type.mutable_field()->DeleteSubrange(i, 1);
    }
  }
}

void write(const FileDescriptor& from, const Used& used,
           google::protobuf::FileDescriptorProto& to) {
  to.set_name(from.name());
  to.set_package(from.package());
  to.set_syntax("proto3");
  for (int i = 0; i < from.dependency_count(); ++i) to.add_dependency(from.dependency(i)->name());
  for (int i = 0; i < from.message_type_count(); ++i) {
    if (used.messages.contains(from.message_type(i))) {
      from.message_type(i)->CopyTo(to.add_message_type());
    }
  }
  for (int i = 0; i < from.enum_type_count(); ++i) {
    if (used.enums.contains(from.enum_type(i))) from.enum_type(i)->CopyTo(to.add_enum_type());
  }
}

}  // namespace

const Schema& schema_of(const Descriptor& type) {
  static std::mutex mutex;
  static std::map<const Descriptor*, Schema> schemas;
  const std::lock_guard lock(mutex);
  Schema& schema = schemas[&type];
  if (!schema.name.empty()) return schema;
  Used used;
  used.add(type);
  google::protobuf::FileDescriptorSet set;
  for (const FileDescriptor* file : used.files) write(*file, used, *set.add_file());
  for (auto& file : *set.mutable_file()) {
    for (auto& message : *file.mutable_message_type()) remove_repeated_bytes(message);
  }
  schema = {type.full_name(), set.SerializeAsString()};
  return schema;
}

}  // namespace ziggurat::channels
