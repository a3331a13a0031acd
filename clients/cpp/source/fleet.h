// SPDX-License-Identifier: MIT
#pragma once
// The robots of a session with all their devices; knows messages, but no connection.

#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "channel.h"
#include "ziggurat/robot.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat {

class Fleet {
 public:
  /// @throws std::runtime_error if a device is described wrongly
  explicit Fleet(const v1::Welcome& welcome);
  Fleet(const Fleet&) = delete;
  Fleet& operator=(const Fleet&) = delete;

  std::span<Robot> robots() { return robots_; }

  /// The message stays unchanged until the next is read: readings point into it.
  /// @throws std::runtime_error if it is not what Welcome announced; nothing is read
  void read(const v1::Observation& observation);
  /// Adds what was set, and moves what was logged, since the last call.
  void write(v1::Command& command);
  /// After the command was sent.
  void sent();
  /// The next command has all values: the server may have discarded the last.
  void repeat();
  /// All values that were set become the initial ones.
  void reset();
  /// The session was resumed or the world restored: values become those that were commanded.
  void resume(v1::Command commanded);
  /// These robots (positions) have left the run. Positions that the session does not have are
  /// ignored.
  void remove(const google::protobuf::RepeatedField<std::uint32_t>& robots);
  void remove(std::string_view id);

  /// Moves what was measured since the last call.
  void move_metrics_to(google::protobuf::RepeatedPtrField<v1::Metric>& metrics);
  void move_log_to(google::protobuf::RepeatedPtrField<v1::LogLine>& lines);
  /// A message for each robot that failed since the last call.
  std::vector<v1::Leave> take_failures();

 private:
  std::vector<Robot> robots_;
  std::unordered_map<std::string_view, Robot*> by_id_;  // made when it is first needed
  Channels channels_;
  Robot::Log log_;
};

}  // namespace ziggurat
