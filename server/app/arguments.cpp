#include "app/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options/errors.hpp>
#include <boost/program_options/parsers.hpp>
#include <boost/program_options/positional_options.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>

namespace ziggurat::app {
namespace {

namespace po = boost::program_options;

std::string unknown(const std::string& name, const po::options_description& known) {
  std::vector<std::string> names;
  for (const auto& option : known.options()) names.push_back("--" + option->long_name());
  const auto suggestion = closest(name, names);
  return fmt::format("unknown option '{}'{}", name,
                     suggestion.empty() ? "" : "; did you mean '" + suggestion + "'?");
}

// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  std::iota(cost[0].begin(), cost[0].end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1,
                             cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

// An option whose value may be left out takes the next word only if that is a number; left alone
// Boost takes any word.
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
    joined.back() += "=" + (has_value ? arguments[++i] : "1");
  }
  return joined;
}

}  // namespace

Parsed parse(const Arguments& arguments, const po::options_description& known) {
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
                  .run(),
              parsed.values);
  } catch (const po::unknown_option& error) {
    throw UsageError(unknown(error.get_option_name(), known));
  } catch (const po::multiple_occurrences& error) {
    throw UsageError(fmt::format("option '{}' is given more than once", error.get_option_name()));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  if (parsed.values.count("positional")) {
    parsed.positional = parsed.values["positional"].as<std::vector<std::string>>();
  }
  return parsed;
}

std::string closest(std::string_view word, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const bool begins = word.size() > 3 && candidate.starts_with(word);
    const std::size_t away = begins ? 1 : distance(word, candidate);
    if (away < best_distance) {
      best = &candidate;
      best_distance = away;
    }
  }
  return best ? *best : std::string();
}

std::uint64_t to_integer(std::string_view option, const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw UsageError(fmt::format("{} is '{}'; a whole number, not negative, is due", option, text));
  }
  return value;
}

double to_number(std::string_view option, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw UsageError(fmt::format("{} is '{}'; a finite number is due", option, text));
  }
  return value;
}

std::size_t to_size(std::string_view option, const std::string& text) {
  const auto place = text.empty() ? std::string::npos : std::string("KMG").find(text.back());
  const unsigned shift = place == std::string::npos ? 0 : 10 * (static_cast<unsigned>(place) + 1);
  const auto number = to_integer(option, shift ? text.substr(0, text.size() - 1) : text);
  if (number > (std::numeric_limits<std::size_t>::max() >> shift)) {
    throw UsageError(fmt::format("{} is '{}', which is too large", option, text));
  }
  return static_cast<std::size_t>(number) << shift;
}

}  // namespace ziggurat::app
