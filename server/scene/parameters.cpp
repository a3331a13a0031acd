// SPDX-License-Identifier: MIT
#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "scene/draft.h"
#include "text/shortened.h"

namespace ziggurat::scene {
namespace {

constexpr std::size_t longest_text = 1 << 20;  // of an attribute, with its parameters [bytes]

std::vector<std::string> names_of(const Parameters& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (names.size() < most_compared) names.push_back(parameter.name);
  }
  return names;
}

Wrong unknown(std::string_view name, const Parameters& parameters) {
  if (parameters.is_open()) {
    return {
        fmt::format("uses ${{{}}}, and values in <parameters> are not made of other parameters; "
                    "write the value itself, or $${{ "
                    "for a literal ${{",
                    text::shortened(name))};
  }
  return {parameters.empty()
              ? fmt::format("uses ${{{0}}}, and the scene has no parameters; write <parameters "
                            "{0}=\"…\"/> into <argos-configuration>, or $${{ for a literal ${{",
                            text::shortened(name))
              : fmt::format("uses ${{{}}}, which is no parameter; {}", text::shortened(name),
                            advice(name, names_of(parameters)))};
}

bool is_number(std::string_view text) {
  return std::holds_alternative<double>(number(trimmed(text)));
}

/// "1|2|3" for "1,2,3", "1;2;3" or "1 2 3", as a sweep is told of several values; empty if these
/// are no numbers.
std::string as_values(std::string_view text) {
  constexpr std::string_view separators = ",; \t";
  std::string values;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    const std::string_view part = text.substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    if (!is_number(part)) return {};
    values += fmt::format("{}{}", values.empty() ? "" : "|", part);
  }
  return values.find('|') == std::string::npos ? std::string() : values;
}

bool is_range(std::string_view text) {
  const std::size_t dots = text.find("..");
  return dots != std::string_view::npos && is_number(text.substr(0, dots)) &&
         is_number(text.substr(dots + 2));
}

/// Warns about several numbers for a parameter with one number in the scene: probably as many runs
/// are meant.
/// @param given  by the command line
std::string doubt(const Parameter& declared, const std::string& given) {
  if (!is_number(declared.value)) return {};
  std::string values = as_values(given);
  if (values.empty() && is_range(given)) values = "1|2|3";
  if (values.empty()) return {};
  return fmt::format(
      "--param {0}={1} is one value, the text {2}, where the scene has the number {3}; for a run "
      "with each of "
      "several write: ziggurat sweep … --param '{0}={4}'",
      text::shortened(declared.name), text::shortened(given), in_quotes(given),
      text::shortened(declared.value), text::shortened(values));
}

}  // namespace

const Parameter* Parameters::find(std::string_view name) const {
  const auto found = index_.find(std::string(name));
  return found == index_.end() ? nullptr : &list_[found->second];
}

void Parameters::declare(std::string name, std::string value) {
  if (index_.emplace(name, list_.size()).second)
    list_.push_back({std::move(name), std::move(value)});
}

bool Parameters::give(std::string_view name, std::string value) {
  const auto found = index_.find(std::string(name));
  if (found == index_.end()) return false;
  list_[found->second].value = std::move(value);
  list_[found->second].given = true;
  return true;
}

Value<std::string> expand(std::string_view text, const Parameters& parameters) {
  std::string result;
  for (std::size_t begin = 0;;) {
    const std::size_t found = text.find("${", begin);
    const bool is_literal =
        found != std::string_view::npos && found > begin && text[found - 1] == '$';
    result += text.substr(begin, is_literal ? found - 1 - begin : found - begin);
    if (result.size() > longest_text) {
      return Wrong{fmt::format("has more than {} bytes with its parameters", longest_text)};
    }
    if (found == std::string_view::npos) return result;
    if (is_literal) {
      result += "${";
      begin = found + 2;
      continue;
    }
    const std::size_t end = text.find('}', found);
    if (end == std::string_view::npos) {
      return Wrong{"has ${ without }; write ${name}, or $${ for a literal ${"};
    }
    const std::string_view name = text.substr(found + 2, end - found - 2);
    const Parameter* parameter = parameters.find(name);
    if (!parameter) return unknown(name, parameters);
    result += parameter->value;
    begin = end + 1;
  }
}

Params with_parameters(Params params, const Parameters& parameters) {
  if (parameters.empty()) return params;
  std::unordered_set<std::string> own;
  for (auto& [name, value] : params) {
    own.insert(name);
    if (const Parameter* same = parameters.find(name); same && same->given) value = same->value;
  }
  for (const Parameter& parameter : parameters) {
    if (!own.contains(parameter.name)) params.emplace_back(parameter.name, parameter.value);
  }
  return params;
}

void read_parameters(Draft& draft, Element& root) {
  if (auto element = root.child("parameters")) {
    draft.parameters.set_open(true);
    auto declared = element->all_attributes();
    draft.parameters.set_open(false);
    for (auto& [name, value] : declared) {
      draft.parameters.declare(std::move(name), std::move(value));
    }
    element->done();
  }
  for (const auto& [name, value] : draft.options.variation.parameters) {
    if (const Parameter* declared = draft.parameters.find(name)) {
      if (auto text = doubt(*declared, value); !text.empty()) {
        draft.report.warn(root.where(), "parameter", std::move(text));
      }
      draft.parameters.give(name, value);
      continue;
    }
    draft.report.fault(
        root.where(),
        draft.parameters.empty()
            ? fmt::format("--param {0}={1}: the scene has no parameters; write <parameters "
                          "{0}=\"{1}\"/> into <argos-configuration>",
                          text::shortened(name), text::shortened(value))
            : fmt::format("--param {}={}: the scene has no such parameter; {}",
                          text::shortened(name), text::shortened(value),
                          advice(name, names_of(draft.parameters))));
  }
}

}  // namespace ziggurat::scene
