#include "recording/json.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver.h>
#include <google/protobuf/util/type_resolver_util.h>

#include <memory>

#include "recording/output_file.h"

namespace ziggurat::recording {

// MessageToJsonString walks maps in an order that differs from run to run; the deterministic
// encoding sorts them by key, and turning that into JSON keeps the order.
std::string to_json(const google::protobuf::Message& message) {
  namespace pb = google::protobuf;
  static constexpr char prefix[] = "type.ziggurat";
  const pb::Descriptor& type = *message.GetDescriptor();
  const std::unique_ptr<pb::util::TypeResolver> resolver(
      pb::util::NewTypeResolverForDescriptorPool(prefix, type.file()->pool()));
  std::string bytes;
  {
    pb::io::StringOutputStream stream(&bytes);
    pb::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  pb::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = pb::util::BinaryToJsonString(
      resolver.get(), std::string(prefix) + "/" + type.full_name(), bytes, &json, options);
  if (!status.ok()) throw WriteError("a line has no JSON form: " + status.ToString());
  return json;
}

}  // namespace ziggurat::recording
