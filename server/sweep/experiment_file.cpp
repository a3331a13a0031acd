// SPDX-License-Identifier: MIT
#include "sweep/experiment_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/files.h"
#include "scene/values.h"
#include "text/names.h"
#include "text/numbers.h"

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> known_keys = {"scene",   "seeds",      "out",      "jobs",
                                             "timeout", "ticks",      "duration", "record",
                                             "run",     "parameters", "axes"};

/// Reads one file; its messages name their places.
class FileReader {
 public:
  explicit FileReader(std::string path) : path_(std::move(path)) {}

  ExperimentFile read() {
    const toml::table table = parse();
    for (const auto& [key, node] : table) {
      if (std::ranges::find(known_keys, key.str()) != known_keys.end()) continue;
      fault(key.source(),
            fmt::format("unknown key {}; {}", scene::in_quotes(key.str()),
                        text::advice(key.str(), known_keys,
                                     fmt::format("known here: {}", fmt::join(known_keys, ", ")))));
    }
    ExperimentFile file;
    file.experiment.scene = scene_of(table);
    file.experiment.seeds = seeds_of(table);
    add_axes(table["parameters"], Axis::Kind::parameter, file.experiment);
    add_axes(table["axes"], Axis::Kind::setting, file.experiment);
    add_run_arguments(table, file.experiment.run_arguments);
    read_settings(table, file);
    return file;
  }

 private:
  [[noreturn]] void fault(const toml::source_region& where, std::string_view text) const {
    throw text::UsageError(
        fmt::format("{}:{}:{}: {}", path_, where.begin.line, where.begin.column, text));
  }

  toml::table parse() const {
    if (const auto wrong = scene::fault_of_file(path_)) {
      throw text::UsageError(
          fmt::format("'{}' {}; write the path of a scene or of an experiment file "
                      "(.toml)",
                      path_, *wrong));
    }
    try {
      return toml::parse_file(path_);
    } catch (const toml::parse_error& error) {
      fault(error.source(), error.description());
    }
  }

  /// A number, a text or true or false, as a scene file has it.
  std::string text_of(const toml::node& node) const {
    if (const auto* text = node.as_string()) {
      if (text->get().find('\0') == std::string::npos) return text->get();
      fault(node.source(), "a text must have no zero byte");
    }
    if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = node.as_floating_point()) {
      if (std::isfinite(number->get())) return fmt::format("{}", number->get());
      fault(node.source(), "a number must be finite");
    }
    if (const auto* boolean = node.as_boolean()) return boolean->get() ? "true" : "false";
    fault(node.source(), "a value must be a number, a text in quotes, true or false");
  }

  std::string in_folder(const toml::node& node) const {
    const std::string path = text_of(node);
    if (path.empty()) fault(node.source(), "the path is empty");
    return fs::absolute(fs::path(path_).parent_path() / path).lexically_normal().string();
  }

  std::string scene_of(const toml::table& table) const {
    const auto* node = table["scene"].node();
    if (node == nullptr) {
      throw text::UsageError(
          fmt::format("{}: there is no scene; write: scene = \"FILE.argos\"", path_));
    }
    if (!node->is_string()) fault(node->source(), "scene must be a path in quotes");
    return in_folder(*node);
  }

  std::vector<std::uint64_t> seeds_of(const toml::table& table) const {
    const auto* node = table["seeds"].node();
    if (node == nullptr) return {};
    std::vector<std::uint64_t> seeds;
    const auto add = [&](const toml::node& each) {
      const std::string text = text_of(each);
      try {
        const auto more = to_seeds("seeds", text);
        seeds.insert(seeds.end(), more.begin(), more.end());
      } catch (const text::UsageError& error) {
        fault(each.source(), error.what());
      }
    };
    if (const auto* list = node->as_array()) {
      for (const toml::node& each : *list) add(each);
    } else {
      add(*node);
    }
    return seeds;
  }

  /// In the order of their lines.
  void add_axes(const toml::node_view<const toml::node>& view, Axis::Kind kind,
                Experiment& experiment) const {
    if (!view) return;
    const auto* table = view.as_table();
    if (table == nullptr) fault(view.node()->source(), "must be a table: [parameters] or [axes]");
    std::vector<std::pair<toml::source_position, Axis>> found;
    for (const auto& [key, node] : *table) {
      Axis axis{kind, std::string(key.str()), {}};
      if (const auto* list = node.as_array()) {
        for (const toml::node& each : *list) axis.values.push_back(text_of(each));
      } else {
        axis.values.push_back(text_of(node));
      }
      if (axis.values.empty()) fault(key.source(), "has no values; write one or more");
      found.emplace_back(key.source().begin, std::move(axis));
    }
    std::ranges::sort(
        found, {}, [](const auto& each) { return std::pair(each.first.line, each.first.column); });
    for (auto& each : found) experiment.axes.push_back(std::move(each.second));
  }

  void add_run_arguments(const toml::table& table, std::vector<std::string>& arguments) const {
    for (const char* name : {"ticks", "duration"}) {
      const auto* node = table[name].node();
      if (node == nullptr) continue;
      if (!node->is_number()) fault(node->source(), fmt::format("{} must be a number", name));
      arguments.insert(arguments.end(), {fmt::format("--{}", name), text_of(*node)});
    }
    const auto* node = table["run"].node();
    if (node == nullptr) return;
    if (!node->is_array()) {
      fault(node->source(), "run must be a list of arguments: [\"--lua-processes\", \"2\"]");
    }
    for (const toml::node& each : *node->as_array()) arguments.push_back(text_of(each));
  }

  void read_settings(const toml::table& table, ExperimentFile& file) const {
    const auto number = [&](const char* name) -> std::optional<double> {
      const auto* node = table[name].node();
      if (node == nullptr) return std::nullopt;
      if (!node->is_number() || !std::isfinite(*node->value<double>()) ||
          *node->value<double>() <= 0) {
        fault(node->source(), fmt::format("{} must be a finite number above 0", name));
      }
      return node->value<double>();
    };
    if (const auto jobs = number("jobs")) {
      if (*jobs > 4096 || *jobs != static_cast<unsigned>(*jobs)) {
        fault(table["jobs"].node()->source(), "jobs must be a whole number from 1 to 4096");
      }
      file.jobs = static_cast<unsigned>(*jobs);
    }
    file.timeout = number("timeout");
    if (const auto* node = table["out"].node()) file.out = in_folder(*node);
    if (const auto* node = table["record"].node()) {
      file.record = text_of(*node);
      if (file.record != "failed" && file.record != "all") {
        fault(node->source(), "record must be \"failed\" or \"all\"");
      }
    }
  }

  std::string path_;
};

}  // namespace

ExperimentFile read_experiment(const std::string& path) { return FileReader(path).read(); }

}  // namespace ziggurat::sweep
