// SPDX-License-Identifier: MIT
#include "recording/replay/recording_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "recording/decoding.h"
#include "recording/inputs.h"

namespace ziggurat::replay {
namespace {

const std::string snapshot_folder = "snapshot/";                 // of the names of attachments
constexpr std::uint64_t most_embedded = std::uint64_t{1} << 30;  // all files [bytes]

RecordingError damaged(const std::string& path, const mcap::Damaged& damage) {
  if (damage.offset() == 0 && path.ends_with(".argos")) {
    return RecordingError(fmt::format(
        "{}: this is a scene, not a recording; write the file of 'ziggurat run {} --record FILE'",
        path, path));
  }
  if (damage.offset() == 0) {
    return RecordingError(
        fmt::format("{}: {}; write the file of 'ziggurat run SCENE --record FILE' (if this was "
                    "one, 'ziggurat info {} --repair OUT' "
                    "saves what is whole)",
                    path, damage.what(), path));
  }
  return RecordingError(
      fmt::format("{}: damaged at byte {}: {}; 'ziggurat info {} --repair OUT' saves what is whole",
                  path, damage.offset(), damage.what(), path));
}

}  // namespace

RecordingFile::RecordingFile(const std::string& path)
    : RecordingFile(path, mcap::open_file(path)) {}

RecordingFile::RecordingFile(std::string path, mcap::Source source) : path_(std::move(path)) {
  try {
    reader_ = std::make_unique<mcap::Reader>(std::move(source));
    auto start = messages({"/run"});
    const auto message = start ? start->next() : std::nullopt;
    if (!message) {
      const std::string lacks = shortcoming();
      throw RecordingError(
          lacks.empty()
              ? fmt::format("{}: an MCAP file without the topic /run; only what 'ziggurat run "
                            "--record' writes can "
                            "be repeated",
                            path_)
              : fmt::format("{}: {}; it has no message of /run, with which a recording begins",
                            path_, lacks));
    }
    decode(*start, *message, run_);
    read_files();
  } catch (const mcap::Damaged& damage) {
    throw damaged(path_, damage);
  }
}

void RecordingFile::read_files() {
  std::uint64_t all = 0;
  for (const mcap::AttachmentIndex& index : reader_->contents().attachments) {
    if (index.name.starts_with(snapshot_folder)) continue;
    all += index.length;  // the index's data_size may say anything
    if (all > most_embedded) {
      throw RecordingError(
          fmt::format("{}: its embedded files have more than {} bytes", path_, most_embedded));
    }
    files_.add(index.name, reader_->attachment(index));
  }
}

std::optional<std::string> RecordingFile::snapshot(const std::string& name) const {
  const auto& all = reader_->contents().attachments;
  const auto found = std::ranges::find(all, snapshot_folder + name, &mcap::AttachmentIndex::name);
  if (found == all.end()) return std::nullopt;
  if (found->length > most_embedded) {
    throw RecordingError(
        fmt::format("{}: the snapshot '{}' has more than {} bytes", path_, name, most_embedded));
  }
  try {
    return reader_->attachment(*found);
  } catch (const mcap::Damaged& damage) {
    throw damaged(path_, damage);
  }
}

std::string RecordingFile::shortcoming() const {
  if (reader_->has_summary()) return {};
  const auto& faults = reader_->faults();
  return fmt::format(
      "the recording was not closed: its end is missing{}",
      faults.empty() ? ""
                     : fmt::format(" (byte {}: {})", faults.front().offset, faults.front().text));
}

std::uint64_t RecordingFile::states() const {
  const mcap::Channel* channel = reader_->contents().channel_of("/inputs");
  return channel ? reader_->contents().messages_of(channel->id) : 0;
}

std::optional<mcap::Messages> RecordingFile::messages(
    const std::vector<std::string>& topics) const {
  mcap::Selection selection;
  for (const std::string& topic : topics) {
    if (const auto* channel = reader_->contents().channel_of(topic)) {
      selection.channels.push_back(channel->id);
    }
  }
  if (selection.channels.empty()) return std::nullopt;  // an empty selection would be all
  return std::optional<mcap::Messages>(std::in_place, *reader_, std::move(selection));
}

void RecordingFile::decode(const mcap::Messages& from, const mcap::Message& message,
                           google::protobuf::Message& to) const {
  const auto fault = recording::decode(message.data, to);
  if (!fault) return;
  const mcap::Contents& contents = reader_->contents();
  const auto channel = contents.channels.find(message.channel);
  throw RecordingError(fmt::format(
      "{}: a message of {} at {} s, in the chunk at byte {}, {}; take another copy of the "
      "recording, or record the run again",
      path_, channel == contents.channels.end() ? "no topic" : channel->second.topic,
      static_cast<double>(message.log_time) / 1e9, contents.chunks[from.chunk()].offset, *fault));
}

std::optional<mcap::Message> next(const RecordingFile& file, mcap::Messages& messages) {
  try {
    return messages.next();
  } catch (const mcap::Damaged& damage) {
    throw damaged(file.path(), damage);
  }
}

States::States(const RecordingFile& file)
    : file_(file), messages_(file.messages({"/inputs", "/state"})) {
  const mcap::Channel* inputs = file.reader().contents().channel_of("/inputs");
  if (!inputs) throw RecordingError(file.path() + ": it has no topic /inputs");
  inputs_channel_ = inputs->id;
}

const v1::Inputs* States::next() {
  while (const auto message = replay::next(file_, *messages_)) {
    if (message->channel == inputs_channel_) {
      file_.decode(*messages_, *message, coming_);
      std::swap(inputs_, coming_);
      log_time_ = message->log_time;
      has_links_ =
          state_.epoch() == inputs_.epoch() && state_.tick() == inputs_.tick() && !links_.empty();
      return &inputs_;
    }
    file_.decode(*messages_, *message, state_);
    if (const auto fault = recording::unpack(state_, links_)) {
      throw RecordingError(fmt::format("{}: {}", file_.path(), *fault));
    }
  }
  return nullptr;
}

}  // namespace ziggurat::replay
