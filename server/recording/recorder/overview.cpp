// SPDX-License-Identifier: MIT
#include "recording/recorder/overview.h"

#include <algorithm>
#include <map>

#include "recording/decoding.h"
#include "recording/mcap/messages.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recorder {
namespace {

Start to_start(const v1::RunStart& from) {
  Start to;
  to.scene = from.scene();
  to.scene_hash = from.scene_hash();
  to.seed = from.seed();
  to.lenient = from.lenient();
  for (const auto& each : from.settings()) to.settings.emplace_back(each.name(), each.value());
  for (const auto& each : from.parameters()) to.parameters.emplace_back(each.name(), each.value());
  to.clock = from.clock();
  to.last_tick = from.last_tick();
  for (const auto& each : from.controllers()) {
    to.controllers.push_back({each.id(), each.command(), each.script()});
  }
  to.robots_without_controller.assign(from.robots_without_controller().begin(),
                                      from.robots_without_controller().end());
  to.date = from.date();
  to.build = {from.build().version(), from.build().compiler(), from.build().options(),
              from.build().libm(), from.build().cpu_path()};
  to.arguments.assign(from.arguments().begin(), from.arguments().end());
  return to;
}

void add_inputs(const mcap::Message& message, Overview& to) {
  v1::Inputs inputs;
  if (recording::decode(message.data, inputs)) return;
  ++to.states;
  to.epochs = std::max(to.epochs, inputs.epoch() + 1);
  to.last_tick = inputs.tick();
}

}  // namespace

std::optional<Start> read_start(const mcap::Reader& reader) {
  const mcap::Channel* channel = reader.contents().channel_of("/run");
  if (!channel) return std::nullopt;
  mcap::Messages messages(reader, {{channel->id}});
  const auto message = messages.next();
  v1::RunStart start;
  if (!message || recording::decode(message->data, start)) return std::nullopt;
  return to_start(start);
}

Overview overview(const mcap::Reader& reader) {
  const mcap::Contents& contents = reader.contents();
  Overview overview;
  try {
    overview.start = read_start(reader);
  } catch (const mcap::Damaged&) {
  }
  std::map<std::uint16_t, Overview::Topic> topics;
  for (const auto& [id, channel] : contents.channels) {
    const auto schema = contents.schemas.find(channel.schema);
    topics[id] = {channel.topic, schema == contents.schemas.end() ? "" : schema->second.name, 0, 0};
  }
  const mcap::Channel* inputs = contents.channel_of("/inputs");
  std::uint64_t first = ~std::uint64_t{0}, last = 0;
  mcap::Messages messages(reader, {});
  for (bool is_over = false; !is_over;) {
    try {
      while (const auto message = messages.next()) {
        first = std::min(first, message->log_time);
        last = std::max(last, message->log_time);
        Overview::Topic& topic = topics[message->channel];
        ++topic.messages;
        topic.bytes += message->data.size();
        if (inputs && inputs->id == message->channel) add_inputs(*message, overview);
      }
      is_over = true;
    } catch (const mcap::Damaged&) {  // of one chunk
    }
  }
  if (last > first) overview.length = static_cast<double>(last - first) * 1e-9;
  for (const auto& chunk : contents.chunks) overview.uncompressed += chunk.uncompressed_size;
  for (auto& [id, topic] : topics) overview.topics.push_back(std::move(topic));
  std::ranges::sort(overview.topics, {}, &Overview::Topic::name);
  return overview;
}

}  // namespace ziggurat::recorder
