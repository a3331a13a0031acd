// SPDX-License-Identifier: MIT
#include "scene/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <regex>
#include <utility>

#include "scene/names.h"
#include "text/shortened.h"

namespace ziggurat::scene {
namespace {

/// Position of a character's first occurrence outside of brackets and quotes, or npos.
std::size_t find_outside(std::string_view text, char wanted, std::size_t begin = 0) {
  int depth = 0;
  char quote = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == wanted && depth == 0) {
      return i;
    } else if (c == '[' || c == '(') {
      ++depth;
    } else if (c == ']' || c == ')') {
      --depth;
    }
  }
  return std::string_view::npos;
}

bool is_name(std::string_view text) {
  const auto begins = [](unsigned char c) { return std::isalpha(c) || c == '_' || c >= 0x80; };
  const auto goes_on = [&](unsigned char c) {
    return begins(c) || std::isdigit(c) || c == '-' || c == '.';
  };
  return !text.empty() && begins(static_cast<unsigned char>(text.front())) &&
         std::ranges::all_of(text, goes_on);
}

/// A path that ends with `@name`: what stands before it, without its `/`, and the name.
struct Ending {
  std::string elements;  ///< `.` for the root
  std::string name;      ///< empty: the path ends otherwise
};

Ending ending_of(const std::string& path) {
  const std::size_t at = path.rfind('@');
  if (at == std::string::npos || !is_name(std::string_view(path).substr(at + 1))) return {};
  const std::string name = path.substr(at + 1);
  if (at == 0) return {".", name};
  if (path[at - 1] != '/' || at == 1 || path[at - 2] == '/') return {};  // //@name: any element's
  return {path.substr(0, at - 1), name};
}

constexpr std::size_t longest_path = 1024;  // [bytes]

/// Whether a condition takes a time in proportion to what stands below its element: it compares
/// paths down from there with fixed values.
bool is_cheap(std::string_view condition) {
  static const std::regex cheap = [] {
    const std::string more = R"([^\s\[\]()'"/@=<>!|,*+$:])", name = R"((?![-.0-9]))" + more + "+";
    const std::string step = "(?:" + name + R"(|\*|\.(?!\.)))",
                      attribute = "@(?:" + name + R"(|\*))";
    const std::string path =
        "(?:" + attribute + "|" + step + "(?:/" + step + ")*(?:/" + attribute + ")?)";
    const std::string value = R"((?:'[^']*'|"[^"]*"|-?[0-9]+(?:\.[0-9]+)?))";
    const std::string call = R"((?:position\(\)|last\(\)|count\()" + path +
                             R"(\)|(?:starts-with|contains)\()" + path + R"(,\s*)" + value +
                             R"(\)))";
    const std::string comparison =
        "(?:(?:" + call + "|" + path + ")(?:\\s*(?:=|!=|<=?|>=?)\\s*" + value + ")?|[0-9]+)";
    const std::string term = "(?:" + comparison + "|not\\(" + comparison + "\\))";
    return std::regex("\\s*" + term + "(?:\\s+(?:and|or)\\s+" + term + ")*\\s*");
  }();
  return std::regex_match(condition.begin(), condition.end(), cheap);
}

/// Refuses paths whose cost grows with a power of the scene's size or of their length. They are
/// conditions in conditions or with far paths, axes, several `//`, and many `..` as in
/// `*/../*/../*`.
std::optional<Wrong> check_cost(std::string_view path) {
  if (path.size() > longest_path) {
    return Wrong{
        fmt::format("has {} characters; at most {} are allowed", path.size(), longest_path)};
  }
  constexpr std::size_t most_upward = 3;
  std::size_t begin = 0, anywhere = 0, upward = 0;  // of the condition; number of // and of ..
  bool is_condition = false;
  char quote = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const char c = path[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (path.substr(i, 2) == "::") {
      return Wrong{
          "has an axis (::); write element names, * and .. between /, or // before the first"};
    } else if (c == '[') {
      if (is_condition)
        return Wrong{"has [conditions] in [conditions]; write several after another: a[@x][b/@y]"};
      is_condition = true;
      begin = i + 1;
    } else if (c == ']' && is_condition) {
      is_condition = false;
      if (const auto condition = path.substr(begin, i - begin); !is_cheap(condition)) {
        return Wrong{fmt::format(
            "has the condition [{}]; write paths below the element, without // and .., and compare "
            "them with values: [@x='1' and b/@y]",
            text::shortened(condition))};
      }
    } else if (!is_condition && path.substr(i, 2) == "//" && ++anywhere > 1) {
      return Wrong{"has // more than once; write the names of the elements between"};
    } else if (!is_condition && path.substr(i, 2) == ".." && ++upward > most_upward) {
      return Wrong{"has .. more than three times; write the path without going up and down"};
    }
  }
  return std::nullopt;
}

Value<pugi::xpath_node_set> select(const pugi::xml_node& root, const std::string& path) {
  try {
    const pugi::xpath_query query(path.c_str());
    if (query.return_type() != pugi::xpath_type_node_set) {
      return Wrong{"is no path to attributes; write for example arena/@size"};
    }
    return query.evaluate_node_set(root);
  } catch (const pugi::xpath_exception& error) {
    return Wrong{fmt::format("is no XPath: {}, at character {}; write for example arena/@size",
                             error.result().error, error.result().offset + 1)};
  }
}

void add(std::vector<Attribute>& to, const pugi::xml_node& element, const std::string& name) {
  pugi::xml_node node = element;
  pugi::xml_attribute attribute = node.attribute(name.c_str());
  if (!attribute) attribute = node.append_attribute(name.c_str());
  to.push_back({node, attribute});
}

enum class NodeKind { element, attribute };

std::vector<std::string> names_in(const pugi::xpath_node_set& nodes, NodeKind kind) {
  std::vector<std::string> names;
  const auto add_name = [&](const char* name) {
    if (*name != 0 && std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  for (const pugi::xpath_node& found : nodes) {
    if (kind == NodeKind::attribute) {
      for (const pugi::xml_attribute each : found.node().attributes()) add_name(each.name());
    } else {
      for (const pugi::xml_node each : found.node().children()) add_name(each.name());
    }
  }
  return names;
}

}  // namespace

Value<Setting> to_setting(std::string_view text) {
  const std::size_t equals = find_outside(text, '=');
  if (equals == std::string_view::npos || trimmed(text.substr(0, equals)).empty()) {
    return Wrong{"is no setting; write PATH=VALUE, for example 'arena/@size=2,2,1'"};
  }
  return Setting{std::string(trimmed(text.substr(0, equals))),
                 std::string(text.substr(equals + 1))};
}

Value<std::pair<std::string, std::string>> to_parameter(std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view name = trimmed(text.substr(0, equals));
  if (equals == std::string_view::npos || !is_name(name)) {
    return Wrong{"is no parameter; write NAME=VALUE, for example gain=0.5"};
  }
  return std::pair{std::string(name), std::string(text.substr(equals + 1))};
}

std::string to_string(const Setting& setting) {
  return fmt::format("--set '{}={}'", text::shortened(setting.path),
                     text::shortened(setting.value));
}

std::string to_text(const Variation& variation) {
  std::string text;
  for (const auto& [path, value] : variation.settings)
    text += fmt::format("set {}={}\n", path, value);
  for (const auto& [name, value] : variation.parameters) {
    text += fmt::format("param {}={}\n", name, value);
  }
  return text;
}

Value<std::vector<Attribute>> attributes_at(const pugi::xml_node& root, const std::string& path) {
  if (const auto wrong = check_cost(path)) return *wrong;
  const Ending ending = ending_of(path);
  const auto selected = select(root, ending.name.empty() ? path : ending.elements);
  if (const Wrong* wrong = std::get_if<1>(&selected)) return *wrong;
  std::vector<Attribute> result;
  for (const pugi::xpath_node& found : std::get<0>(selected)) {
    if (!ending.name.empty() && found.node().type() == pugi::node_element) {
      add(result, found.node(), ending.name);
    } else if (ending.name.empty() && found.attribute()) {
      result.push_back({found.parent(), found.attribute()});
    } else {
      return Wrong{"names no attribute; let it end with /@NAME"};
    }
  }
  return result;
}

std::string why_nothing(const pugi::xml_node& root, const std::string& path) {
  auto parents = select(root, ".");
  for (std::size_t begin = 0, end = 0; begin < path.size(); begin = end + 1) {
    end = std::min(find_outside(path, '/', begin), path.size());
    if (end == begin) continue;  // of // or a leading /
    auto found = select(root, path.substr(0, end));
    const auto* nodes = std::get_if<0>(&found);
    if (nodes == nullptr) break;
    if (!nodes->empty()) {
      parents = std::move(found);
      continue;
    }
    std::string_view step = std::string_view(path).substr(begin, end - begin);
    const bool is_attribute = step.starts_with('@');
    if (is_attribute) step.remove_prefix(1);
    const std::string_view name = step.substr(0, step.find('['));
    const auto known =
        names_in(std::get<0>(parents), is_attribute ? NodeKind::attribute : NodeKind::element);
    const bool is_known = std::ranges::find(known, name) != known.end();
    if (end == path.size() && ending_of(path).name.empty()) {
      const auto attributes = names_in(std::get<0>(parents), NodeKind::attribute);
      const bool is_one = std::ranges::find(attributes, name) != attributes.end();
      return fmt::format(
          "matches nothing: {} {}", in_quotes(step),
          is_one ? fmt::format("is an attribute, and its name begins with @: write @{}", name)
                 : "is no element, and the path names no attribute: let it end with /@NAME");
    }
    return fmt::format("matches nothing: there is no {}{}", in_quotes(step),
                       is_known ? "" : "; " + advice(name, known));
  }
  return "matches nothing";
}

}  // namespace ziggurat::scene
