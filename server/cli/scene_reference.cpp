// SPDX-License-Identifier: MIT
#include "cli/scene_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "run/options/option_table.h"
#include "scene/vocabulary.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

using scene::Asked;
using scene::Described;
using scene::Need;

/// Elements that are alike.
struct Entry {
  const Described* element;  ///< the first of them
  std::vector<std::string> names;
  std::vector<std::string> parents;  ///< of each of them
};

/// `required`, its default, or what it has in one variant or the other.
std::string default_of(const Asked& asked) {
  std::vector<std::string> parts;
  const auto is = [&](Need need) {
    return std::ranges::find(asked.needs, need) != asked.needs.end();
  };
  if (is(Need::required)) parts.emplace_back("required");
  const bool is_set = asked.usual.size() == 1 && !asked.usual[0].empty();
  if (is(Need::optional) && asked.usual.size() > 1) parts.emplace_back("depends on others");
  if (is(Need::optional) && is_set) parts.push_back("`" + asked.usual[0] + "`");
  if (is(Need::optional) && parts.empty()) parts.emplace_back("none");
  if (is(Need::without_effect)) parts.emplace_back("no effect");
  return fmt::format("{}", fmt::join(parts, " or "));
}

std::string rows_of(const Described& element) {
  std::string text;
  for (const Asked& asked : element.attributes) {
    std::string type = asked.type;
    for (std::size_t bar = type.find('|'); bar != type.npos; bar = type.find('|', bar)) {
      type.replace(bar, 1, ", ");
    }
    text += fmt::format("| `{}` | {} | {} | {} |\n", asked.attribute, type, asked.unit,
                        default_of(asked));
  }
  return text;
}

bool are_alike(const Described& one, const Described& other) {
  return rows_of(one) == rows_of(other) && one.children == other.children;
}

/// Each element below its parents, in the order of a document; equal ones of one name once.
std::vector<Entry> elements_of(const scene::Vocabulary& vocabulary) {
  std::vector<Entry> entries;
  const std::function<void(std::string_view)> descend = [&](std::string_view parent) {
    for (const Described& element : vocabulary.elements) {
      if (element.name.empty() || element.parent != parent) continue;
      const auto same = std::ranges::find_if(entries, [&](const Entry& entry) {
        return entry.element->name == element.name && are_alike(*entry.element, element);
      });
      if (same == entries.end()) {
        entries.push_back({&element, {element.name}, {element.parent}});
      } else {
        same->parents.push_back(element.parent);
      }
      descend(element.parent.empty() ? element.name : element.parent + "/" + element.name);
    }
  };
  descend("");
  return entries;
}

/// The same, with elements that are alike in the same places as one.
std::vector<Entry> entries_of(const scene::Vocabulary& vocabulary) {
  std::vector<Entry> entries;
  for (Entry& each : elements_of(vocabulary)) {
    const auto same = std::ranges::find_if(entries, [&](const Entry& entry) {
      return entry.parents == each.parents && are_alike(*entry.element, *each.element);
    });
    if (same == entries.end()) {
      entries.push_back(std::move(each));
    } else {
      same->names.push_back(each.element->name);
    }
  }
  return entries;
}

std::string elements(const std::vector<std::string>& names) {
  return fmt::format("`<{}>`", fmt::join(names, ">`, `<"));
}

std::string places(const std::vector<std::string>& parents) {
  if (parents.front().empty()) return "the root";
  return fmt::format("`{}`", fmt::join(parents, "`, `"));
}

std::string section(const Entry& entry) {
  const Described& element = *entry.element;
  std::string text = fmt::format("## {}\n\nIn {}.\n", elements(entry.names), places(entry.parents));
  if (!element.children.empty())
    text += fmt::format("\nContains `<{}>`.\n", fmt::join(element.children, "> <"));
  if (element.attributes.empty()) return text;
  return text + "\n| Attribute | Type | Unit | Default |\n|---|---|---|---|\n" + rows_of(element);
}

}  // namespace

std::string scene_reference(std::span<const std::string> names) {
  const scene::Vocabulary vocabulary = scene::whole_vocabulary(run::run_attributes());
  const std::vector<Entry> entries = entries_of(vocabulary);
  std::vector<std::string> known;
  for (const Entry& entry : entries)
    known.insert(known.end(), entry.names.begin(), entry.names.end());
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) != known.end()) continue;
    throw text::UsageError(
        fmt::format("there is no element <{}> in a scene; {}", name,
                    text::advice(name, known, "'ziggurat help scene' has all of them")));
  }
  std::string text;
  for (const Entry& entry : entries) {
    const bool is_wanted =
        names.empty() || std::ranges::find_first_of(entry.names, names) != entry.names.end();
    if (is_wanted) text += (text.empty() ? "" : "\n") + section(entry);
  }
  return text;
}

}  // namespace ziggurat::cli
