#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/document.h"
#include "scene/reading.h"

namespace ziggurat::scene {
namespace {

void read_scene(Reading& reading, File file, const std::string& name) {
  Document& document = reading.add_document(std::move(file.text), name);
  if (!document.root()) return;
  Element root(document, document.root());
  Parts parts = read_includes(reading, root, file.identity);
  read_framework(reading, root);
  read_engines(reading, root);
  read_media(reading, root);
  read_controllers(reading, root, parts.controllers);
  for (Element& models : parts.models) read_models(reading, models);
  read_arena(reading, root);
  root.child_without_effect("visualization", "use the web viewer");
  root.done();
}

ReadResult read(File file, const std::string& name, const ReadOptions& options) {
  ReadResult result;
  Report report(result.scene.files);
  Reading reading(report, result.scene, options);
  try {
    read_scene(reading, std::move(file), name);
  } catch (const TooManyFaults&) {
    // The last fault says so.
  }
  result.problems = report.problems();
  result.additions = Additions(reading);
  return result;
}

ReadResult refuse(const std::string& name, std::string text) {
  ReadResult result;
  result.scene.files = {name};
  result.problems = {{Problem::Severity::fault, name, {}, std::move(text)}};
  return result;
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
  if (text.size() > options.max_size)
    return refuse(name, "the file " + too_large(options.max_size));
  const std::string identity = std::filesystem::path(name).lexically_normal().string();
  return read({identity, std::move(text)}, name, options);
}

ReadResult read_file(const std::filesystem::path& path, const ReadOptions& options) {
  auto opened = options.open(path, options.max_size);
  if (const std::string* why = std::get_if<std::string>(&opened)) {
    return refuse(path.string(), "the file " + *why);
  }
  return read(std::get<File>(std::move(opened)), path.string(), options);
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
