// SPDX-License-Identifier: MIT
// Any bytes as a server's messages to the C++ client. Its session must continue or throw one of its
// two exceptions, and the values for controllers must be consistent. Only the socket is replaced:
// the messages are the input, split at `separator`. The first byte selects a controller's session
// or a supervisor.

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "require.h"
#include "transport.h"
#include "ziggurat/error.h"
#include "ziggurat/session.h"
#include "ziggurat/supervisor.h"

namespace {

using namespace ziggurat;
using fuzz::require;

constexpr std::string_view separator = "\n--\n";

std::vector<std::string_view> frames;  // not received yet, in reverse order
double seen = 0;                       // sum of all values, so that all are read
int waits = 0;  // questions whether a wait is interrupted, since a frame was wanted

void split(std::string_view bytes) {
  frames.clear();
  for (;;) {
    const auto end = bytes.find(separator);
    frames.push_back(bytes.substr(0, end));
    if (end == std::string_view::npos) break;
    bytes.remove_prefix(end + separator.size());
  }
  std::ranges::reverse(frames);
}

}  // namespace

namespace ziggurat {
namespace {

/// Receives the input; a connection that replaces a lost one goes on where that one was.
class Input final : public Transport {
 public:
  void send(std::size_t size, const std::function<void(char*)>& write) override {
    static std::vector<char> bytes;
    bytes.resize(size);
    write(bytes.data());
  }
  bool receive(std::chrono::milliseconds) override {
    waits = 0;
    if (frames.empty()) return false;
    content_ = frames.back();
    frames.pop_back();
    return true;
  }
  std::string_view content() override { return content_; }
  bool has_more() const override { return false; }
  bool was_closed() override { return frames.empty(); }
  bool is_accepted() override { return false; }
  void linger() override {}

 private:
  std::string_view content_;
};

}  // namespace

std::unique_ptr<Transport> make_transport(const SessionOptions&) {
  return std::make_unique<Input>();
}

}  // namespace ziggurat

namespace {

void see(Bytes bytes) {
  for (const std::uint8_t byte : bytes) seen += byte;
}

void see_camera(const Camera& camera) {
  for (const auto& led : camera.leds()) seen += led.center[0] + led.color.red;
  for (const auto& led : camera.directional_leds()) seen += led.center[1] + led.color.blue;
  for (const auto& tag : camera.tags()) {
    seen += tag.center[0] + tag.corners[3][1] + static_cast<double>(tag.payload.size());
  }
  require(camera.image().empty() || camera.image().size() / 3 / camera.width() == camera.height());
  see(camera.image());
}

void see_robot(Robot& robot) {
  for (const Joint& joint : robot.joints()) seen += joint.encoder() + joint.target();
  for (const Radio& radio : robot.radios()) {
    require(radio.receives() || radio.received().empty());
    for (const Bytes message : radio.received()) see(message);
  }
  for (const auto& sensor : robot.proximity_sensors()) seen += sensor.reading();
  for (const Camera& camera : robot.cameras()) see_camera(camera);
  if (const auto* device = robot.range_and_bearing()) {
    for (const auto& packet : device->packets()) see(packet.data);
    require(!device->sends() || device->data().size() == device->data_size());
  }
  if (const auto* sensor = robot.positioning()) seen += sensor->orientation[3];
  for (const auto& imu : robot.imus()) seen += imu.acceleration()[0] + imu.angular_velocity()[2];
  for (const auto& device : robot.devices()) {
    for (const double reading : device.readings()) seen += reading;
    for (std::size_t i = 0; i < device.row_count(); ++i) seen += device.row(i)[0];
  }
  for (const auto& sensor : robot.contact_sensors()) seen += sensor.force()[2] + sensor.strength();
  if (const auto* sensor = robot.battery()) seen += sensor->time_left;
  if (const auto* wheels = robot.wheels()) seen += wheels->reading().distance_right;
  if (const auto* turret = robot.turret()) seen += turret->rotation();
}

void set_robot(Robot& robot) {
  for (Joint& joint : robot.joints()) {
    if (joint.has_motor()) joint.set_target(1);
  }
  for (Radio& radio : robot.radios()) {
    try {
      if (radio.sends()) radio.send({});
    } catch (const std::length_error&) {  // a Welcome may allow nothing
    }
  }
  for (Led& led : robot.leds()) led.set_color({1, 2, 3});
  for (Led& led : robot.directional_leds()) led.set_color({1, 2, 3});
  for (Tag& tag : robot.tags()) tag.set_payload(robot.id().substr(0, 10));
  for (Magnet& magnet : robot.magnets()) magnet.set_current(1);
  if (auto* device = robot.range_and_bearing(); device != nullptr && device->sends()) {
    device->clear_data();
  }
  if (auto* wheels = robot.wheels(); wheels != nullptr && wheels->drives()) {
    wheels->set_velocity(1, 2);
  }
  if (auto* turret = robot.turret(); turret != nullptr && turret->drives()) {
    turret->set_mode(TurretMode::speed);
    turret->set_rotation_speed(1);
  }
}

void run_session(const Options& options) {
  Session session(options);
  while (!frames.empty()) {
    try {
      if (!session.next()) break;
    } catch (const ConnectionError&) {
      continue;  // after invalid bytes the session can continue
    }
    for (Robot& robot : session.robots()) {
      see_robot(robot);
      set_robot(robot);
    }
  }
}

void supervise() {
  Supervisor supervisor({});
  while (!frames.empty()) {
    try {
      const ServerStatus status = supervisor.status();
      for (const SessionStatus& each : status.sessions) seen += each.latency.p99;
      require(!supervisor.last_answer_json().empty());
      supervisor.read();
      require(!supervisor.last_answer_json().empty());
      supervisor.pause();
    } catch (const ConnectionError&) {
    } catch (const ProtocolError&) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  google::protobuf::SetLogHandler(nullptr);  // it would log every text that is not UTF-8
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const Options options = [] {
    Options all;
    all.endpoint = "ipc:///input";
    constexpr int most = 2;  // a pause between two attempts is cut short
    all.is_interrupted = [] { return frames.empty() || ++waits > most; };
    return all;
  }();
  split({reinterpret_cast<const char*>(data + 1), size - 1});
  try {
    data[0] % 2 == 0 ? run_session(options) : supervise();
  } catch (const ConnectionError&) {
  } catch (const ProtocolError&) {
  }
  return 0;
}
