// Controls a run from another terminal.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/supervision_client.h"
#include "reports/console.h"
#include "scene/files.h"
#include "scene/values.h"
#include "text/names.h"
#include "text/numbers.h"
#include "ziggurat/error.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description ctl_options() {
  po::options_description options("Options", 96);
  options.add_options()("seed", po::value<std::string>()->value_name("N"),
                        "with reset: the new seed; without it the seed stays")(
      "json", "print answers as JSON")(
      "reason", po::value<std::string>()->value_name("TEXT"),
      "with shutdown: the end is planned; the run's exit code is 0, and its summary has TEXT");
  add_key_options(options);
  return options;
}

struct Call {
  Supervisor& server;
  reports::Console& console;
  std::vector<std::string> words;  ///< after the verb
  po::variables_map values;
};

void print_result(const Call& call, std::string_view done, std::uint64_t tick) {
  if (call.values.count("json") > 0) {
    call.console.result(fmt::format(R"({{"tick":{}}})", tick));
  } else {
    call.console.result(fmt::format("{} at tick {}", done, tick));
  }
}

void print_status(const Call& call) {
  const ServerStatus status = call.server.status();
  const bool json = call.values.count("json") > 0;
  call.console.result(json ? call.server.last_answer_json() : to_text(status));
}

void pause(const Call& call) { print_result(call, "paused", call.server.pause()); }
void resume(const Call& call) { print_result(call, "resumed", call.server.resume()); }

void step(const Call& call) {
  const std::uint64_t ticks = call.words.empty() ? 1 : text::to_integer("step", call.words[0]);
  print_result(call, "paused", call.server.step(ticks));
}

void reset(const Call& call) {
  const auto seed = call.values.find("seed");
  if (seed == call.values.end()) {
    call.server.reset();
  } else {
    call.server.reset(text::to_integer("--seed", seed->second.as<std::string>()));
  }
  print_result(call, "reset", 0);
}

void snapshot(const Call& call) { print_result(call, "kept", call.server.snapshot(call.words[0])); }

void restore(const Call& call) {
  print_result(call, "restored", call.server.restore(call.words[0]));
}

std::string contents_of(const std::string& path) {
  if (path == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  if (const auto fault = scene::fault_of_file(path)) {
    throw text::UsageError("'" + path + "' " + *fault + ", or write - to read from standard input");
  }
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void spawn(const Call& call) {
  print_result(call, "spawned", call.server.spawn(contents_of(call.words[0])));
}

void remove(const Call& call) { print_result(call, "removed", call.server.remove(call.words[0])); }

void move(const Call& call) {
  std::array<double, 3> position{};
  text::to_numbers("position", call.words[1], "x,y,z in metres, as 1,-1,0.5", position);
  std::optional<std::array<double, 4>> orientation;
  if (call.words.size() == 3) {
    math::Vector3 angles;
    text::to_numbers("orientation", call.words[2], "turns about z,y,x in degrees, as 90,0,0", {angles.data(), 3});
    const math::Quaternion turned = scene::orientation_from_degrees(angles);
    orientation = {turned.w(), turned.x(), turned.y(), turned.z()};
  }
  print_result(call, "moved", call.server.move(call.words[0], position, orientation));
}

// To four decimals, without the sign of what is rounded to zero.
double shown(double value) { return std::abs(value) < 0.5e-4 ? 0.0 : value; }

void read(const Call& call) {
  const WorldStates states = call.server.read(call.words);
  if (call.values.count("json") > 0) {
    return call.console.result(call.server.last_answer_json());
  }
  call.console.result(fmt::format("tick {}, hash {}", states.tick, states.hash));
  for (const EntityState& entity : states.entities) {
    const auto& p = entity.position;
    const auto& q = entity.orientation;
    call.console.result(
        fmt::format("{:<20} {:9.4f} {:9.4f} {:9.4f} m   {:7.4f} {:7.4f} {:7.4f} {:7.4f}", entity.id,
                    shown(p[0]), shown(p[1]), shown(p[2]), shown(q[0]), shown(q[1]), shown(q[2]),
                    shown(q[3])));
  }
}

void shutdown(const Call& call) {
  const auto reason = call.values.find("reason");
  call.server.shutdown(reason == call.values.end() ? "" : reason->second.as<std::string>());
}

struct Verb {
  std::string_view name;
  std::string_view words;   ///< after the name, for messages
  std::size_t least, most;  ///< how many
  std::string_view summary;
  void (*execute)(const Call&);
};

constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

constexpr Verb verbs[] = {
    {"status", "", 0, 0, "the controllers that the world waits for, and how long", print_status},
    {"pause", "", 0, 0, "stop between two ticks; returns when the world has stopped", pause},
    {"resume", "", 0, 0, "continue", resume},
    {"step", "[TICKS]", 0, 1, "advance a paused world, by 1 tick if TICKS is missing", step},
    {"reset", "[--seed N]", 0, 0, "build the world again; controllers are told", reset},
    {"snapshot", "NAME", 1, 1, "keep the world under this name", snapshot},
    {"restore", "NAME", 1, 1, "go back to what was kept; controllers are told", restore},
    {"spawn", "FILE|-", 1, 1, "add an entity: one element, as in <arena>", spawn},
    {"remove", "ENTITY", 1, 1, "remove it from the world", remove},
    {"move", "ENTITY x,y,z [z,y,x]", 2, 3,
     "put it at rest there [m], with this orientation [degrees]; the place need not be free: what overlaps is pushed "
     "apart",
     move},
    {"read", "[ID|GLOB]...", 0, any_number, "poses of entities: x y z, and the quaternion w x y z",
     read},
    {"shutdown", "[--reason TEXT]", 0, 0, "end the run, as Ctrl-C does; with a reason as planned",
     shutdown},
};

const Verb& verb_named(const std::string& name) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    if (verb.name == name) return verb;
    names.emplace_back(verb.name);
  }
  throw text::UsageError(fmt::format("ctl: there is no request '{}'; {}", name,
                                     text::advice(name, names, "'ziggurat help ctl' lists them")));
}

}  // namespace

std::string help_ctl() {
  std::ostringstream text;
  text << R"(usage: ziggurat ctl [URL] REQUEST [ARGUMENT]...

Controls a run of `ziggurat run --endpoint URL` or `ziggurat serve` from another terminal. Requests are
carried out between two ticks; the command returns when its request is done. Without URL it is that of
ZIGGURAT_ENDPOINT, or the only server that runs here.

)";
  for (const Verb& verb : verbs) {
    text << fmt::format("  {:<9} {}{}{}\n", verb.name, verb.words, verb.words.empty() ? "" : "  ",
                        verb.summary);
  }
  text << R"(
  ziggurat ctl pause
  ziggurat ctl step 10
  ziggurat ctl tcp://127.0.0.1:5770 read 'block*' --json
  echo '<box id="b" size=".1,.1,.1" movable="true" mass="1"><body position="0,0,1"/></box>' |
      ziggurat ctl spawn -

Exit codes: 0 the request was done; 1 it was not.

)" << ctl_options();
  return text.str();
}

int execute_ctl(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, ctl_options());
  std::vector<std::string> words = parsed.positional;
  const bool has_endpoint = !words.empty() && words.front().find("://") != std::string::npos;
  if (words.size() < (has_endpoint ? 2 : 1)) {
    throw text::UsageError(
        "write: ziggurat ctl [URL] REQUEST   ('ziggurat help ctl' lists the requests)");
  }
  const Verb& verb = verb_named(words[has_endpoint ? 1 : 0]);
  std::vector<std::string> where(words.begin(), words.begin() + (has_endpoint ? 1 : 0));
  words.erase(words.begin(), words.begin() + (has_endpoint ? 2 : 1));
  if (words.size() < verb.least || words.size() > verb.most) {
    throw text::UsageError(fmt::format("write: ziggurat ctl [URL] {}{}{}", verb.name,
                                       verb.words.empty() ? "" : " ", verb.words));
  }
  if (parsed.values.count("seed") > 0 && verb.name != "reset") {
    throw text::UsageError(fmt::format("--seed is for reset; remove it from {}", verb.name));
  }
  if (const auto reason = parsed.values.find("reason"); reason != parsed.values.end()) {
    if (verb.name != "shutdown") {
      throw text::UsageError(fmt::format("--reason is for shutdown; remove it from {}", verb.name));
    }
    if (reason->second.as<std::string>().empty()) {
      throw text::UsageError("--reason is empty; write why the run ends, or leave it out");
    }
  }
  const std::string endpoint = take_endpoint(where);
  reports::Console console;
  const auto server = connect(supervisor_options(endpoint, parsed.values, false, "ziggurat ctl"), console);
  verb.execute({*server, console, words, parsed.values});
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
