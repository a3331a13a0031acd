// SPDX-License-Identifier: MIT
#pragma once
// A small file with one of everything.

#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "recording/mcap/messages.h"
#include "recording/mcap/reader.h"
#include "recording/mcap/writer.h"

namespace ziggurat::mcap {

inline Sink into(std::string& file) {
  return [&file](std::string_view bytes) { file += bytes; };
}

/// Chunk i of `chunks` has two messages of `/a` and one of `/b`, at i * 10, + 1 and + 2.
inline std::string example(Compression compression, int chunks = 3) {
  std::string file;
  Writer writer(into(file), {"test", "tests of ziggurat"}, compression);
  const auto schema = writer.add_schema("Type", "protobuf", "descriptors");
  const auto a = writer.add_channel(schema, "/a", "protobuf");
  const auto b = writer.add_channel(0, "/b", "json", {{"key", "value"}});
  writer.attach("scene.argos", "application/xml", "<argos/>", 1, 2);
  writer.add_metadata("run", {{"seed", "7"}, {"", ""}});
  for (int i = 0; i < chunks; ++i) {
    const auto time = static_cast<std::uint64_t>(10 * i);
    writer.write(a, time, time, "first of " + std::to_string(i));
    writer.write(b, time + 1, time + 1, "{}");
    writer.write(a, time + 2, time, std::string(200, 'x'));
    writer.end_chunk();
  }
  writer.close();
  return file;
}

struct Read {
  std::string topic;
  std::uint32_t sequence;
  std::uint64_t time;
  std::string data;
  bool operator==(const Read&) const = default;
};

inline std::vector<Read> read_all(const Reader& reader, const Selection& selection = {}) {
  std::vector<Read> all;
  Messages messages(reader, selection);
  while (const auto message = messages.next()) {
    all.push_back({reader.contents().channels.at(message->channel).topic, message->sequence,
                   message->log_time, std::string(message->data)});
  }
  return all;
}

}  // namespace ziggurat::mcap
