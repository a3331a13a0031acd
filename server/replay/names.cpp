#include "replay/names.h"

#include <fmt/format.h>

#include <cstdint>

#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::replay {

std::vector<std::string> link_names(const RecordingFile& file) {
  std::vector<std::string> names;
  auto messages = file.messages({"/world"});
  if (!messages) return names;
  v1::World world;
  while (const auto message = next(file, *messages)) {
    if (!world.ParseFromArray(message->data.data(), static_cast<int>(message->data.size()))) continue;
    if (static_cast<std::size_t>(world.links_size()) <= names.size()) continue;
    names.clear();
    for (const auto& link : world.links()) {
      const bool is_known = link.entity() < static_cast<std::uint32_t>(world.entities_size());
      const std::string id = is_known ? world.entities(static_cast<int>(link.entity())).id() : "?";
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
