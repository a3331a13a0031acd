// SPDX-License-Identifier: MIT
#include "cli/settings_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "scene/files.h"
#include "scene/values.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

/// Reads one file; its messages name their places.
class SettingsReader {
 public:
  explicit SettingsReader(const std::string& path) : path_(path) {}

  std::vector<FileSetting> read() {
    if (const auto wrong = scene::fault_of_file(path_)) {
      throw text::UsageError(fmt::format("--settings: '{}' {}", path_, *wrong));
    }
    try {
      add(toml::parse_file(path_), nullptr);
    } catch (const toml::parse_error& error) {
      fault(error.source(), error.description());
    }
    return std::move(settings_);
  }

 private:
  [[noreturn]] void fault(const toml::source_region& where, std::string_view text) const {
    throw text::UsageError(
        fmt::format("{}:{}:{}: {}", path_, where.begin.line, where.begin.column, text));
  }

  /// @param heading  the table's name; null: the file
  void add(const toml::table& table, const char* heading) {
    for (const auto& [key, node] : table) {
      const auto* inner = node.as_table();
      inner && !heading ? add(*inner, heading_of(key)) : add(key, node);
    }
  }

  const char* heading_of(const toml::key& key) const {
    std::vector<std::string> known;
    for (const run::OptionGroup& group : run::option_groups()) {
      if (key.str() == group.table) return group.table;
      known.emplace_back(group.table);
    }
    fault(key.source(),
          fmt::format("unknown table {}; {}", scene::in_quotes(key.str()),
                      text::advice(key.str(), known,
                                   fmt::format("known here: {}", fmt::join(known, ", ")))));
  }

  void add(const toml::key& key, const toml::node& node) {
    const run::Option* option = run::option_named(key.str());
    if (option == nullptr || option->place == run::Place::command_line) unknown(key);
    if (std::ranges::find(settings_, option, &FileSetting::option) != settings_.end()) {
      fault(key.source(), fmt::format("{} is given twice; leave out one", key.str()));
    }
    FileSetting setting{option, values_of(*option, node)};
    run::Options ignored;
    try {
      for (const std::string& value : setting.values) apply(*option, ignored, value);
    } catch (const text::UsageError& error) {
      fault(node.source(), error.what());
    }
    settings_.push_back(std::move(setting));
  }

  [[noreturn]] void unknown(const toml::key& key) const {
    std::vector<std::string> known;
    for (const run::OptionGroup& group : run::option_groups()) {
      for (const run::Option& option : group.options) {
        if (option.place != run::Place::command_line) known.emplace_back(option.name);
      }
    }
    fault(key.source(), fmt::format("unknown key {}; {}", scene::in_quotes(key.str()),
                                    text::advice(key.str(), known,
                                                 "keys are options without their dashes: "
                                                 "'ziggurat help run --all' lists them")));
  }

  std::vector<std::string> values_of(const run::Option& option, const toml::node& node) const {
    const auto* boolean = node.as_boolean();
    if (is_flag(option)) {
      if (!boolean) fault(node.source(), fmt::format("{} must be true or false", option.name));
      return boolean->get() ? std::vector<std::string>{""} : std::vector<std::string>{};
    }
    if (boolean && boolean->get() && option.implicit) return {option.implicit};
    const auto* list = node.as_array();
    if (!list) return {text_of(option, node)};
    if (!is_repeated(option)) fault(node.source(), fmt::format("{} has one value", option.name));
    std::vector<std::string> values;
    for (const toml::node& each : *list) values.push_back(text_of(option, each));
    return values;
  }

  /// A number or a text, as the command line has it.
  std::string text_of(const run::Option& option, const toml::node& node) const {
    std::string text;
    if (const auto* string = node.as_string()) text = string->get();
    if (const auto* whole = node.as_integer()) text = fmt::format("{}", whole->get());
    if (const auto* number = node.as_floating_point()) text = fmt::format("{}", number->get());
    if (!text.empty() && text.find('\0') == std::string::npos) return text;
    fault(node.source(), fmt::format("{} must be a number or a text in quotes{}", option.name,
                                     is_repeated(option) ? ", or a list of these" : ""));
  }

  const std::string& path_;
  std::vector<FileSetting> settings_;
};

}  // namespace

std::vector<FileSetting> read_settings_file(const std::string& path) {
  return SettingsReader(path).read();
}

}  // namespace ziggurat::cli
