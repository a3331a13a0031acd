#include "scene/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scene/document.h"
#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

void read_scene(Draft& draft, File file, const std::string& name) {
  Document& document = draft.add_document(std::move(file.text), name);
  if (!document.root()) return;
  Element root(document, document.root());
  Parts parts = read_includes(draft, root, file.identity);
  read_framework(draft, root);
  read_engines(draft, root);
  read_media(draft, root);
  read_controllers(draft, root, parts.controllers);
  for (Element& models : parts.models) read_models(draft, models);
  read_arena(draft, root);
  root.child_without_effect("visualization", "use the web viewer");
  root.done();
}

ReadResult read(File file, const std::string& name, const ReadOptions& options) {
  ReadResult result;
  Report report(result.scene.files);
  Draft draft(report, result.scene, options);
  try {
    read_scene(draft, std::move(file), name);
  } catch (const TooManyFaults&) {
    // The last fault says so.
  }
  result.problems = report.problems();
  result.additions = Additions(draft);
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
