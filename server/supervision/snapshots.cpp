// SPDX-License-Identifier: MIT
#include "supervision/snapshots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "wire/messages.h"

namespace ziggurat::supervision {

using simulation::Snapshot;
using wire::ErrorCode;
using wire::make_fault;

namespace {

constexpr std::size_t most = 1024;                            // snapshots in memory
constexpr std::size_t most_bytes = std::size_t{1} << 30;      // of all of them
constexpr std::size_t longest_file = std::size_t{512} << 20;  // what a recording can embed [bytes]

std::optional<wire::Fault> fault_of_name(const std::string& name, const char* field) {
  const auto why = simulation::fault_of_snapshot_name(name);
  if (!why) return std::nullopt;
  return make_fault(ErrorCode::bad_value, field, *why + ".");
}

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (std::filesystem::file_size(path) > longest_file) {
    throw simulation::SnapshotError(
        fmt::format("The file has more than {} MiB.", longest_file >> 20));
  }
  std::vector<std::byte> bytes(std::filesystem::file_size(path));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw simulation::SnapshotError("The file can't be read.");
  return bytes;
}

/// Writes a new file. What stood there, which may be a link of somebody who can write to the
/// folder, is not followed.
bool write_new(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  ::unlink(path.c_str());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return false;
  ssize_t written = 0;
  for (; !bytes.empty() && written >= 0; bytes = bytes.subspan(static_cast<std::size_t>(written))) {
    do {
      written = ::write(file, bytes.data(), bytes.size());
    } while (written < 0 && errno == EINTR);
    if (written < 0) break;
  }
  return ::close(file) == 0 && bytes.empty();
}

}  // namespace

Snapshots::Snapshots(std::filesystem::path folder, std::string build)
    : folder_(std::move(folder)), build_(std::move(build)) {
  if (folder_.empty() || std::filesystem::is_directory(folder_)) return;
  throw std::runtime_error(
      fmt::format("--snapshot-folder: '{}' is no folder; make it first", folder_.string()));
}

std::filesystem::path Snapshots::path_of(const std::string& name) const {
  return folder_ / (name + ".snapshot");
}

std::optional<wire::Fault> Snapshots::fault_of_size(const std::string& name,
                                                    std::size_t size) const {
  const auto old = kept_.find(name);
  const std::size_t others = size_ - (old == kept_.end() ? 0 : old->second.size());
  if (old == kept_.end() && kept_.size() >= most) {
    return make_fault(
        ErrorCode::too_many, "snapshot.name",
        fmt::format("The server keeps {} snapshots already; use one of their names again.", most));
  }
  if (others + size > most_bytes) {
    return make_fault(
        ErrorCode::too_large, "snapshot.name",
        fmt::format(
            "The snapshot has {} bytes, and the others have {}; together at most {} are kept.",
            size, others, most_bytes));
  }
  return std::nullopt;
}

std::optional<wire::Fault> Snapshots::keep(const std::string& name, const World& world) {
  if (auto fault = fault_of_name(name, "snapshot.name")) return fault;
  try {
    Snapshot snapshot = world.simulation.snapshot();
    const std::size_t size = snapshot.size();
    if (auto fault = fault_of_size(name, size)) return fault;
    if (!folder_.empty()) write(name, snapshot, world);
    const auto [place, is_new] = kept_.try_emplace(name);
    size_ += size - (is_new ? 0 : place->second.size());
    place->second = std::move(snapshot);
  } catch (const simulation::SnapshotError& error) {
    return make_fault(ErrorCode::out_of_state, "snapshot.name", error.what());
  }
  return std::nullopt;
}

/// A file is there whole or not at all.
void Snapshots::write(const std::string& name, const Snapshot& snapshot, const World& world) const {
  const std::vector<std::byte> bytes = simulation::to_bytes(snapshot, {world.scene_hash, build_});
  if (bytes.size() > longest_file) {
    throw simulation::SnapshotError(fmt::format(
        "The snapshot has more than {} MiB, the most that a file may have.", longest_file >> 20));
  }
  const std::filesystem::path path = path_of(name), partial = path.string() + ".part";
  const bool is_written = write_new(partial, bytes);
  std::error_code error;
  if (is_written) std::filesystem::rename(partial, path, error);
  if (is_written && !error) return;
  std::filesystem::remove(partial, error);
  throw simulation::SnapshotError("The snapshot can't be written to the server's folder.");
}

std::variant<FoundSnapshot, wire::Fault> Snapshots::find(const std::string& name,
                                                         const World& world,
                                                         const scene::OpenFile& open) const {
  if (auto fault = fault_of_name(name, "restore.name")) return std::move(*fault);
  if (const auto found = kept_.find(name); found != kept_.end()) {
    return FoundSnapshot{found->second, {}};
  }
  std::error_code error;
  const bool is_file = !folder_.empty() && std::filesystem::is_regular_file(path_of(name), error);
  if (!is_file) {
    return make_fault(ErrorCode::bad_value, "restore.name",
                      fmt::format("There is no snapshot '{}'.", name));
  }
  try {
    std::vector<std::byte> bytes = read_file(path_of(name));
    Snapshot snapshot = simulation::from_bytes(
        bytes, {world.scene_hash, build_}, reader_of_spawned(world.additions, world.scene, open));
    return FoundSnapshot{std::move(snapshot), std::move(bytes)};
  } catch (const std::exception& exception) {
    return make_fault(ErrorCode::bad_value, "restore.name",
                      fmt::format("'{}': {}", path_of(name).filename().string(), exception.what())
                          .substr(0, 1024));
  }
}

}  // namespace ziggurat::supervision
