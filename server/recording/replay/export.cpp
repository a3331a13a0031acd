// SPDX-License-Identifier: MIT
#include "recording/replay/export.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "outputs/json.h"
#include "outputs/output_file.h"
#include "outputs/trace.h"
#include "recording/inputs.h"
#include "recording/replay/names.h"
#include "recording/replay/recording_file.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::replay {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::MessageFactory;

math::Pose pose_of(const google::protobuf::RepeatedField<double>& position,
                   const google::protobuf::RepeatedField<double>& orientation) {
  math::Pose pose;
  if (position.size() == 3) pose.position = {position[0], position[1], position[2]};
  if (orientation.size() == 4) {
    pose.orientation =
        math::Quaternion(orientation[0], orientation[1], orientation[2], orientation[3]);
  }
  return pose;
}

/// Who is in the world, as far as a trace names them, from the topic /world.
struct Inhabitants {
  struct Origin {
    std::size_t link = 0;  ///< the reference link
    math::Pose pose;       ///< X_LE
  };
  world::Layout layout;
  std::vector<Origin> origins;  // per entity
  std::vector<bool> absent;

  /// @throws RecordingError if links are not where they must be
  void take(const v1::World& world, const std::string& path) {
    using Kind = v1::World::Entity;
    if (const auto fault = fault_of_names(world)) throw RecordingError(path + ": " + *fault);
    layout.entities.clear();
    layout.links.clear();
    origins.clear();
    absent.clear();
    const auto links = static_cast<std::size_t>(world.links_size());
    for (const auto& entity : world.entities()) {
      const world::Range range{entity.first_link(), entity.link_count()};
      const auto is_its_own = [&](const v1::World::Link& link) {
        return link.entity() == layout.entities.size();
      };
      if (range.end() > links || entity.reference_link() >= links ||
          !std::all_of(world.links().begin() + entity.first_link(),
                       world.links().begin() + entity.first_link() + entity.link_count(),
                       is_its_own)) {
        throw RecordingError(
            path +
            ": a message of /world is damaged: an entity refers to links that are not its own");
      }
      const bool lists_links = entity.kind() != Kind::BOX && entity.kind() != Kind::CYLINDER &&
                               entity.kind() != Kind::SPHERE;
      layout.entities.push_back({entity.id(), range, lists_links});
      origins.push_back({entity.reference_link(),
                         pose_of(entity.origin_position(), entity.origin_orientation())});
      absent.push_back(entity.removed());
    }
    for (const auto& link : world.links()) layout.links.push_back({link.id(), link.entity()});
  }

  /// False: the links are of another world.
  bool fill(const std::vector<world::LinkState>& links, world::State& state) const {
    if (links.size() != layout.links.size()) return false;
    state.links = links;
    state.absent = absent;
    state.origins.clear();
    for (const Origin& origin : origins) {
      state.origins.push_back(links[origin.link].pose * origin.pose);
    }
    return true;
  }
};

/// As the simulation computes it [ns].
std::int64_t time_of(std::uint64_t tick, std::uint32_t ticks_per_second) {
  const std::uint32_t rate = std::max(ticks_per_second, 1u);
  return std::llround(static_cast<long double>(tick) * 1e9L / rate);
}

struct Topic {
  std::string name;
  const google::protobuf::Descriptor* type = nullptr;  ///< null: this version does not know it
};

/// Whether a type is one that runs record. protobuf knows types of its own, for which there are no
/// bounds.
bool is_recorded(const google::protobuf::Descriptor& type) {
  const std::string& package = type.file()->package();
  return package == "ziggurat.v1" || package == "foxglove";
}

std::map<std::uint16_t, Topic> chosen_topics(
    const RecordingFile& file, const std::function<bool(const std::string&)>& is_wanted) {
  const mcap::Contents& contents = file.reader().contents();
  std::map<std::uint16_t, Topic> chosen;
  for (const auto& [id, channel] : contents.channels) {
    const auto schema = contents.schemas.find(channel.schema);
    if (!is_wanted(channel.topic) || schema == contents.schemas.end()) continue;
    const auto* type = DescriptorPool::generated_pool()->FindMessageTypeByName(schema->second.name);
    if (type && is_recorded(*type)) chosen.emplace(id, Topic{channel.topic, type});
  }
  if (!chosen.empty()) return chosen;
  throw RecordingError(
      fmt::format("{} has no topic that is asked for; 'ziggurat info {}' lists them", file.path(),
                  file.path()));
}

}  // namespace

std::uint64_t export_csv(const RecordingFile& file, const std::string& out) {
  const mcap::Contents& contents = file.reader().contents();
  const auto* of_world = contents.channel_of("/world");
  const auto* of_state = contents.channel_of("/state");
  auto messages = file.messages({"/world", "/state"});
  if (!of_world || !of_state) {
    throw RecordingError(file.path() +
                         ": the topics /world and /state are needed for a table; "
                         "write 'ziggurat replay --trace FILE.csv' to compute it anew");
  }
  Inhabitants inhabitants;
  outputs::Trace trace(out, inhabitants.layout);
  v1::ExactState exact;
  std::vector<world::LinkState> links;
  world::State state;
  std::uint32_t ticks_per_second = 0;
  std::uint64_t written = 0;
  while (const auto message = next(file, *messages)) {
    if (message->channel == of_world->id) {
      v1::World world;
      file.decode(*messages, *message, world);
      inhabitants.take(world, file.path());
      ticks_per_second = world.ticks_per_second();
      trace.name_anew();
      continue;
    }
    file.decode(*messages, *message, exact);
    if (const auto fault = recording::unpack(exact, links))
      throw RecordingError(file.path() + ": " + *fault);
    state.tick = exact.tick();
    state.time_ns = time_of(exact.tick(), ticks_per_second);
    if (!inhabitants.fill(links, state)) continue;
    trace.write(state);
    ++written;
  }
  trace.close();
  if (written == 0)
    throw RecordingError(file.path() + ": no state of it is intact, so a table would be empty");
  return written;
}

std::uint64_t export_jsonl(const RecordingFile& file,
                           const std::function<bool(const std::string&)>& is_wanted,
                           const std::string& out) {
  const auto topics = chosen_topics(file, is_wanted);
  mcap::Selection selection;
  for (const auto& [id, topic] : topics) selection.channels.push_back(id);
  mcap::Messages messages(file.reader(), selection);
  outputs::OutputFile output(out);
  std::uint64_t written = 0;
  while (const auto message = next(file, messages)) {
    const Topic& topic = topics.at(message->channel);
    const std::unique_ptr<google::protobuf::Message> content(
        MessageFactory::generated_factory()->GetPrototype(topic.type)->New());
    file.decode(messages, *message, *content);
    output.buffer().append(fmt::format(
        "{{\"topic\":{},\"time_s\":{},\"message\":",
        nlohmann::json(topic.name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
        static_cast<double>(message->log_time) / 1e9));
    outputs::write_json(*content, output);
    output.buffer().append(std::string_view("}\n"));
    output.written();
    ++written;
  }
  output.close();
  return written;
}

}  // namespace ziggurat::replay
