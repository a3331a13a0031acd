// SPDX-License-Identifier: MIT
#include "rerun/replay_difference.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "channels/channels.h"
#include "math/hash.h"
#include "recording/replay/difference.h"
#include "recording/replay/message_difference.h"
#include "run/build.h"

namespace ziggurat::rerun {
namespace {

/// Compares the topics that show readings and device states of robots; poses of links do not.
bool is_compared(channels::Kind kind) {
  return kind == channels::Kind::observation || kind == channels::Kind::poses ||
         kind == channels::Kind::detections || kind == channels::Kind::radio;
}

std::vector<std::pair<std::string, channels::Message>> messages_of(supervision::World& world,
                                                                   channels::Channels& channels) {
  const simulation::Simulation& simulation = world.simulation;
  channels.populate({world.scene, world.path, world.scene_hash, world.seed, 0, simulation.layout(),
                     simulation.entities(), simulation.state()});
  std::vector<std::pair<std::string, channels::Message>> found;
  for (const channels::Channel& channel : channels.list()) {
    if (!is_compared(channel.kind)) continue;
    std::vector<channels::Message> messages;
    channels.encode({simulation.state(),
                     simulation.observations(),
                     world.simulation.commands(),
                     simulation.contacts(),
                     {}},
                    channels::Pace::tick, std::array{channel.id}, messages);
    for (auto& message : messages) found.emplace_back(channel.topic, std::move(message));
  }
  return found;
}

std::string entity_of(std::string_view topic) {
  constexpr std::string_view robots = "/robots/";
  if (!topic.starts_with(robots)) return std::string(topic);
  topic.remove_prefix(robots.size());
  return fmt::format("'{}' ({})", topic.substr(0, topic.rfind('/')),
                     topic.substr(topic.rfind('/') + 1));
}

/// The first field of a topic's message that differs from the recorded one, as a sentence.
std::optional<std::string> difference_of(const replay::RecordingFile& file, std::uint64_t log_time,
                                         const std::string& topic, const std::string& bytes) {
  const mcap::Contents& contents = file.reader().contents();
  const mcap::Channel* channel = contents.channel_of(topic);
  if (!channel || !contents.schemas.contains(channel->schema)) return std::nullopt;
  mcap::Messages messages(file.reader(), {{channel->id}, log_time, log_time});
  const auto recorded = replay::next(file, messages);
  if (!recorded || recorded->data == bytes) return std::nullopt;
  const std::string& type = contents.schemas.at(channel->schema).name;
  const auto found = replay::first_difference(type, recorded->data, bytes);
  if (!found) return std::nullopt;
  return fmt::format("{}: {} is {} in the recording, {} now", entity_of(topic), found->field,
                     found->a, found->b);
}

std::string first_field(const replay::RecordingFile& file, const replay::States& states,
                        supervision::World& world) {
  const world::Layout& layout = world.simulation.layout();
  const auto& links = world.simulation.state().links;
  if (states.links()) {
    if (const auto found = replay::first_difference(*states.links(), links)) {
      const world::LinkLayout& link = layout.links[found->link];
      return fmt::format("'{}'{}: {} is {} in the recording, {} now",
                         layout.entities[link.entity].id,
                         link.id.empty() ? "" : fmt::format(", link '{}'", link.id), found->field,
                         found->a, found->b);
    }
    if (states.links()->size() != links.size()) {
      return fmt::format("the world has {} links in the recording, {} now", states.links()->size(),
                         links.size());
    }
  }
  channels::Channels channels;
  for (const auto& [topic, message] : messages_of(world, channels)) {
    const auto found = difference_of(file, states.log_time(), topic, message.content->bytes());
    if (found) return *found;
  }
  return states.links() ? "poses and velocities are the same; what differs is not recorded"
                        : "exact poses are not recorded, so that it can't be told what differs";
}

}  // namespace

std::string explain_difference(const replay::RecordingFile& file, const replay::States& states,
                               const replay::Replay& replay, supervision::World& world) {
  const v1::Inputs& inputs = replay.inputs();
  return fmt::format("tick {}{}: {} (hash {} in the recording, {} now)", inputs.tick(),
                     inputs.epoch() > 0 ? fmt::format(" of epoch {}", inputs.epoch()) : "",
                     first_field(file, states, world), math::to_hex(inputs.hash()),
                     math::to_hex(replay.hash()));
}

std::vector<std::string> likely_causes(const v1::RunStart& recorded) {
  const v1::RunStart::Build& then = recorded.build();
  const recorder::Build now = run::this_build();
  std::vector<std::string> causes;
  const auto compare = [&](std::string_view what, const std::string& a, const std::string& b) {
    if (a != b) causes.push_back(fmt::format("{}: {} then, {} now", what, a, b));
  };
  compare("version", then.version(), now.version);
  compare("compiler", then.compiler(), now.compiler);
  compare("options of the compiler", then.options(), now.options);
  compare("C library", then.libm(), now.libm);
  compare("instructions of the processor", then.cpu_path(), now.cpu_path);
  if (causes.empty())
    causes.emplace_back(
        "the same build recorded it: its file was changed, or this is a fault of the program");
  return causes;
}

}  // namespace ziggurat::rerun
