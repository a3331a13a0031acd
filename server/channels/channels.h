// SPDX-License-Identifier: MIT
#pragma once
// All that can be shown of a running world, as channels: which there are, and their messages. Each
// message is encoded once, and only if it is wanted. The live server (view/) uses it; it knows
// neither sockets nor files.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "channels/channel.h"
#include "channels/message.h"
#include "channels/moment.h"
#include "channels/poses.h"
#include "foxglove/schemas.pb.h"
#include "wire/request.h"
#include "wire/roster.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::channels {

enum class Severity { info, warning, error };

/// Histogram of a controller's response times.
struct Histogram {
  std::string controller;        ///< id
  double least = 0, growth = 1;  ///< bin i begins at least * growth^i [s]
  std::span<const std::uint64_t> counts;
  std::uint64_t missed_ticks = 0;
};

class Channels {
 public:
  /// Without any population the channels of the world as a whole are listed.
  Channels();

  /// The world began, or entities came or went. What the population refers to must stay until the
  /// next call. Topics that stay keep their ids.
  void populate(const Population& population);
  /// Ascending by id.
  const std::vector<Channel>& list() const { return list_; }
  /// Grows with each populate().
  std::uint64_t generation() const { return world_.generation(); }

  void set_layers(const Layers& layers) { layers_ = layers; }
  const Layers& layers() const { return layers_; }

  /// Appends the messages of the wanted channels that have this pace.
  /// @param wanted  ids, ascending; unknown ones are skipped
  void encode(const Moment& moment, Pace pace, std::span<const std::uint32_t> wanted,
              std::vector<Message>& to);

  /// @param name  of the robot, or `ziggurat`
  static Message log(std::int64_t time_ns, Severity severity, std::string_view name,
                     std::string_view text);
  /// @param values  of all metrics, by ROBOT/NAME
  static Message metrics(std::uint64_t tick, std::int64_t time_ns,
                         const std::map<std::string, double>& values);
  static Message barrier(const wire::Status& status, std::span<const Histogram> histograms);

  /// Ids of channels without place.
  static std::uint32_t id_of(Kind kind) { return static_cast<std::uint32_t>(kind) + 1; }

 private:
  std::optional<std::string> bytes_of(const Channel& channel, const Moment& moment);
  const wire::Roster& roster_of(std::size_t robot);
  void list_channels();
  void add(Kind kind, std::string topic, std::size_t place);

  std::vector<Channel> list_;
  std::map<std::string, std::uint32_t> ids_;  // of topics with a place, also of earlier ones
  std::uint32_t next_id_ = 100;

  std::optional<Population> population_;
  Layers layers_;
  v1::World world_;
  v1::Poses poses_;
  PoseSource pose_source_;
  foxglove::FrameTransforms frames_;
  // Messages of the last tick: their memory is used again.
  v1::Rays rays_;
  v1::Detections detections_;
  v1::RadioTraffic traffic_;
  v1::Contacts contacts_;
  v1::Observation observation_;
  v1::Command command_;
  std::vector<std::optional<wire::Roster>> rosters_;  // per robot, when it is asked for
};

}  // namespace ziggurat::channels
