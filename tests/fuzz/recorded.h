// SPDX-License-Identifier: MIT
#pragma once
// A whole recording of a short run, with messages that an input changes.

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "recording/inputs.h"
#include "recording/mcap/encode.h"
#include "recording/mcap/reader.h"
#include "recording/mcap/writer.h"
#include "small_world.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::fuzz {

/// The messages of a short run.
struct Recorded {
  v1::RunStart start;
  std::vector<v1::Inputs> inputs;
  std::vector<v1::ExactState> states;
};

/// A whole file with these messages, of which an input changes some. Nothing else in it moves, so
/// that it can stay open meanwhile: behind the messages stands one of a topic of its own, as long
/// as they leave it.
class RecordedFile {
 public:
  explicit RecordedFile(const Recorded& recorded) {
    mcap::Writer writer([&](std::string_view some) { bytes_ += some; }, {"ziggurat", "fuzzer"},
                        mcap::Compression::none);
    writer.attach("small.argos", "", small_world, 0, 0);
    const auto channel = [&](const char* type, const char* topic) {
      return writer.add_channel(writer.add_schema(type, "protobuf", ""), topic, "protobuf");
    };
    const auto run = channel("ziggurat.v1.RunStart", "/run"),
               inputs = channel("ziggurat.v1.Inputs", "/inputs"),
               state = channel("ziggurat.v1.ExactState", "/state"),
               world = channel("ziggurat.v1.World", "/world");
    messages_.push_back({run, recorded.start.SerializeAsString()});
    messages_.push_back({world, described().SerializeAsString()});
    for (std::size_t i = 0; i < recorded.inputs.size(); ++i) {
      messages_.push_back({state, recorded.states[i].SerializeAsString()});
      messages_.push_back({inputs, recorded.inputs[i].SerializeAsString()});
    }
    for (std::size_t i = 0; i < messages_.size(); ++i)
      writer.write(messages_[i].channel, i, i, messages_[i].text);
    rest_ = channel("", "/rest");
    writer.write(rest_, 0, 0, std::string(messages_.size() * longest_part * longest_edit, ' '));
    writer.close();
    const mcap::ChunkIndex chunk =
        mcap::Reader(mcap::bytes_of(bytes_), {}).contents().chunks.front();
    constexpr std::size_t crc = mcap::record_head + 3 * 8, records = crc + 3 * 4 + 4;
    std::fill_n(bytes_.begin() + static_cast<std::ptrdiff_t>(chunk.offset + crc), 4, '\0');
    records_ = chunk.offset + records;
    end_ = records_ + chunk.uncompressed_size;
  }

  /// Which messages are changed, and how, is the input's to say.
  void edit(std::span<const std::uint8_t> data) {
    const std::size_t part = std::min(data.size() / 4, longest_part * 6),
                      chosen = data.empty() ? 0 : data[0];
    std::string records;
    for (std::size_t at = 0; at < messages_.size(); ++at) {
      std::string text = messages_[at].text;
      if ((chosen >> at % 8 & 1) != 0)
        text = edited(std::move(text), data.subspan(at % 4 * part, part));
      append(mcap::Message{messages_[at].channel, 0, at, at, text}, records);
    }
    const std::size_t left = end_ - records_ - records.size();
    append(mcap::Message{rest_, 0, 0, 0, {}}, records);
    const std::uint64_t length = left - mcap::record_head;
    const std::size_t head = records.size() - message_head;
    std::memcpy(records.data() + head + 1, &length,
                sizeof length);  // which includes all that is left
    std::ranges::copy(records, bytes_.begin() + static_cast<std::ptrdiff_t>(records_));
  }

  /// It stays where it is.
  const std::string& bytes() const { return bytes_; }

 private:
  static constexpr std::size_t longest_part = 16, longest_edit = 31;  // edits; bytes that one adds
  static constexpr std::size_t message_head = mcap::record_head + 2 + 4 + 8 + 8;
  struct Message {
    std::uint16_t channel;
    std::string text;
  };

  static v1::World described() {
    v1::World world;
    world.set_ticks_per_second(10);
    world.add_entities()->set_link_count(1);
    world.add_links()->set_id("base");
    return world;
  }

  std::vector<Message> messages_;
  std::string bytes_;
  std::size_t records_ = 0, end_ = 0;  // of the chunk, in bytes_
  std::uint16_t rest_ = 0;
};

/// Does it, which may end with a sentence.
template <class Do>
void attempt(const Do& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    require(*error.what() != '\0');
  }
}

}  // namespace ziggurat::fuzz
