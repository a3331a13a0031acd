// SPDX-License-Identifier: MIT
// The files that a scene is made of: the scene's own, and those that it includes.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t deepest_include = 16;
constexpr unsigned most_includes = 1000;

std::string join(const std::vector<std::string>& names, std::size_t first) {
  std::string text;
  for (std::size_t i = first; i < names.size(); ++i) text += names[i] + " includes ";
  return text + names[first];
}

/// Follows includes from file to file.
struct Includes {
  Draft& draft;
  Parts parts;
  std::vector<std::string> open;   ///< identities of the files from the scene to the current one
  std::vector<std::string> names;  ///< theirs, as messages call them
  std::set<std::string> known;     ///< identities of all files so far
  unsigned count = 0;

  void read_scene(Element& root) {
    for (Element& element : root.children("include")) include(element);
    if (auto models = root.child("models")) parts.models.push_back(*models);
  }

  void read_included(Element& root) {
    read_scene(root);
    if (auto controllers = root.child("controllers")) parts.controllers.push_back(*controllers);
    root.done(
        "a file that is included may have <include>, <models> and <controllers>; write "
        "everything else into the scene");
  }

  void include(Element& element) {
    const std::string written = element.required("file", path);
    element.done();
    if (written.empty() || ++count > most_includes + 1) return;
    if (count > most_includes) {
      element.fault(fmt::format("is one too many; a scene has at most {}", most_includes));
      return;
    }
    const fs::path path = (fs::path(names.back()).parent_path() / written).lexically_normal();
    auto opened = draft.options.open(path, draft.budget.bytes);
    if (const std::string* why = std::get_if<std::string>(&opened)) {
      element.fault_at("file", fmt::format("names {}, which {}", in_quotes(path.string()), *why));
      return;
    }
    File& file = std::get<File>(opened);
    if (file.text.size() > draft.budget.bytes) {
      element.fault_at("file", too_large(draft.budget.bytes));
    } else if (may_stand(element, file.identity)) {
      add(std::move(file), path.string());
    }
  }

  /// False for a file that was read before, and after a fault.
  bool may_stand(const Element& element, const std::string& identity) {
    const auto same = std::find(open.begin(), open.end(), identity);
    if (same != open.end()) {
      const auto first = static_cast<std::size_t>(same - open.begin());
      element.fault_at("file", fmt::format("closes a cycle: {}; remove one of these includes",
                                           join(names, first)));
      return false;
    }
    if (open.size() > deepest_include) {
      element.fault_at("file", fmt::format("is nested too deep; includes may lead over {} files",
                                           deepest_include));
      return false;
    }
    return known.insert(identity).second;
  }

  void add(File file, const std::string& name) {
    Document& document = draft.add_document(std::move(file.text), name);
    open.push_back(std::move(file.identity));
    names.push_back(name);
    if (document.root()) {
      Element root(document, document.root());
      read_included(root);
    }
    open.pop_back();
    names.pop_back();
  }
};

}  // namespace

std::string too_large(std::size_t max_size) {
  return fmt::format("is larger than {} bytes; split the scene, or raise --max-scene-size",
                     max_size);
}

std::optional<std::string> fault_of_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    const fs::path scene = path.string() + ".argos";
    if (fs::is_regular_file(scene, error))
      return fmt::format("does not exist; write {}", scene.string());
    return "does not exist; check its path";
  }
  if (error) return fmt::format("cannot be read: {}", error.message());
  if (status.type() == fs::file_type::directory)
    return "is a folder; write the path of a file in it";
  if (status.type() != fs::file_type::regular) return "is not a regular file; check its path";
  const int opened = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) {
    const int reason = errno;
    return fmt::format("cannot be read: {}{}", std::strerror(reason),
                       reason == EACCES ? "; check its permissions" : "");
  }
  ::close(opened);
  return std::nullopt;
}

bool stays_inside(const std::filesystem::path& path) {
  if (path.is_absolute() || path.has_root_path()) return false;
  return std::ranges::find(path, "..") == path.end();
}

std::variant<File, std::string> open_file(const fs::path& path, std::size_t max_size) {
  if (auto fault = fault_of_file(path)) return *std::move(fault);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > max_size) return too_large(max_size);
  std::ifstream file(path, std::ios::binary);
  if (!file) return "cannot be opened; check its permissions";
  std::string text;
  for (char block[65536]; file.read(block, sizeof block) || file.gcount() > 0;) {
    text.append(block, static_cast<std::size_t>(file.gcount()));
    if (text.size() > max_size) return too_large(max_size);
  }
  if (file.bad()) return "cannot be read to its end";
  return File{fs::canonical(path, error).string(), std::move(text)};
}

std::variant<File, std::string> open_no_file(const fs::path&, std::size_t) {
  return "may not be read: an element that is added to a scene may read no file; use a model of "
         "the "
         "scene";
}

Parts read_includes(Draft& draft, Element& root, const std::string& identity) {
  Includes includes{draft, {}, {identity}, {draft.scene.files[0]}, {identity}};
  includes.read_scene(root);
  return std::move(includes.parts);
}

}  // namespace ziggurat::scene
