// SPDX-License-Identifier: MIT
#include "channels/channels.h"

#include <algorithm>
#include <array>
#include <utility>

#include "channels/exchanged.h"
#include "channels/foxglove.h"
#include "channels/world_message.h"
#include "wire/response.h"

namespace ziggurat::channels {
namespace {

template <class Type>
const Schema& schema() {
  return schema_of(*Type::descriptor());
}

const Schema& schema_of(Kind kind) {
  switch (kind) {
    case Kind::world:
      return schema<v1::World>();
    case Kind::poses:
      return schema<v1::Poses>();
    case Kind::rays:
      return schema<v1::Rays>();
    case Kind::detections:
      return schema<v1::Detections>();
    case Kind::radio:
      return schema<v1::RadioTraffic>();
    case Kind::contacts:
      return schema<v1::Contacts>();
    case Kind::barrier:
      return schema<v1::Barrier>();
    case Kind::phases:
      return schema<v1::Phases>();
    case Kind::metrics:
      return schema<v1::Metrics>();
    case Kind::log:
      return schema<foxglove::Log>();
    case Kind::scene:
      return schema<foxglove::SceneUpdate>();
    case Kind::transforms:
      return schema<foxglove::FrameTransforms>();
    case Kind::observation:
      return schema<v1::Observation>();
    case Kind::command:
      return schema<v1::Command>();
    case Kind::calibration:
      return schema<foxglove::CameraCalibration>();
    case Kind::image:
      return schema<foxglove::CompressedImage>();
    case Kind::annotations:
      break;
  }
  return schema<foxglove::ImageAnnotations>();
}

constexpr std::array whole_world{
    std::pair{Kind::world, "/world"},     std::pair{Kind::poses, "/poses"},
    std::pair{Kind::rays, "/rays"},       std::pair{Kind::detections, "/detections"},
    std::pair{Kind::radio, "/radio"},     std::pair{Kind::contacts, "/contacts"},
    std::pair{Kind::barrier, "/barrier"}, std::pair{Kind::phases, "/phases"},
    std::pair{Kind::log, "/log"},         std::pair{Kind::scene, "/scene"},
    std::pair{Kind::transforms, "/tf"},   std::pair{Kind::metrics, "/metrics"},
};

v1::Phases phases_of(const Moment& moment) {
  using timing::Phase;
  v1::Phases phases;
  phases.set_tick(moment.state.tick);
  phases.set_time_ns(moment.state.time_ns);
  const timing::PhaseTimes& times = moment.phases;
  phases.set_exchange(times.exchange());
  phases.set_physics(times.physics());
  phases.set_recording(times[Phase::recording]);
  phases.set_pacing(times[Phase::pacing]);
  phases.set_encode(times[Phase::encode]);
  phases.set_wait(times[Phase::wait]);
  phases.set_forces(times[Phase::forces]);
  phases.set_magnetism(times[Phase::magnetism]);
  phases.set_contacts(times[Phase::contacts]);
  phases.set_solve(times[Phase::solve]);
  phases.set_integrate(times[Phase::integrate]);
  phases.set_sensing(times[Phase::sensing]);
  return phases;
}

std::shared_ptr<const Content> content_of(std::string bytes) {
  return std::make_shared<const Content>(std::move(bytes));
}

}  // namespace

Channels::Channels() { list_channels(); }

void Channels::populate(const Population& population) {
  population_.emplace(population);
  world_ = describe(population, world_.generation() + 1);
  pose_source_ = pose_source(population);
  frames_ = frames_of(world_);
  rosters_.assign(population.layout.robots.size(), std::nullopt);
  list_channels();
}

void Channels::add(Kind kind, std::string topic, std::size_t place) {
  const auto [known, fresh] = ids_.emplace(topic, next_id_);
  if (fresh) ++next_id_;
  list_.push_back({known->second, std::move(topic), kind, &schema_of(kind), place});
}

void Channels::list_channels() {
  list_.clear();
  for (const auto& [kind, topic] : whole_world) {
    list_.push_back({id_of(kind), topic, kind, &schema_of(kind), 0});
  }
  if (!population_) return;
  const world::Layout& layout = population_->layout;
  for (std::size_t i = 0; i < layout.robots.size(); ++i) {
    const world::RobotLayout& robot = layout.robots[i];
    if (population_->state.is_absent(robot.entity)) continue;
    const std::string topic = "/robots/" + v1::valid_utf8(robot.id);
    add(Kind::observation, topic + "/observation", i);
    add(Kind::command, topic + "/command", i);
    for (std::size_t c = robot.cameras.begin; c < robot.cameras.end(); ++c) {
      const world::CameraLayout& camera = layout.cameras[c];
      const std::string of_camera = topic + "/cameras/" + v1::valid_utf8(camera.id);
      add(Kind::calibration, of_camera + "/calibration", c);
      if (camera.image) add(Kind::image, of_camera + "/image", c);
      add(Kind::annotations, of_camera + "/annotations", c);
    }
  }
  std::ranges::sort(list_, {}, &Channel::id);
}

const wire::Roster& Channels::roster_of(std::size_t robot) {
  std::optional<wire::Roster>& roster = rosters_[robot];
  if (!roster) {
    roster = wire::make_roster(population_->layout, std::array{robot});
    roster->image_cameras.clear();  // pictures have channels of their own
  }
  return *roster;
}

void Channels::encode(const Moment& moment, Pace pace, std::span<const std::uint32_t> wanted,
                      std::vector<Message>& to) {
  if (!population_) return;
  auto channel = list_.begin();
  for (const std::uint32_t id : wanted) {
    channel =
        std::lower_bound(channel, list_.end(), id,
                         [](const Channel& one, std::uint32_t other) { return one.id < other; });
    if (channel == list_.end()) return;
    if (channel->id != id || pace_of(channel->kind) != pace) continue;
    if (!moment.has_observations && shows_observations(channel->kind)) continue;
    std::shared_ptr<const Content> content;
    if (channel->kind == Kind::image) {
      content = picture_of(world_, channel->place, moment);
    } else if (std::optional<std::string> bytes = bytes_of(*channel, moment)) {
      content = content_of(*std::move(bytes));
    }
    const bool must_arrive = pace == Pace::latched;
    if (content) to.push_back({id, moment.state.time_ns, std::move(content), must_arrive});
  }
}

/// Nothing: there is no message at this tick.
std::optional<std::string> Channels::bytes_of(const Channel& channel, const Moment& moment) {
  switch (channel.kind) {
    case Kind::world:
      return world_.SerializeAsString();
    case Kind::poses:
      fill(pose_source_, moment, poses_);
      poses_.set_generation(world_.generation());
      return poses_.SerializeAsString();
    case Kind::rays:
      fill(moment, rays_);
      return rays_.SerializeAsString();
    case Kind::detections:
      fill(moment, detections_);
      return detections_.SerializeAsString();
    case Kind::radio:
      fill(moment, traffic_);
      if (traffic_.messages().empty() && traffic_.packets().empty()) break;
      return traffic_.SerializeAsString();
    case Kind::contacts:
      fill(moment, contacts_);
      return contacts_.SerializeAsString();
    case Kind::phases:
      return phases_of(moment).SerializeAsString();
    case Kind::scene:
      return scene_update(world_, layers_, moment.state.time_ns).SerializeAsString();
    case Kind::transforms:
      fill(moment, frames_);
      return frames_.SerializeAsString();
    case Kind::observation:
      fill(roster_of(channel.place), moment, observation_);
      return observation_.SerializeAsString();
    case Kind::command:
      fill(roster_of(channel.place), population_->layout, moment, command_);
      return command_.SerializeAsString();
    case Kind::calibration:
      return calibration_of(world_, channel.place, moment.state.time_ns).SerializeAsString();
    case Kind::annotations:
      return annotations_of(channel.place, moment).SerializeAsString();
    case Kind::image:
    case Kind::barrier:
    case Kind::log:
    case Kind::metrics:
      break;
  }
  return std::nullopt;
}

Message Channels::log(std::int64_t time_ns, Severity severity, std::string_view name,
                      std::string_view text) {
  using foxglove::Log;
  Log line;
  set_time(time_ns, *line.mutable_timestamp());
  line.set_level(severity == Severity::error     ? Log::ERROR
                 : severity == Severity::warning ? Log::WARNING
                                                 : Log::INFO);
  line.set_name(v1::valid_utf8(name));
  line.set_message(v1::valid_utf8(text));
  return {id_of(Kind::log), time_ns, content_of(line.SerializeAsString()), true};
}

Message Channels::metrics(std::uint64_t tick, std::int64_t time_ns,
                          const std::map<std::string, double>& values) {
  v1::Metrics metrics;
  metrics.set_tick(tick);
  metrics.set_time_ns(time_ns);
  for (const auto& [key, value] : values) (*metrics.mutable_values())[v1::valid_utf8(key)] = value;
  return {id_of(Kind::metrics), time_ns, content_of(metrics.SerializeAsString())};
}

Message Channels::barrier(const wire::Status& status, std::span<const Histogram> histograms) {
  v1::Barrier barrier;
  wire::fill(status, *barrier.mutable_status());
  for (const Histogram& from : histograms) {
    v1::Barrier::LatencyHistogram& to = *barrier.add_histograms();
    to.set_controller(v1::valid_utf8(from.controller));
    to.set_least(from.least);
    to.set_growth(from.growth);
    to.set_missed_ticks(from.missed_ticks);
    std::size_t count = from.counts.size();
    while (count > 0 && from.counts[count - 1] == 0) --count;
    for (const std::uint64_t number : from.counts.first(count)) to.add_counts(number);
  }
  return {id_of(Kind::barrier), status.time_ns, content_of(barrier.SerializeAsString())};
}

}  // namespace ziggurat::channels
