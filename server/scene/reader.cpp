#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include "scene/document.h"
#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

void read_root(Reading& reading, Element& root) {
  read_framework(reading, root);
  read_engines(reading, root);
  read_media(reading, root);
  read_controllers(reading, root);
  read_arena(reading, root);
  root.child_without_effect("visualization", "use the web viewer");
  root.done();
}

ReadResult refuse(const std::string& name, std::string text) {
  ReadResult result;
  result.scene.files = {name};
  result.problems = {{Problem::Severity::fault, name, {}, std::move(text)}};
  return result;
}

std::string too_large(std::size_t max_size) {
  return fmt::format(
      "the file is larger than {} bytes; split the scene, or raise "
      "--max-scene-size",
      max_size);
}

}  // namespace

std::string to_string(const Problem& problem) {
  if (problem.where.line == 0) return fmt::format("{}: {}", problem.file, problem.text);
  return fmt::format("{}:{}:{}: {}", problem.file, problem.where.line, problem.where.column,
                     problem.text);
}

bool ReadResult::ok() const {
  return std::none_of(problems.begin(), problems.end(), [](const Problem& problem) {
    return problem.severity == Problem::Severity::fault;
  });
}

ReadResult read_text(std::string text, const std::string& name, const ReadOptions& options) {
  if (text.size() > options.max_size) return refuse(name, too_large(options.max_size));
  ReadResult result;
  result.scene.files = {name};
  Document document(std::move(text), name, 0, options);
  if (document.root()) {
    Element root(document, document.root());
    Reading reading{document, result.scene, {}, false, {}, {}, {}, {}, {}, {}};
    try {
      read_root(reading, root);
    } catch (const TooManyFaults&) {
      // The last fault says so.
    }
  }
  result.problems = document.problems();
  return result;
}

ReadResult read_file(const std::filesystem::path& path, const ReadOptions& options) {
  namespace fs = std::filesystem;
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return refuse(name, "the file does not exist; name a scene file");
  }
  if (error) return refuse(name, fmt::format("cannot be read: {}", error.message()));
  if (status.type() != fs::file_type::regular) {
    return refuse(name, "this is not a regular file; name a scene file");
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (!error && size > options.max_size) return refuse(name, too_large(options.max_size));
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse(name, "cannot be opened; check its permissions");
  std::string text;
  for (char block[65536]; file.read(block, sizeof block) || file.gcount() > 0;) {
    text.append(block, static_cast<std::size_t>(file.gcount()));
    if (text.size() > options.max_size) return refuse(name, too_large(options.max_size));
  }
  if (file.bad()) return refuse(name, "cannot be read to its end");
  return read_text(std::move(text), name, options);
}

SceneError::SceneError(std::vector<Problem> problems)
    : std::runtime_error([&problems] {
        std::string text;
        for (const Problem& problem : problems) {
          if (problem.severity != Problem::Severity::fault) continue;
          text += (text.empty() ? "" : "\n") + to_string(problem);
        }
        return text;
      }()),
      problems_(std::move(problems)) {}

}  // namespace ziggurat::scene
