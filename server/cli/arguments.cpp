// SPDX-License-Identifier: MIT
#include "cli/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options/errors.hpp>
#include <boost/program_options/parsers.hpp>
#include <boost/program_options/positional_options.hpp>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "text/names.h"
#include "text/numbers.h"
#include "text/shortened.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

std::string unknown(const std::string& name, const po::options_description& known) {
  std::vector<std::string> names;
  for (const auto& option : known.options()) names.push_back("--" + option->long_name());
  return fmt::format("unknown option '{}'; {}", name,
                     text::advice(name, names, "--help lists the options"));
}

// The next word is a scene, or was meant as the factor.
void check_is_scene(const std::string& word) {
  std::error_code error;
  const bool looks_like_one = word.starts_with('-') || word.find_first_of("./") != word.npos;
  if (looks_like_one || std::filesystem::exists(word, error)) return;
  throw text::UsageError(
      fmt::format("--real-time takes a number, the factor of real time (1 if it is left out); '{}' "
                  "is none, and "
                  "no file has that name; write --real-time 2, for example, or --real-time=1 SCENE",
                  word));
}

// An option with an optional value takes the next word only if it is a number. Boost would take any
// word.
Arguments join_optional_values(const Arguments& arguments) {
  const auto is_number = [](const std::string& text) {
    char* end = nullptr;
    std::strtod(text.c_str(), &end);
    return end != text.c_str() && *end == '\0';
  };
  Arguments joined;
  bool options_ended = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    joined.push_back(arguments[i]);
    options_ended = options_ended || arguments[i] == "--";
    if (options_ended || arguments[i] != "--real-time") continue;
    const bool has_value = i + 1 < arguments.size() && is_number(arguments[i + 1]);
    if (!has_value && i + 1 < arguments.size()) check_is_scene(arguments[i + 1]);
    joined.back() += "=" + (has_value ? arguments[++i] : "1");
  }
  return joined;
}

// A number, or several with commas: a value and no option, though it begins with `-`.
std::vector<po::option> take_negative_number(Arguments& rest) {
  const std::string& word = rest.front();
  const bool is_number =
      word.size() > 1 && word[0] == '-' && (word[1] == '.' || (word[1] >= '0' && word[1] <= '9'));
  if (!is_number) return {};
  po::option value;
  value.value = value.original_tokens = {word};
  rest.erase(rest.begin());
  return {value};
}

/// Behind dashes of word processors at its beginning.
std::string_view without_typographic_dashes(std::string_view word) {
  constexpr std::string_view dashes[] = {"‐", "‑", "‒", "–", "—", "―", "−"};
  const auto begins_word = [&](std::string_view dash) { return word.starts_with(dash); };
  while (std::ranges::any_of(dashes, begins_word))
    word.remove_prefix(std::ranges::find_if(dashes, begins_word)->size());
  return word;
}

/// Refuses an option whose hyphens a word processor has made a dash: it would be taken for a file.
void check_hyphens(const Arguments& arguments, const po::options_description& known) {
  for (const std::string& word : arguments) {
    if (word == "--") return;
    const std::string_view rest = without_typographic_dashes(word);
    const std::string name(rest.substr(0, rest.find('=')));
    if (rest.size() == word.size() || name.empty() || known.find_nothrow(name, false) == nullptr)
      continue;
    throw text::UsageError(
        fmt::format("'{}' begins with a dash that is no hyphen; write --{}", word, rest));
  }
}

/// A value that is empty is that of a variable of a shell that is not set: without this an output
/// would not be written, or an endpoint not be protected, without a word.
void check_values(const po::variables_map& values, const po::options_description& known) {
  for (const auto& [name, value] : values) {
    const po::option_description* option = known.find_nothrow(name, false);
    if (option == nullptr || option->semantic()->min_tokens() == 0)
      continue;  // a file, or the value may be left out
    const auto* text = boost::any_cast<std::string>(&value.value());
    const auto* texts = boost::any_cast<std::vector<std::string>>(&value.value());
    const bool is_empty =
        (text && text->empty()) || (texts && std::ranges::find(*texts, "") != texts->end());
    if (is_empty)
      throw text::UsageError(
          fmt::format("the value of --{0} is empty; write --{0} VALUE, or leave it out", name));
  }
}

}  // namespace

Parsed parse(const Arguments& arguments, const po::options_description& known) {
  check_hyphens(arguments, known);
  po::options_description all;
  all.add(known).add_options()("positional", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("positional", -1);
  Parsed parsed;
  try {
    const auto style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(join_optional_values(arguments))
                  .options(all)
                  .positional(positional)
                  .style(style)
                  .extra_style_parser(take_negative_number)
                  .run(),
              parsed.values);
    check_values(parsed.values, known);
  } catch (const po::unknown_option& error) {
    throw text::UsageError(unknown(error.get_option_name(), known));
  } catch (const po::multiple_occurrences& error) {
    throw text::UsageError(
        fmt::format("option '{}' is given more than once", error.get_option_name()));
  } catch (const po::invalid_command_line_syntax& error) {
    if (error.kind() != error.missing_parameter) throw text::UsageError(error.what());
    throw text::UsageError(
        fmt::format("option '{0}' needs a value; write {0} VALUE", error.get_option_name()));
  } catch (const po::error& error) {
    throw text::UsageError(error.what());
  }
  if (parsed.values.count("positional")) {
    parsed.positional = parsed.values["positional"].as<std::vector<std::string>>();
  }
  return parsed;
}

void check_needs(const Values& values, std::initializer_list<const char*> options,
                 const char* other) {
  for (const char* option : options) {
    if (!values.has(option) || values.has(other)) continue;
    throw text::UsageError(fmt::format(
        "--{0} has no effect without --{1}; write --{1} too, or leave it out", option, other));
  }
}

void check_apart(const Values& values, const char* other,
                 std::initializer_list<const char*> options) {
  for (const char* option : options) {
    if (!values.has(option) || !values.has(other)) continue;
    throw text::UsageError(
        fmt::format("--{} has no effect with --{}; leave out one of them", option, other));
  }
}

std::vector<std::string> first_of(const std::vector<std::pair<std::string, std::string>>& pairs) {
  std::vector<std::string> names;
  for (const auto& [name, value] : pairs) names.push_back(name);
  return names;
}

void check_once(const char* option, std::vector<std::string> subjects) {
  std::ranges::sort(subjects);
  const auto twice = std::ranges::adjacent_find(subjects);
  if (twice == subjects.end()) return;
  throw text::UsageError(fmt::format(
      "{} is given twice for {}, and only one of them would have an effect; leave out one", option,
      twice->empty() ? "all" : "'" + text::shortened(*twice) + "'"));
}

const std::string& only_recording(std::string_view command,
                                  const std::vector<std::string>& positional) {
  if (positional.size() == 1) return positional.front();
  if (positional.empty()) {
    throw text::UsageError(fmt::format(
        "no recording is given; write the file of 'ziggurat run --record', as in: ziggurat {} "
        "run.mcap",
        command));
  }
  throw text::UsageError(fmt::format("only one recording is allowed, which is '{}'; remove '{}'",
                                     positional[0], positional[1]));
}

}  // namespace ziggurat::cli
