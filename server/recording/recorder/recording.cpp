// SPDX-License-Identifier: MIT
#include "recording/recorder/recording.h"

#include <algorithm>
#include <utility>

#include "world/state.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::recorder {
namespace {

using channels::Kind;
using channels::Pace;

constexpr std::size_t full_chunk = most_unwritten / 4 * 3;
constexpr std::chrono::milliseconds longest_chunk = longest_unwritten / 4 * 3;

mcap::Header header_of(const Start& start) {
  return {"ziggurat", "ziggurat " + start.build.version};
}

}  // namespace

bool is_recorded(Kind kind) {
  return kind != Kind::barrier && kind != Kind::phases &&
         kind != Kind::metrics;  // /inputs has them
}

Recording::Recording(mcap::Sink sink, mcap::Compression compression, Contents contents,
                     const Start& start)
    : writer_(std::move(sink), header_of(start), compression), contents_(std::move(contents)) {
  writer_.add_metadata("ziggurat", {{"version", start.build.version},
                                    {"scene", start.scene},
                                    {"seed", std::to_string(start.seed)},
                                    {"date", start.date}});
  for (const EmbeddedFile& file : start.files) attach(file);
  run_ = add_channel(*v1::RunStart::descriptor(), "/run");
  inputs_channel_ = add_channel(*v1::Inputs::descriptor(), "/inputs");
  if (!contents_.wants || contents_.wants("/state")) {
    state_channel_ = add_channel(*v1::ExactState::descriptor(), "/state");
  }
  write(run_, to_message(start).SerializeAsString());
  end_chunk();
}

std::uint16_t Recording::add_channel(const google::protobuf::Descriptor& type,
                                     const std::string& topic) {
  return add_channel(channels::schema_of(type), topic);
}

std::uint16_t Recording::add_channel(const channels::Schema& schema, const std::string& topic) {
  const auto [known, is_new] = topics_.emplace(topic, std::uint16_t{0});
  if (!is_new) return known->second;
  const auto [id, is_first] = schemas_.emplace(schema.name, std::uint16_t{0});
  if (is_first) id->second = writer_.add_schema(schema.name, "protobuf", schema.descriptors);
  known->second = writer_.add_channel(id->second, topic, "protobuf");
  return known->second;
}

void Recording::write(std::uint16_t channel, std::string_view bytes) {
  if (writer_.chunk_size() == 0) chunk_begin_ = now_;
  const auto time = static_cast<std::uint64_t>(log_time_ns_);
  writer_.write(channel, time, time, bytes);
}

void Recording::attach(const EmbeddedFile& file) {
  const auto time = static_cast<std::uint64_t>(log_time_ns_);
  writer_.attach(file.name, "application/octet-stream", file.text, time, time);
}

void Recording::populate(std::shared_ptr<const channels::PopulationCopy> population) {
  channels_.populate(population->view());
  population_ = std::move(population);  // what channels_ referred to before may go now
  is_population_new_ = true;
  wanted_.clear();
  without_pictures_.clear();
  for (const channels::Channel& channel : channels_.list()) {
    if (!is_recorded(channel.kind)) continue;
    if (contents_.wants && !contents_.wants(channel.topic)) continue;
    wanted_.push_back(channel.id);
    if (channel.kind != Kind::image) without_pictures_.push_back(channel.id);
    channels_of_[channel.id] = add_channel(*channel.schema, channel.topic);
  }
}

bool Recording::takes_pictures() const {
  return tick_.state.tick % contents_.picture_interval == 0;
}

void Recording::write_messages(Pace pace) {
  std::vector<channels::Message> messages;
  channels_.encode(tick_.view(), pace, takes_pictures() ? wanted_ : without_pictures_, messages);
  for (const channels::Message& message : messages) {
    write(channels_of_.at(message.channel), message.content->bytes());
  }
}

void Recording::tick(channels::TickCopy& copy) {
  if (has_inputs_) write_inputs();
  std::swap(tick_, copy);
  const std::int64_t time_ns = tick_.state.time_ns;
  if (std::exchange(begins_epoch_, false)) {
    const std::int64_t tick_ns = 1'000'000'000 / population_->scene.experiment.ticks_per_second;
    offset_ns_ = epoch_ == 0 ? 0 : log_time_ns_ + tick_ns - time_ns;
    commands_ = {};
    links_ = {};
  }
  log_time_ns_ = time_ns + offset_ns_;
  if (std::exchange(is_population_new_, false)) write_messages(Pace::latched);
  write_messages(Pace::tick);
  if (state_channel_ != 0) {
    exact_.Clear();
    links_.pack(epoch_, tick_.state, exact_);
    write(state_channel_, exact_.SerializeAsString());
  }
  inputs_.Clear();
  inputs_.set_epoch(epoch_);
  inputs_.set_tick(tick_.state.tick);
  inputs_.set_hash(world::hash(tick_.state, tick_.observations));
  inputs_.mutable_acts_before()->Swap(early_.mutable_acts_before());
  has_inputs_ = true;
}

void Recording::add(v1::Act act) {
  *(has_inputs_ ? inputs_.add_acts() : early_.add_acts_before()) = std::move(act);
}

void Recording::log(channels::Severity severity, const std::string& name, const std::string& text) {
  const std::uint32_t id = channels::Channels::id_of(Kind::log);
  if (!std::ranges::binary_search(wanted_, id)) return;
  write(channels_of_.at(id),
        channels_.log(tick_.state.time_ns, severity, name, text).content->bytes());
}

void Recording::measured(const std::vector<world::Metric>& metrics) {
  for (const world::Metric& metric : metrics) {
    v1::Inputs::Metric& to = *inputs_.add_metrics();
    to.set_robot(v1::valid_utf8(metric.robot));
    to.set_name(metric.name);
    to.set_value(metric.value);
  }
}

void Recording::step(const world::Commands& commands) {
  tick_.commands = commands;
  write_messages(Pace::answer);
  commands_.pack(commands, *inputs_.mutable_commands());
  write_inputs();
}

void Recording::write_inputs() {
  write(inputs_channel_, inputs_.SerializeAsString());
  has_inputs_ = false;
  end_due_chunk();
}

void Recording::end_epoch() {
  if (has_inputs_) write_inputs();
  ++epoch_;
  begins_epoch_ = true;
}

void Recording::end_chunk() {
  writer_.end_chunk();
  links_ = {};
}

void Recording::end_due_chunk() {
  const bool is_old = writer_.chunk_size() > 0 && clock::now() - chunk_begin_ >= longest_chunk;
  if (is_old || writer_.chunk_size() >= full_chunk) end_chunk();
}

void Recording::close() {
  if (has_inputs_) write_inputs();
  writer_.close();
}

}  // namespace ziggurat::recorder
