// SPDX-License-Identifier: MIT
#include "outputs/json.h"

#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver.h>
#include <google/protobuf/util/type_resolver_util.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <random>
#include <string>

#include "file_text.h"
#include "foxglove/schemas.pb.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/protocol.pb.h"
#include "ziggurat/v1/recording.pb.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::outputs {
namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

/// As protobuf does it.
std::string as_protobuf_writes(const pb::Message& message) {
  const auto& type = *message.GetDescriptor();
  const std::unique_ptr<pb::util::TypeResolver> resolver(
      pb::util::NewTypeResolverForDescriptorPool("type.ziggurat", type.file()->pool()));
  std::string bytes, json;
  {
    pb::io::StringOutputStream stream(&bytes);
    pb::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  pb::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  const auto status = pb::util::BinaryToJsonString(
      resolver.get(), "type.ziggurat/" + type.full_name(), bytes, &json, options);
  EXPECT_TRUE(status.ok()) << status;
  return json;
}

std::string as_json(const pb::Message& message) {
  const std::string path = scratch("out.json");
  OutputFile file(path);
  write_json(message, file);
  file.close();
  return outputs::text_of(path);
}

/// Fills messages by chance.
class Chance {
 public:
  explicit Chance(unsigned seed) : draw_(seed) {}

  void fill(pb::Message& message, int levels) {
    const auto& type = *message.GetDescriptor();
    const auto& of = *message.GetReflection();
    if (type.file()->package() == "google.protobuf") {
      return of.SetInt64(&message, type.FindFieldByName("seconds"),
                         static_cast<std::int64_t>(draw_() % 4'000'000'000U));
    }
    for (int i = 0; i < type.field_count(); ++i) {
      const FieldDescriptor& field = *type.field(i);
      const auto count = type.options().map_entry() ? 1
                         : field.is_map()           ? draw_() % 8
                         : field.is_repeated()      ? draw_() % 3
                                                    : draw_() % 2;
      for (unsigned n = 0; n < count; ++n) set(message, field, levels);
    }
  }

 private:
  /// Which are different in a map.
  static bool is_key(const FieldDescriptor& field) {
    return field.containing_type()->options().map_entry() && field.number() == 1;
  }

  double number() {
    const double special[] = {0.0,
                              -0.0,
                              1e300,
                              5e-324,
                              0.1,
                              1.0 / 3,
                              std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN(),
                              1e15,
                              1e-7};
    return draw_() % 2 ? special[draw_() % std::size(special)] : static_cast<double>(draw_()) / 7e5;
  }

  std::string text() {
    const char* pieces[] = {"",     "a",    "\"", "\\",     "<b>",        "&", "/",      "\n",
                            "\x01", "\x7f", "é",  "\u2028", "\U0001F600", "'", "\u200b", "\ufeff"};
    std::string all;
    for (auto n = draw_() % 6; n > 0; --n) all += pieces[draw_() % std::size(pieces)];
    return all;
  }

  void set(pb::Message& to, const FieldDescriptor& field, int levels) {
    const auto& of = *to.GetReflection();
    const bool many = field.is_repeated();
    const auto put = [&](auto single, auto add, auto value) {
      many ? (of.*add)(&to, &field, value) : (of.*single)(&to, &field, value);
    };
    using R = pb::Reflection;
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_INT32:
        return put(&R::SetInt32, &R::AddInt32, static_cast<int>(draw_()));
      case FieldDescriptor::CPPTYPE_UINT32:
        return put(&R::SetUInt32, &R::AddUInt32, static_cast<unsigned>(draw_()));
      case FieldDescriptor::CPPTYPE_INT64:
        return put(&R::SetInt64, &R::AddInt64, -static_cast<std::int64_t>(draw_()) * 9999);
      case FieldDescriptor::CPPTYPE_UINT64:
        return put(&R::SetUInt64, &R::AddUInt64, ~std::uint64_t{draw_()});
      case FieldDescriptor::CPPTYPE_BOOL:
        return put(&R::SetBool, &R::AddBool, draw_() % 2 == 0);
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return put(&R::SetDouble, &R::AddDouble, number());
      case FieldDescriptor::CPPTYPE_FLOAT:
        return put(&R::SetFloat, &R::AddFloat, static_cast<float>(number()));
      case FieldDescriptor::CPPTYPE_ENUM:
        return put(&R::SetEnumValue, &R::AddEnumValue, static_cast<int>(draw_() % 9));
      case FieldDescriptor::CPPTYPE_STRING:
        return put(&R::SetString, &R::AddString,
                   text() + (is_key(field) ? std::to_string(draw_()) : ""));
      case FieldDescriptor::CPPTYPE_MESSAGE:
        break;
    }
    pb::Message& inner = many ? *of.AddMessage(&to, &field) : *of.MutableMessage(&to, &field);
    if (levels > 0 || field.is_map()) fill(inner, levels - 1);
  }

  std::mt19937 draw_;
};

TEST(Json, IsWhatProtobufWrites) {
  const pb::Message* types[] = {&v1::World::default_instance(),
                                &v1::Poses::default_instance(),
                                &v1::Detections::default_instance(),
                                &v1::RadioTraffic::default_instance(),
                                &v1::Rays::default_instance(),
                                &v1::Contacts::default_instance(),
                                &v1::RunStart::default_instance(),
                                &v1::Inputs::default_instance(),
                                &v1::ExactState::default_instance(),
                                &v1::Observation::default_instance(),
                                &v1::Command::default_instance(),
                                &v1::Reading::default_instance(),
                                &v1::RayLine::default_instance(),
                                &foxglove::SceneUpdate::default_instance(),
                                &foxglove::FrameTransforms::default_instance(),
                                &foxglove::CompressedImage::default_instance(),
                                &foxglove::ImageAnnotations::default_instance(),
                                &foxglove::CameraCalibration::default_instance(),
                                &foxglove::Log::default_instance()};
  for (const pb::Message* type : types) {
    const std::unique_ptr<pb::Message> message(type->New());
    ASSERT_EQ(as_json(*message), as_protobuf_writes(*message));
    for (unsigned seed = 0; seed < 30; ++seed) {
      message->Clear();
      Chance(seed).fill(*message, 4);
      ASSERT_EQ(as_json(*message), as_protobuf_writes(*message))
          << type->GetTypeName() << " " << seed;
    }
  }
}

TEST(Json, EveryCharacterIsWhatProtobufWrites) {
  v1::RunStart start;
  std::string& all = *start.mutable_scene();
  for (unsigned code = 1; code < 0x11000; ++code) {
    if (code >= 0xD800 && code < 0xE000) continue;
    const auto low = [](unsigned bits) { return static_cast<char>(0x80U | (bits & 0x3FU)); };
    if (code < 0x80) {
      all += static_cast<char>(code);
    } else if (code < 0x800) {
      all += {static_cast<char>(0xC0U | code >> 6), low(code)};
    } else if (code < 0x10000) {
      all += {static_cast<char>(0xE0U | code >> 12), low(code >> 6), low(code)};
    } else {
      all += {static_cast<char>(0xF0U | code >> 18), low(code >> 12), low(code >> 6), low(code)};
    }
  }
  for (int i = 0; i < 4; ++i)
    all += "x" + std::string(all);  // longer than a piece, which may end within a character
  EXPECT_EQ(as_json(start), as_protobuf_writes(start));
}

TEST(Json, AMessageOfManyPartsTakesLittleMemory) {
  v1::Inputs inputs;
  for (int i = 0; i < 300'000; ++i) inputs.add_acts()->mutable_pause();
  const std::string path = scratch("out.json");
  OutputFile file(path);
  write_json(inputs, file);
  EXPECT_LT(file.buffer().capacity(), std::size_t{64} << 20);
  file.close();
  EXPECT_GT(outputs::text_of(path).size(), std::size_t{6} << 20);
}

}  // namespace
}  // namespace ziggurat::outputs
