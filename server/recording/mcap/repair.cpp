// SPDX-License-Identifier: MIT
#include "recording/mcap/repair.h"

#include <map>
#include <utility>

#include "recording/mcap/messages.h"

namespace ziggurat::mcap {
namespace {

using Ids = std::map<std::uint16_t, std::uint16_t>;  // in the old file, in the new one

/// Channels with their new ids.
Ids copy_definitions(const Contents& contents, const Kept& kept, Writer& to) {
  Ids schemas, channels;
  for (const auto& [id, schema] : contents.schemas) {
    schemas[id] = to.add_schema(schema.name, schema.encoding, schema.data);
  }
  for (const auto& [id, channel] : contents.channels) {
    if (kept.topics && !kept.topics(channel.topic)) continue;
    const auto schema = schemas.find(channel.schema);
    channels[id] = to.add_channel(schema == schemas.end() ? 0 : schema->second, channel.topic,
                                  channel.encoding, channel.metadata);
  }
  return channels;
}

template <class Copy>
void save(std::vector<Fault>& lost, const Copy& copy) {
  try {
    copy();
  } catch (const Damaged& damaged) {
    if (lost.size() < most_faults) lost.push_back({damaged.offset(), damaged.what()});
  }
}

/// Each chunk becomes one.
void copy_messages(const Reader& reader, const Ids& channels, Writer& to, Repaired& repaired) {
  Messages messages(reader, {});
  std::size_t chunk = 0;
  for (bool is_over = false; !is_over;) {
    save(repaired.lost, [&] {
      for (;;) {
        auto message = messages.next();
        if (!message) break;
        if (messages.chunk() != chunk) to.end_chunk();
        chunk = messages.chunk();
        const auto channel = channels.find(message->channel);
        if (channel == channels.end()) continue;
        message->channel = channel->second;
        to.write(*message);
        ++repaired.messages;
      }
      is_over = true;
    });
  }
}

/// Metadata and attachments.
void copy_others(const Reader& reader, Writer& writer, Repaired& repaired) {
  const Contents& contents = reader.contents();
  for (const MetadataIndex& index : contents.metadata) {
    save(repaired.lost, [&] {
      const Metadata metadata = reader.metadata(index);
      writer.add_metadata(metadata.name, metadata.values);
    });
  }
  for (const AttachmentIndex& index : contents.attachments) {
    save(repaired.lost, [&] {
      writer.attach(index.name, index.media_type, reader.attachment(index), index.log_time,
                    index.create_time);
      ++repaired.attachments;
    });
  }
}

}  // namespace

Repaired repair(const Reader& reader, Sink sink, Compression compression, const Kept& kept) {
  const Contents& contents = reader.contents();
  Writer writer(std::move(sink), contents.header, compression,
                kept.messages_alone ? MessageIndexes::left_out : MessageIndexes::written);
  Repaired repaired;
  if (!kept.messages_alone) copy_others(reader, writer, repaired);
  copy_messages(reader, copy_definitions(contents, kept, writer), writer, repaired);
  writer.close();
  repaired.chunks = writer.chunks();
  return repaired;
}

}  // namespace ziggurat::mcap
