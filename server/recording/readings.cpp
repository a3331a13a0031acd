#include "recording/readings.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver.h>
#include <google/protobuf/util/type_resolver_util.h>

#include <memory>
#include <string>
#include <utility>

#include "ziggurat/v1/recording.pb.h"

namespace ziggurat::recording {
namespace {

namespace pb = google::protobuf;

v1::Reading reading(const world::Layout& layout, const world::RobotLayout& robot,
                    const world::Observations& observations, const world::Commands& commands) {
  v1::Reading reading;
  reading.set_tick(observations.tick);
  reading.set_time_s(static_cast<double>(observations.time_ns) / 1e9);
  reading.set_robot(robot.id);
  auto& encoders = *reading.mutable_observation()->mutable_joint_encoders();
  for (std::size_t i = robot.joint_sensors.begin; i < robot.joint_sensors.end(); ++i) {
    encoders[layout.joint_sensors[i].id] = observations.joint_readings[i];
  }
  auto& targets = *reading.mutable_command()->mutable_joint_targets();
  for (std::size_t i = robot.joint_actuators.begin; i < robot.joint_actuators.end(); ++i) {
    targets[layout.joint_actuators[i].id] = commands.joint_targets[i];
  }
  return reading;
}

// MessageToJsonString walks maps in an order that differs from run to run; the deterministic
// encoding sorts them by key, and turning that into JSON keeps the order.
std::string to_json(const v1::Reading& reading) {
  static constexpr char prefix[] = "type.ziggurat";
  const std::unique_ptr<pb::util::TypeResolver> resolver(pb::util::NewTypeResolverForDescriptorPool(
      prefix, v1::Reading::descriptor()->file()->pool()));
  std::string bytes;
  {
    pb::io::StringOutputStream stream(&bytes);
    pb::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    reading.SerializeToCodedStream(&coded);
  }
  pb::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  const auto status = pb::util::BinaryToJsonString(
      resolver.get(), std::string(prefix) + "/" + reading.GetTypeName(), bytes, &json, options);
  if (!status.ok()) throw WriteError("a reading has no JSON form: " + status.ToString());
  return json;
}

}  // namespace

Readings::Readings(std::string path, const world::Layout& layout)
    : layout_(layout), file_(std::move(path)) {}

void Readings::write(const world::Observations& observations, const world::Commands& commands) {
  for (const auto& robot : layout_.robots) {
    file_.buffer().append(to_json(reading(layout_, robot, observations, commands)));
    file_.buffer().push_back('\n');
    file_.written();
  }
}

}  // namespace ziggurat::recording
