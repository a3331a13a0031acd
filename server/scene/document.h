// SPDX-License-Identifier: MIT
#pragma once
// A scene file as XML: elements and attributes with their line and column, and what the command
// line set in it.

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/parameters.h"
#include "scene/problem.h"
#include "scene/report.h"
#include "scene/settings.h"
#include "scene/values.h"

namespace ziggurat::scene {

struct Vocabulary;

/// Budget that a scene and its includes may still use.
struct ReadBudget {
  std::size_t bytes = 0;
  std::size_t tags = 0;        ///< opening and closing ones
  std::size_t attributes = 0;  ///< of each element
  bool is_spent = false;       ///< a value with parameters was too large
};

/// The budget of a scene of at most so many bytes.
ReadBudget budget_for(std::size_t max_size);

/// One parsed file.
class Document {
 public:
  /// Parses; what is wrong with the text itself (not UTF-8, malformed, …) is a fault.
  /// @param file  its index in Scene::files
  /// @param budget  at least the text's size; the text, settings and values of parameters are taken
  /// from it; must
  ///     outlive this
  /// @param parameters  what ${name} stands for; must outlive this; null: none
  /// @param vocabulary  records what elements are asked for; must outlive this; null: not recorded
  Document(std::string text, std::size_t file, bool lenient, ReadBudget& budget, Report& report,
           const Parameters* parameters = nullptr, Vocabulary* vocabulary = nullptr);
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  /// The root element; empty if the text is no well-formed document.
  pugi::xml_node root() const { return root_; }

  /// Sets attributes. @returns how many; what is wrong with the path
  /// @param setting  must outlive this
  Value<std::size_t> set(const Setting& setting);

  /// Location of a character of the parsed text.
  Location locate(const char* character) const;
  /// Location of an attribute's name, or of its element if the attribute was set.
  Location locate(const pugi::xml_attribute& attribute) const;
  /// Location of its value; the same.
  Location locate_value(const pugi::xml_attribute& attribute) const;

  /// The attribute's text as written, before character references are replaced.
  std::string_view raw(const pugi::xml_attribute& attribute) const;
  /// The setting that set it, or null.
  const Setting* setting_of(const pugi::xml_attribute& attribute) const;
  /// Origin of an attribute's value, if not as written: continues a message.
  std::string origin(const pugi::xml_attribute& attribute) const;
  /// Its value with parameters, which count as if they were written out, trimmed.
  Value<std::string> value(const pugi::xml_attribute& attribute) const;

  bool lenient() const { return lenient_; }
  Report& report() const { return report_; }
  Vocabulary* vocabulary() const { return vocabulary_; }

 private:
  void parse();
  bool check_attributes(std::size_t most) const;
  bool check_text();
  void check_outside();
  void check_doctype();
  Location at(std::size_t offset) const;

  std::string source_;  ///< as read
  std::string buffer_;  ///< what the parser works in: same offsets, changed characters
  std::size_t file_;
  bool lenient_;
  ReadBudget& budget_;
  Report& report_;
  const Parameters* parameters_;
  Vocabulary* vocabulary_;
  std::vector<std::size_t> line_starts_;
  pugi::xml_document tree_;
  pugi::xml_node root_;
  struct Set {
    const Setting* setting;
    Location where;  ///< of the element
  };
  std::unordered_map<std::size_t, Set> set_;  ///< by xml_attribute::hash_value(); only looked up
};

}  // namespace ziggurat::scene
