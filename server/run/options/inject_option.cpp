// SPDX-License-Identifier: MIT
#include "run/options/inject_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "run/options/controller_option.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

using network::Direction;
using network::Disturbance;

constexpr double longest_s = 10;  // longest delay of a message

[[noreturn]] void refuse_injection(const std::string& value, const std::string& why) {
  throw text::UsageError(
      fmt::format("--inject is '{}': {}; write for example latency=5ms,jitter=2ms,loss=1% or "
                  "CONTROLLER=commands:loss=5%",
                  value, why));
}

struct Quantity {
  double number = 0;
  std::string unit;
};

Quantity to_quantity(const std::string& value, const std::string& text) {
  Quantity quantity;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), quantity.number);
  if (error != std::errc() || !(quantity.number >= 0) || !std::isfinite(quantity.number)) {
    refuse_injection(value, fmt::format("'{}' must begin with a number from 0 on", text));
  }
  quantity.unit.assign(end, text.data() + text.size());
  return quantity;
}

std::chrono::nanoseconds to_time(const std::string& value, const std::string& text) {
  const Quantity quantity = to_quantity(value, text);
  const auto unit = text::seconds_in(quantity.unit);
  if (!unit) refuse_injection(value, fmt::format("'{}' must be a time in us, ms or s", text));
  const double seconds = quantity.number * *unit;
  if (seconds > longest_s) refuse_injection(value, fmt::format("{} is more than 10 s", text));
  return std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

double to_share(const std::string& value, const std::string& text) {
  const Quantity quantity = to_quantity(value, text);
  if (quantity.unit != "%" || quantity.number > 100) {
    refuse_injection(value, fmt::format("'{}' must be a share from 0% to 100%", text));
  }
  return quantity.number / 100;
}

constexpr std::array<std::string_view, 3> names{"latency", "jitter", "loss"};
constexpr std::array<std::pair<std::string_view, Direction>, 2> directions{
    {{"observations:", Direction::observations}, {"commands:", Direction::commands}}};

/// Removes `NAME=VALUE` from the end of the text. Read from the end, an id may contain any
/// character.
std::pair<std::string_view, std::string> take_last(const std::string& value, std::string& text) {
  const auto equals = text.rfind('=');
  if (equals == std::string::npos) refuse_injection(value, fmt::format("'{}' has no value", text));
  const std::string amount = text.substr(equals + 1);
  text.resize(equals);
  for (const std::string_view name : names) {
    if (!text.ends_with(name)) continue;
    const std::string_view before = std::string_view(text).substr(0, text.size() - name.size());
    if (!before.empty() && std::string_view(",:=").find(before.back()) == std::string_view::npos)
      continue;
    text.resize(before.size());
    return {name, amount};
  }
  const auto begin = text.find_last_of(",:=");
  refuse_injection(value, fmt::format("'{}' is unknown; known are latency, jitter and loss",
                                      begin == std::string::npos ? text : text.substr(begin + 1)));
}

/// Reads the part before the values: `[CONTROLLER=][DIRECTION:]`.
void read_subject(const std::string& value, std::string text, InjectOption& option) {
  for (const auto& [name, direction] : directions) {
    if (!text.ends_with(name)) continue;
    option.direction = direction;
    text.resize(text.size() - name.size());
    break;
  }
  if (text.empty()) return;
  if (text.back() != '=') {
    refuse_injection(value,
                     fmt::format("'{}' must be observations:, commands: or CONTROLLER=", text));
  }
  text.pop_back();
  if (text.empty()) refuse_injection(value, "there is no controller before the =");
  option.controller = std::move(text);
}

void inject(const InjectOption& option, network::Injection& injection) {
  if (option.direction != Direction::commands) injection.observations = option.disturbance;
  if (option.direction != Direction::observations) injection.commands = option.disturbance;
}

}  // namespace

InjectOption to_injection(const std::string& value) {
  InjectOption option;
  std::string rest = value;
  std::array<bool, names.size()> is_given{};
  for (;;) {
    const auto [name, amount] = take_last(value, rest);
    const auto index = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    if (std::exchange(is_given[index], true))
      refuse_injection(value, fmt::format("{} is given twice", name));
    if (name == "latency") option.disturbance.latency = to_time(value, amount);
    if (name == "jitter") option.disturbance.jitter = to_time(value, amount);
    if (name == "loss") option.disturbance.loss = to_share(value, amount);
    if (!rest.ends_with(',')) break;
    rest.pop_back();
  }
  read_subject(value, std::move(rest), option);
  if (option.disturbance.jitter > option.disturbance.latency) {
    refuse_injection(value, "the jitter must not be more than the latency");
  }
  return option;
}

std::vector<network::Injection> injections_of(const std::vector<InjectOption>& options,
                                              const scene::Scene& scene) {
  std::vector<network::Injection> injections(scene.controllers.size() + scene.directors.size());
  apply_by_awaited("--inject", options, scene, [&](const InjectOption& option, std::size_t i) {
    inject(option, injections[i]);
  });
  return injections;
}

void check_losses(const std::vector<network::Injection>& injections, const scene::Scene& scene,
                  const std::vector<network::Config::Deadline>& deadlines) {
  for (std::size_t c = 0; c < injections.size(); ++c) {
    const bool loses = injections[c].observations.loss > 0 || injections[c].commands.loss > 0;
    if (!loses || deadlines[c].policy.action != scene::DeadlineAction::wait) continue;
    throw text::UsageError(fmt::format(
        "--inject loses messages of {0} '{1}', for which the world would "
        "wait forever; add --hil, or --deadline '{1}=hold:50'",
        c < scene.controllers.size() ? "controller" : "director", ids_of_awaited(scene)[c]));
  }
}

}  // namespace ziggurat::run
