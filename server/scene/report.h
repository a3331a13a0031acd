// SPDX-License-Identifier: MIT
#pragma once
// All faults and notices about a scene and its included files, while they are read.

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "scene/reader.h"

namespace ziggurat::scene {

/// Thrown when so many faults were found that it makes no sense to continue; ends the reading
/// early.
struct TooManyFaults {};

class Report {
 public:
  /// @param files  what Location::file counts; must outlive this and may grow
  /// @param most_faults  that are found before the reading ends
  explicit Report(const std::vector<std::string>& files, std::size_t most_faults = 1000)
      : files_(files), most_faults_(most_faults) {}
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// @param causes  what is missing: the fault is not told if that was misspelt, or left out with
  ///     its own faults. Of all names, static text.
  void fault(Location where, std::string text, std::vector<std::string_view> causes = {});
  /// A fault was reported because of which something of this name is missing.
  void left_out(std::string_view name) { left_out_.emplace(name); }
  void notice(Location where, std::string text);  ///< each text once
  /// Only the first of each kind is told, with how many there are.
  /// @param kind  static text
  void warn(Location where, std::string_view kind, std::string text);

  /// `did you mean "x"?` for the first names that nothing has; afterwards what is known.
  std::string advice(std::string_view name, const std::vector<std::string>& candidates);

  /// Notice that something is read and checked, and does nothing yet: each subject once.
  /// @param plural  of what, for example "radios"
  void no_effect_yet(Location where, std::string_view plural);

  /// `file:line:column` of a place, for a message about another.
  std::string place(Location where) const;
  /// The same as ` at line 12` if that is in the same file; empty if it is nowhere.
  std::string place(Location where, Location reader) const;

  /// All problems so far: by file, and in document order within each. Without what only follows
  /// from others.
  std::vector<Problem> problems() const;

  /// Named in messages while it is set, for example `prototype "vehicle"`.
  std::string subject;

 private:
  struct Entry {
    Problem problem;
    std::vector<std::string_view> causes;
  };
  bool follows(const Entry& entry) const;

  const std::vector<std::string>& files_;
  std::size_t most_faults_;
  std::size_t advised_ = 0;
  std::vector<Entry> entries_;
  std::set<std::string, std::less<>> left_out_;
  struct Count {
    std::size_t entry = 0;  ///< into entries_: the first
    std::size_t more = 0;
  };
  std::map<std::string_view, Count> warnings_;  ///< by kind
  std::size_t faults_ = 0;
  std::unordered_set<std::string> noticed_;
};

}  // namespace ziggurat::scene
