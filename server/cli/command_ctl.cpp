// SPDX-License-Identifier: MIT
// Controls a run from another terminal.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/supervision_client.h"
#include "reports/console.h"
#include "scene/files.h"
#include "scene/values.h"
#include "simulation/snapshot.h"
#include "text/names.h"
#include "text/numbers.h"
#include "text/shortened.h"
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
      "with shutdown: the end is planned; the run's exit code is 0, and its summary has TEXT")(
      "may-overlap", "with move: also onto others, which are pushed apart");
  add_key_options(options);
  return options;
}

/// Words and values of the command line.
struct Given {
  std::vector<std::string> words;  ///< after the verb
  Values values;
};

struct Call {
  Supervisor& server;
  reports::Console& console;
  bool as_json;
};

/// Request to the server. Its words were checked before: a wrong one is told also if no server is
/// there.
using Request = std::function<void(const Call&)>;

void print_result(const Call& call, std::string_view done, std::uint64_t tick) {
  if (call.as_json) {
    call.console.result(fmt::format(R"({{"tick":{}}})", tick));
  } else {
    call.console.result(fmt::format("{} at tick {}", done, tick));
  }
}

Request status(const Given&) {
  return [](const Call& call) {
    const ServerStatus status = call.server.status();
    call.console.result(call.as_json ? call.server.last_answer_json() : to_text(status));
  };
}

Request pause(const Given&) {
  return [](const Call& call) { print_result(call, "paused", call.server.pause()); };
}

Request resume(const Given&) {
  return [](const Call& call) { print_result(call, "resumed", call.server.resume()); };
}

Request step(const Given& given) {
  const std::uint64_t ticks = given.words.empty() ? 1 : text::to_integer("step", given.words[0]);
  if (ticks == 0) throw text::UsageError("step is 0; write 1 or more ticks");
  return [ticks](const Call& call) { print_result(call, "paused", call.server.step(ticks)); };
}

Request reset(const Given& given) {
  std::optional<std::uint64_t> seed;
  if (given.values.has("seed")) seed = text::to_integer("--seed", given.values.text("seed"));
  return [seed](const Call& call) {
    call.server.reset(seed);
    print_result(call, "reset", 0);
  };
}

std::string snapshot_name(const Given& given) {
  const std::string& name = given.words[0];
  if (const auto why = simulation::fault_of_snapshot_name(name)) {
    throw text::UsageError(fmt::format("{}; '{}' is none", *why, text::shortened(name)));
  }
  return name;
}

Request snapshot(const Given& given) {
  return [name = snapshot_name(given)](const Call& call) {
    print_result(call, "kept", call.server.snapshot(name));
  };
}

Request restore(const Given& given) {
  return [name = snapshot_name(given)](const Call& call) {
    print_result(call, "restored", call.server.restore(name));
  };
}

/// No more than the server takes: a device may have no end.
std::string element_of(std::istream& from, std::string_view name) {
  std::string text;
  for (char block[65536]; from.read(block, sizeof block) || from.gcount() > 0;) {
    text.append(block, static_cast<std::size_t>(from.gcount()));
    if (text.size() <= simulation::longest_spawned) continue;
    throw text::UsageError(fmt::format(
        "{} has more than {} bytes, the most that an element may have; write one entity, and spawn "
        "others by further requests",
        name, simulation::longest_spawned));
  }
  return text;
}

std::string contents_of(const std::string& path) {
  if (path == "-") return element_of(std::cin, "standard input");
  if (const auto fault = scene::fault_of_file(path)) {
    throw text::UsageError("'" + path + "' " + *fault + ", or write - to read from standard input");
  }
  std::ifstream file(path, std::ios::binary);
  return element_of(file, "'" + path + "'");
}

Request spawn(const Given& given) {
  return [xml = contents_of(given.words[0])](const Call& call) {
    print_result(call, "spawned", call.server.spawn(xml));
  };
}

Request remove(const Given& given) {
  return [entity = given.words[0]](const Call& call) {
    print_result(call, "removed", call.server.remove(entity));
  };
}

/// Words 1 and 2, which may be missing.
struct TargetPose {
  std::array<double, 3> position{};
  std::optional<std::array<double, 4>> orientation;
};

TargetPose pose_of(const Given& given) {
  TargetPose pose;
  text::to_numbers("position", given.words[1], "x,y,z in metres, as 1,-1,0.5", pose.position);
  if (given.words.size() == 3) {
    math::Vector3 angles;
    text::to_numbers("orientation", given.words[2], "turns about z,y,x in degrees, as 90,0,0",
                     {angles.data(), 3});
    const math::Quaternion turned = scene::orientation_from_degrees(angles);
    pose.orientation = {turned.w(), turned.x(), turned.y(), turned.z()};
  }
  return pose;
}

Request move(const Given& given) {
  const Onto onto = given.values.has("may-overlap") ? Onto::others : Onto::free_place;
  return [entity = given.words[0], pose = pose_of(given), onto](const Call& call) {
    print_result(call, "moved", call.server.move(entity, pose.position, pose.orientation, onto));
  };
}

Request set_joint(const Given& given) {
  double position = 0, velocity = 0;
  text::to_numbers("position", given.words[2], "a number in metres or radians, as 0.5",
                   {&position, 1});
  if (given.words.size() == 4) {
    text::to_numbers("velocity", given.words[3], "a number in m/s or rad/s, as -1", {&velocity, 1});
  }
  return [entity = given.words[0], joint = given.words[1], position, velocity](const Call& call) {
    print_result(call, "set", call.server.set_joint(entity, joint, position, velocity));
  };
}

Request is_free(const Given& given) {
  return [what = given.words[0], pose = pose_of(given)](const Call& call) {
    const auto overlapped = call.server.overlapped(what, pose.position, pose.orientation);
    if (call.as_json) {
      call.console.result(
          nlohmann::ordered_json{{"free", !overlapped}, {"overlapped", overlapped.value_or("")}}
              .dump());
    } else {
      call.console.result(overlapped ? fmt::format("not free: '{}' is there", *overlapped)
                                     : "free");
    }
  };
}

// To four decimals, without the sign of what is rounded to zero.
double shown(double value) { return std::abs(value) < 0.5e-4 ? 0.0 : value; }

void print_states(const Call& call, const WorldStates& states) {
  if (call.as_json) {
    return call.console.result(call.server.last_answer_json());
  }
  call.console.result(fmt::format("tick {}, hash {}", states.tick, states.hash));
  for (const EntityState& entity : states.entities) {
    const auto& p = entity.position;
    const auto& q = entity.orientation;
    call.console.result(fmt::format(
        "{:<20} {:9.4f} {:9.4f} {:9.4f} m   {:7.4f} {:7.4f} {:7.4f} {:7.4f}", entity.id,
        shown(p[0]), shown(p[1]), shown(p[2]), shown(q[0]), shown(q[1]), shown(q[2]), shown(q[3])));
  }
}

Request read(const Given& given) {
  return [patterns = given.words](const Call& call) {
    print_states(call, call.server.read(patterns));
  };
}

Request shutdown(const Given& given) {
  return [reason = given.values.text("reason")](const Call& call) { call.server.shutdown(reason); };
}

struct Verb {
  std::string_view name;
  std::string_view words;   ///< after the name, for messages
  std::size_t least, most;  ///< how many
  std::string_view summary;
  Request (*read)(const Given&);  ///< @throws text::UsageError
};

constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

constexpr Verb verbs[] = {
    {"status", "", 0, 0, "the controllers that the world waits for, and how long", status},
    {"pause", "", 0, 0, "stop between two ticks; returns when the world has stopped", pause},
    {"resume", "", 0, 0, "continue", resume},
    {"step", "[TICKS]", 0, 1, "advance a paused world, by 1 tick if TICKS is missing", step},
    {"reset", "[--seed N]", 0, 0, "build the world again; controllers are told", reset},
    {"snapshot", "NAME", 1, 1, "keep the world under this name", snapshot},
    {"restore", "NAME", 1, 1, "go back to what was kept; controllers are told", restore},
    {"spawn", "FILE|-", 1, 1, "add an entity: one element, as in <arena>", spawn},
    {"remove", "ENTITY", 1, 1, "remove it from the world", remove},
    {"move", "ENTITY x,y,z [z,y,x]", 2, 3,
     "put it at rest there [m], with this orientation [degrees], if the place is free; "
     "--may-overlap: also if not",
     move},
    {"set-joint", "ENTITY JOINT POSITION [VELOCITY]", 3, 4,
     "put a revolute or prismatic joint there [rad, m], with this velocity [rad/s, m/s]; what "
     "hangs on it follows",
     set_joint},
    {"is-free", "ENTITY|XML x,y,z [z,y,x]", 2, 3,
     "whether it would overlap nothing there; XML is one element, as '<box size=\"1,1,1\"/>'",
     is_free},
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
  const Given given{std::move(words), Values(parsed.values)};
  for (const auto& [option, of] : {std::pair{"seed", "reset"}, std::pair{"reason", "shutdown"},
                                   std::pair{"may-overlap", "move"}}) {
    if (!given.values.has(option) || verb.name == of) continue;
    throw text::UsageError(fmt::format("--{} is for {}; remove it from {}", option, of, verb.name));
  }
  const Request request = verb.read(given);
  const std::string endpoint = take_endpoint(where);
  reports::Console console;
  const auto server = connect(supervisor_options(endpoint, parsed.values, "ziggurat ctl"), console);
  request({*server, console, given.values.has("json")});
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
