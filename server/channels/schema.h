// SPDX-License-Identifier: MIT
#pragma once
// Types of messages, as viewers and recordings need them.

#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace ziggurat::channels {

struct Schema {
  std::string name;  ///< of the type, with its package
  /// A serialized FileDescriptorSet: the type and all that it uses. Fields of repeated bytes are
  /// left out, and decoders skip them: viewers of Foxglove's family refuse a type that has one.
  std::string descriptors;
};

/// The schema of a type; stays where it is.
const Schema& schema_of(const google::protobuf::Descriptor& type);

}  // namespace ziggurat::channels
