// SPDX-License-Identifier: MIT
#pragma once
// Snapshots by name: in memory, and in a folder that the server's user has named.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/files.h"
#include "supervision/world.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

struct FoundSnapshot {
  simulation::Snapshot snapshot;
  std::vector<std::byte> bytes;  ///< of its file; empty: it was kept by this server
};

class Snapshots {
 public:
  /// @param folder  empty: none; what is kept is written there, too
  /// @param build   of this program: snapshots of another can't be read
  /// @throws std::runtime_error if the folder is none
  Snapshots(std::filesystem::path folder, std::string build);

  /// Keeps the world as it is. A snapshot of the same name is replaced.
  /// @return  why that can't be; then nothing changes
  std::optional<wire::Fault> keep(const std::string& name, const World& world);

  /// The snapshot of a name, from memory or from the folder.
  /// @param open  opens the files that spawned elements name
  /// @return  or why there is none
  std::variant<FoundSnapshot, wire::Fault> find(const std::string& name, const World& world,
                                                const scene::OpenFile& open) const;

 private:
  std::optional<wire::Fault> fault_of_size(const std::string& name, std::size_t size) const;
  std::filesystem::path path_of(const std::string& name) const;
  void write(const std::string& name, const simulation::Snapshot& snapshot,
             const World& world) const;

  std::filesystem::path folder_;
  std::string build_;
  std::map<std::string, simulation::Snapshot> kept_;
  std::size_t size_ = 0;  // of all of them [bytes]
};

}  // namespace ziggurat::supervision
