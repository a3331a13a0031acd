// SPDX-License-Identifier: MIT
#include "recording/replay/names.h"

#include <fmt/format.h>

#include <cstdint>

#include "recording/replay/recording_file.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::replay {

namespace {

/// Id of the entity that a link names.
const std::string& entity_of(const v1::World& world, const v1::World::Link& link) {
  static const std::string unknown = "?";
  const bool is_known = link.entity() < static_cast<std::uint32_t>(world.entities_size());
  return is_known ? world.entities(static_cast<int>(link.entity())).id() : unknown;
}

}  // namespace

std::optional<std::string> fault_of_names(const v1::World& world) {
  std::size_t bytes = 0;
  for (const auto& link : world.links()) bytes += entity_of(world, link).size() + link.id().size();
  for (const auto& entity : world.entities()) bytes += entity.id().size();
  if (bytes <= most_name_bytes) return std::nullopt;
  return fmt::format(
      "a message of /world is damaged: the names of its links have {} bytes; at most {} are read",
      bytes, most_name_bytes);
}

std::vector<std::string> link_names(const RecordingFile& file) {
  std::vector<std::string> names;
  auto messages = file.messages({"/world"});
  if (!messages) return names;
  v1::World world;
  while (const auto message = next(file, *messages)) {
    file.decode(*messages, *message, world);
    if (const auto fault = fault_of_names(world)) throw RecordingError(file.path() + ": " + *fault);
    if (static_cast<std::size_t>(world.links_size()) <= names.size()) continue;
    names.clear();
    for (const auto& link : world.links()) {
      const std::string& id = entity_of(world, link);
      names.push_back(link.id().empty() ? fmt::format("'{}'", id)
                                        : fmt::format("'{}', link '{}'", id, link.id()));
    }
  }
  return names;
}

std::string name_of(const std::vector<std::string>& names, std::size_t link) {
  return link < names.size() ? names[link] : fmt::format("link number {}", link);
}

}  // namespace ziggurat::replay
