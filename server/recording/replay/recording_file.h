// SPDX-License-Identifier: MIT
#pragma once
// A recording on disk.

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "recording/mcap/messages.h"
#include "recording/mcap/reader.h"
#include "recording/replay/embedded_files.h"
#include "world/state.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay {

/// A recording that cannot be read or repeated: a sentence that says what is wrong, and where.
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class RecordingFile {
 public:
  /// @throws RecordingError if it is no recording; what follows a damaged place can still be
  /// missing
  explicit RecordingFile(const std::string& path);
  /// The same of bytes from elsewhere. @param path  for messages
  RecordingFile(std::string path, mcap::Source source);

  const std::string& path() const { return path_; }
  const v1::RunStart& run() const { return run_; }
  const EmbeddedFiles& files() const { return files_; }
  const mcap::Reader& reader() const { return *reader_; }
  /// The bytes of an embedded snapshot; nothing: it has none of this name. @throws RecordingError
  std::optional<std::string> snapshot(const std::string& name) const;
  /// A sentence on what is missing or damaged at the end; empty: it was closed in good order.
  std::string shortcoming() const;
  /// Number of recorded states.
  std::uint64_t states() const;

  /// The messages of these topics, in the order of the file; topics that it lacks are skipped.
  /// Nothing: it has none of them.
  std::optional<mcap::Messages> messages(const std::vector<std::string>& topics) const;
  /// Decodes one of them. @param from  the messages that it is the last one of
  /// @throws RecordingError that names topic, time and place if it is damaged or beyond the bounds
  /// of recording/decoding.h
  void decode(const mcap::Messages& from, const mcap::Message& message,
              google::protobuf::Message& to) const;

 private:
  void read_files();

  std::string path_;
  std::unique_ptr<mcap::Reader> reader_;
  v1::RunStart run_;
  EmbeddedFiles files_;
};

/// The next message, if there is one. @throws RecordingError that names the damaged place
std::optional<mcap::Message> next(const RecordingFile& file, mcap::Messages& messages);

/// The inputs of a recording one after the other, with the exact states that were recorded.
class States {
 public:
  /// @param file  must outlive this
  explicit States(const RecordingFile& file);

  /// The next inputs; they stay until the next call. Null after the last; then all stays.
  /// @throws RecordingError
  const v1::Inputs* next();
  /// All links of the world at these inputs; null: not recorded.
  const std::vector<world::LinkState>* links() const { return has_links_ ? &links_ : nullptr; }
  /// Log time of these inputs [ns].
  std::uint64_t log_time() const { return log_time_; }

 private:
  const RecordingFile& file_;
  std::optional<mcap::Messages> messages_;
  std::uint16_t inputs_channel_ = 0;
  v1::Inputs inputs_, coming_;
  v1::ExactState state_;
  std::vector<world::LinkState> links_;
  std::uint64_t log_time_ = 0;
  bool has_links_ = false;
};

}  // namespace ziggurat::replay
