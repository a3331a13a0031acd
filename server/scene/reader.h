// SPDX-License-Identifier: MIT
#pragma once
// Reads a scene file and checks it whole: every fault found is reported, not only the first.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "scene/additions.h"
#include "scene/files.h"
#include "scene/problem.h"
#include "scene/scene.h"

namespace ziggurat::scene {

struct Vocabulary;

/// Attributes that <run> may have: options of the program, which this module does not know.
struct RunAttributes {
  std::vector<std::string> names;
  /// Why the attribute `name` can't have this value; null: any attribute is taken, unchecked.
  std::optional<std::string> (*wrong)(const std::string& name, const std::string& value) = nullptr;
};

struct ReadOptions {
  bool lenient = false;  ///< unknown attributes, plug-ins and what libraries do become notices
  std::optional<Clock> clock = {};               ///< instead of the scene's
  std::size_t max_size = std::size_t{64} << 20;  ///< of the scene with what it includes and with
                                                 ///< its models written out [bytes]
  Variation variation = {};
  RunAttributes run = {};
  Vocabulary* vocabulary = nullptr;  ///< records what elements are asked for; null: not recorded
  OpenFile open = open_file;         ///< every file that is read, the scene's and those it includes
};

struct ReadResult {
  Scene scene;                    ///< complete only if no problem is a fault
  std::vector<Problem> problems;  ///< by file, in document order
  Additions additions;            ///< to the scene, if no problem is a fault
  bool ok() const;                ///< no fault
};

/// Never throws for what the file says; std::bad_alloc aside.
ReadResult read_file(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same for a text; `name` stands in messages, and what it includes starts at its folder.
ReadResult read_text(std::string text, const std::string& name, const ReadOptions& options = {});

/// Carries all faults of an author: scene, arguments, environment.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace ziggurat::scene
