// SPDX-License-Identifier: MIT
#include "rerun/divergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string_view>
#include <tuple>
#include <unordered_map>

#include "math/hash.h"
#include "recording/replay/message_difference.h"
#include "recording/replay/names.h"
#include "reports/json_text.h"
#include "reports/plot.h"

namespace ziggurat::rerun {
namespace {

constexpr std::size_t most_rows = 20;      // of the table
constexpr std::size_t most_points = 1000;  // of a curve
constexpr std::size_t most_states =
    std::size_t{1} << 20;  // that are kept: a small file may have a hundred million

using Links = std::vector<world::LinkState>;

/// Which of `from` stands at each place of `to`; empty: the same places.
std::vector<std::size_t> places(const std::vector<std::string>& to,
                                const std::vector<std::string>& from) {
  const std::size_t both = std::min(to.size(), from.size());
  if (std::equal(to.begin(), to.begin() + static_cast<std::ptrdiff_t>(both), from.begin()))
    return {};
  std::unordered_map<std::string_view, std::size_t> known;
  for (std::size_t i = 0; i < from.size(); ++i) known.emplace(from[i], i);
  std::vector<std::size_t> found;
  for (const std::string& name : to) {
    const auto place = known.find(name);
    found.push_back(place == known.end() ? from.size() : place->second);
  }
  return found;
}

/// One recording, inputs by inputs.
struct Side {
  explicit Side(const replay::RecordingFile& file) : states(file) {}

  const v1::Inputs* next() {
    const v1::Inputs* inputs = states.next();
    if (inputs && inputs->has_commands()) replay::take_over(inputs->commands(), commands);
    return inputs;
  }

  replay::States states;
  v1::Commands commands;  ///< all that hold
};

/// Reads two recordings side by side.
class Comparison {
 public:
  Comparison(const replay::RecordingFile& a, const replay::RecordingFile& b)
      : a_(a), b_(b), names_b_(replay::link_names(b)) {
    result_.path_a = a.path();
    result_.path_b = b.path();
    result_.names = replay::link_names(a);
    places_ = places(result_.names, names_b_);
  }

  Divergence run() {
    const v1::Inputs* a = a_.next();
    const v1::Inputs* b = b_.next();
    const auto key = [](const v1::Inputs& of) { return std::tuple(of.epoch(), of.tick()); };
    while (a && b) {
      if (key(*a) == key(*b)) {
        compare(*a, *b);
        a = a_.next();
        b = b_.next();
      } else if (key(*a) < key(*b)) {
        ++result_.only_a;
        a = a_.next();
      } else {
        ++result_.only_b;
        b = b_.next();
      }
    }
    for (; a; a = a_.next()) ++result_.only_a;
    for (; b; b = b_.next()) ++result_.only_b;
    return std::move(result_);
  }

 private:
  void compare(const v1::Inputs& a, const v1::Inputs& b) {
    ++result_.compared;
    const std::string when = fmt::format(
        "tick {}{}", a.tick(), a.epoch() > 0 ? fmt::format(" of epoch {}", a.epoch()) : "");
    if (!result_.first_state && a.hash() != b.hash()) {
      result_.first_state = fmt::format("{}: {} (hash {} and {})", when, first_field(),
                                        math::to_hex(a.hash()), math::to_hex(b.hash()));
    }
    if (!result_.first_inputs) compare_inputs(a, b, when);
    if (!a_.states.links() || !b_.states.links()) return;
    keep({a.epoch(), a.tick(), static_cast<double>(a_.states.log_time()) / 1e9,
          replay::distance(*a_.states.links(), aligned())});
  }

  /// All of them; of very many each second, fourth, and so on.
  void keep(const Divergence::State& state) {
    auto& states = result_.states;
    if (states.size() == most_states) {
      for (std::size_t i = 0; i < states.size() / 2; ++i) states[i] = states[2 * i];
      states.resize(states.size() / 2);
      stride_ *= 2;
    }
    if (seen_++ % stride_ == 0) states.push_back(state);
  }

  void compare_inputs(const v1::Inputs& a, const v1::Inputs& b, const std::string& when) {
    v1::Inputs of_a = a, of_b = b;
    if (a.has_commands() && b.has_commands()) {
      *of_a.mutable_commands() = a_.commands;
      *of_b.mutable_commands() = b_.commands;
    }
    for (v1::Inputs* each : {&of_a, &of_b}) {
      if (a.has_commands() !=
          b.has_commands()) {  // one of them ended here, before what was done next
        each->clear_commands();
        each->clear_metrics();
        each->clear_acts();
      }
      each->clear_hash();
      for (auto* acts : {each->mutable_acts(), each->mutable_acts_before()}) {
        for (v1::Act& act : *acts) act.clear_wall_ns();
      }
    }
    const auto found = replay::first_difference(of_a, of_b);
    if (!found) return;
    result_.first_inputs =
        fmt::format("{}: {} is {} in A, {} in B", when, found->field, found->a, found->b);
  }

  std::string first_field() {
    if (!a_.states.links() || !b_.states.links()) return "exact poses are not recorded in both";
    const auto found = replay::first_difference(*a_.states.links(), aligned());
    if (!found) return "poses and velocities are the same; what robots sense or show differs";
    return fmt::format("{}: {} is {} in A, {} in B", replay::name_of(result_.names, found->link),
                       found->field, found->a, found->b);
  }

  /// The links of B at the places of A's.
  const Links& aligned() {
    if (places_.empty()) return *b_.states.links();
    aligned_ = *a_.states.links();  // what B lacks is no difference
    for (std::size_t i = 0; i < std::min(aligned_.size(), places_.size()); ++i) {
      if (places_[i] < b_.states.links()->size()) aligned_[i] = (*b_.states.links())[places_[i]];
    }
    return aligned_;
  }

  Side a_, b_;
  std::vector<std::string> names_b_;
  std::vector<std::size_t> places_;
  Links aligned_;
  std::size_t seen_ = 0, stride_ = 1;  ///< of the states that are kept
  Divergence result_;
};

/// About so many of them, the last one included.
std::vector<const Divergence::State*> some(const std::vector<Divergence::State>& states,
                                           std::size_t most) {
  std::vector<const Divergence::State*> chosen;
  const std::size_t step = std::max<std::size_t>(1, (states.size() + most - 1) / most);
  for (std::size_t i = 0; i < states.size(); i += step) chosen.push_back(&states[i]);
  if (!states.empty() && chosen.back() != &states.back()) chosen.push_back(&states.back());
  return chosen;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace

Divergence compare(const replay::RecordingFile& a, const replay::RecordingFile& b) {
  return Comparison(a, b).run();
}

std::string to_text(const Divergence& of) {
  std::string text = fmt::format("A  {}\nB  {}\n", of.path_a, of.path_b);
  if (of.is_same() && !of.first_inputs)
    return text + fmt::format("identical: {} states\n", of.compared);
  text += of.first_state ? fmt::format("first difference   {}\n", *of.first_state)
                         : fmt::format("identical in the {} states that both have\n", of.compared);
  if (of.first_inputs) text += fmt::format("first other input  {}\n", *of.first_inputs);
  if (of.only_a + of.only_b > 0) {
    text += fmt::format("states only in A: {}, only in B: {}\n", of.only_a, of.only_b);
  }
  if (!of.first_state || of.states.empty()) return text;
  text += fmt::format("\n{:>9} {:>10} {:>13} {:>13} {:>9}  farthest\n", "tick", "time [s]",
                      "greatest [m]", "mean [m]", "turned [°]");
  for (const Divergence::State* state : some(of.states, most_rows)) {
    const replay::Distance& apart = state->apart;
    text += fmt::format("{:>9} {:>10.3f} {:>13.3e} {:>13.3e} {:>9.2e}  {}\n", state->tick,
                        state->time_s, apart.greatest, apart.mean, degrees(apart.angle),
                        apart.greatest > 0 ? replay::name_of(of.names, apart.link) : "");
  }
  return text;
}

std::string to_json(const Divergence& of) {
  nlohmann::ordered_json json{
      {"a", of.path_a},          {"b", of.path_b},      {"identical", of.is_same()},
      {"compared", of.compared}, {"only_a", of.only_a}, {"only_b", of.only_b}};
  if (of.first_state) json["first_state"] = *of.first_state;
  if (of.first_inputs) json["first_inputs"] = *of.first_inputs;
  json["distances"] = nlohmann::ordered_json::array();
  for (const Divergence::State* state : some(of.states, most_points)) {
    json["distances"].push_back({{"epoch", state->epoch},
                                 {"tick", state->tick},
                                 {"time_s", state->time_s},
                                 {"greatest_m", state->apart.greatest},
                                 {"mean_m", state->apart.mean},
                                 {"angle_rad", state->apart.angle},
                                 {"farthest", replay::name_of(of.names, state->apart.link)}});
  }
  return reports::json_text(json);
}

std::string to_svg(const Divergence& of) {
  reports::Panel panel;
  panel.title = "how far links are apart";
  panel.x_label = "simulated time [s]";
  panel.y_label = "distance [m]";
  panel.curves = {{.name = "the farthest link", .color = "#c1272d", .y = {}},
                  {.name = "mean of all links", .color = "#0050a0", .dashed = true, .y = {}}};
  for (const Divergence::State* state : some(of.states, most_points)) {
    if (state->time_s <= 0) continue;
    panel.x.push_back(state->time_s);
    panel.curves[0].y.push_back(state->apart.greatest);
    panel.curves[1].y.push_back(state->apart.mean);
  }
  return reports::to_svg("A: " + of.path_a + "\nB: " + of.path_b, {panel});
}

}  // namespace ziggurat::rerun
