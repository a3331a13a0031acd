// SPDX-License-Identifier: MIT
#include "recording/replay/embedded_files.h"

#include <fmt/format.h>

#include <utility>

namespace ziggurat::replay {
namespace {

std::string normal(const std::filesystem::path& path) { return path.lexically_normal().string(); }

}  // namespace

void EmbeddedFiles::add(const std::string& name, std::string bytes) {
  files_.insert_or_assign(normal(name), std::move(bytes));
}

const std::string* EmbeddedFiles::find(const std::filesystem::path& path) const {
  const auto found = files_.find(normal(path));
  return found == files_.end() ? nullptr : &found->second;
}

scene::OpenFile EmbeddedFiles::opener() const {
  return [this](const std::filesystem::path& path,
                std::size_t max_size) -> std::variant<scene::File, std::string> {
    const std::string* bytes = find(path);
    if (!bytes) return "is not in the recording, which alone is read";
    if (bytes->size() > max_size) {
      return fmt::format("is larger than the {} bytes that are left for the scene", max_size);
    }
    return scene::File{normal(path), *bytes};
  };
}

}  // namespace ziggurat::replay
