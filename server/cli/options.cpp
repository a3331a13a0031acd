#include "cli/options.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/arguments.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

auto text(const char* name) { return po::value<std::string>()->value_name(name); }
auto texts(const char* name) {
  return po::value<std::vector<std::string>>()->composing()->value_name(name);
}

constexpr unsigned width = 96;

po::options_description reading_options() {
  po::options_description options("Reading the scene", width);
  options.add_options()                                          //
      ("lenient", "unknown attributes are notices, not faults")  //
      ("max-scene-size", text("SIZE"), "largest scene file, as 64M (the default)");
  return options;
}

constexpr const char* seed_help = "random seed; 0 draws one from the system and prints it";
constexpr const char* clock_help =
    "physical time per tick: 1/ticks_per_second, or the slow clock of ARGoS 3.0.0-beta50";

po::options_description world_options() {
  po::options_description options("The run", width);
  options.add_options()                                                  //
      ("ticks", text("N"), "N ticks, whatever the scene's length says")  //
      ("duration", text("S"),
       "S simulated seconds, whatever the scene's length says; "
       "0 is until Ctrl-C")                          //
      ("seed", text("N"), seed_help)                 //
      ("clock", text("nominal|beta50"), clock_help)  //
      ("real-time", po::value<std::string>()->implicit_value("1")->value_name("FACTOR"),
       "pace to the wall clock, FACTOR times as fast (1 if left out)")  //
      ("endpoint", texts("URL"),
       "listen here too: tcp://127.0.0.1:5770, tcp://127.0.0.1:* or "
       "ipc:///short/path; may be repeated")  //
      ("deadline", texts("[CONTROLLER=]ACTION[:MS[:BUDGET]]"),
       "when a controller (all, if none is named) has not answered after MS milliseconds: wait, "
       "hold, zero, drop or stop; BUDGET misses in a row are held before drop and stop, or drop "
       "the robots after hold and zero; may be repeated")  //
      ("lease", text("S"),
       "keep the robots of a controller whose connection is gone for it, for S seconds")     //
      ("curve-secret", text("FILE"), "protect endpoints with this key ('ziggurat keygen')")  //
      ("curve-clients", text("FILE"),
       "who may connect: lines with a public key, roles (controller, supervisor, observer) and a "
       "name")                                                       //
      ("insecure", "allow endpoints that other machines can reach")  //
      ("metrics", text("HOST:PORT"),
       "serve the run's status over HTTP there: /metrics for Prometheus, /status as JSON");
  return options;
}

po::options_description hil_options() {
  po::options_description options("Hardware in the loop", width);
  options.add_options()  //
      ("hil",
       "pace to the wall clock and wait for nobody: a controller that has not answered after nine "
       "tenths of a tick is held to its last command, unless --deadline says otherwise")  //
      ("inject", texts("[CONTROLLER=][DIRECTION:]WHAT"),
       "hold back or lose messages as a network would: latency=5ms,jitter=2ms,loss=1% to a "
       "controller (all, if none is named) and from it, or in the DIRECTION observations or "
       "commands "
       "only; may be repeated")  //
      ("gate", text("CONDITIONS"),
       "exit with 4 unless every controller reports::meets them: p99<2ms,misses<0.1% (p50, p90, "
       "p99, p99.9, "
       "max, misses, late)")  //
      ("report-card", text("FILE"),
       "how controllers kept up, as JSON, or as a picture if FILE ends with .svg");
  return options;
}

po::options_description output_options() {
  po::options_description options("What comes out", width);
  options.add_options()                                                                      //
      ("quiet", "no progress, notices and summary on stderr")                                //
      ("json", "messages for machines: one JSON object a line")                              //
      ("hash", "last line of stdout: hash TICK DIGITS of the final state")                   //
      ("hash-file", text("FILE"), "such a line for every tick")                              //
      ("trace", text("FILE.csv"), "world poses of everything at every tick")                 //
      ("readings", text("FILE.jsonl"), "what robots sensed and answered at every tick")      //
      ("rays", text("FILE.jsonl"), "tested rays and radio links of devices with show_rays")  //
      ("images", text("DIR"), "PNG per tick and camera with image: ROBOT.CAMERA.TICK.png")   //
      ("summary", text("FILE.json"), "the summary for machines");
  return options;
}

po::options_description controller_options() {
  po::options_description options("Controllers", width);
  options.add_options()  //
      ("lua-processes", text("N"),
       "share the Lua robots among N processes; 1 if left out, "
       "0 is one for each robot")  //
      ("controller", texts("ID=CMD"), "the scene's controller ID is CMD, whatever the scene says");
  return options;
}

po::options_description picture_options() {
  po::options_description options("The picture", width);
  options.add_options()                                                                      //
      ("out", text("FILE.png"), "where to; of several pictures, %03d in it is the number")   //
      ("at", text("S,S,..."), "simulated seconds, of a picture each; 0 if left out")         //
      ("eye", text("X,Y,Z"), "from where [m]; so that the whole arena is seen if left out")  //
      ("look-at", text("X,Y,Z"), "to where [m]; the middle of the arena if left out")        //
      ("size", text("WxH"), "pixels; 1280x720 if left out")                                  //
      ("fov", text("DEGREES"), "angle from the left edge to the right; 46 if left out");
  return options;
}

double positive_number(std::string_view option, const std::string& value) {
  const auto number = text::to_number(option, value);
  if (number <= 0)
    throw text::UsageError(fmt::format("{} is {}; more than 0 is due", option, value));
  return number;
}

scene::Clock to_clock(const std::string& value) {
  if (value == "nominal") return scene::Clock::nominal;
  if (value == "beta50") return scene::Clock::beta50;
  throw text::UsageError(fmt::format("--clock is '{}'; nominal or beta50 is due", value));
}

std::pair<std::string, std::string> to_controller(const std::string& value) {
  const auto equals = value.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == value.size()) {
    throw text::UsageError(fmt::format("--controller is '{}'; ID=COMMAND is due", value));
  }
  return {value.substr(0, equals), value.substr(equals + 1)};
}

}  // namespace

po::options_description run_options() {
  const po::options_description processes = controller_options();
  po::options_description options("", width);
  options.add(world_options())
      .add(hil_options())
      .add(processes)
      .add(output_options())
      .add(reading_options());
  return options;
}

po::options_description serve_options() {
  po::options_description options("", width);
  options.add(world_options()).add(hil_options()).add(output_options()).add(reading_options());
  return options;
}

po::options_description check_options() {
  po::options_description options("", width);
  options.add(reading_options())
      .add_options()("json", "the report as JSON on stdout")("quiet", "faults only");
  return options;
}

po::options_description render_options() {
  po::options_description run("The run", width);
  run.add_options()                                  //
      ("seed", text("N"), seed_help)                 //
      ("clock", text("nominal|beta50"), clock_help)  //
      ("without-controllers", "nobody drives the robots")("quiet", "no notices and no summary")(
          "json", "messages for machines: one JSON object a line");
  po::options_description options("", width);
  options.add(picture_options()).add(run).add(controller_options()).add(reading_options());
  return options;
}

run::Options parse_options(const Arguments& arguments, const po::options_description& known) {
  const Parsed parsed = parse(arguments, known);
  const auto flag = [&](const char* name) { return parsed.values.count(name) > 0; };
  const auto value = [&](const char* name) {
    return flag(name) ? parsed.values[name].as<std::string>() : std::string();
  };
  const auto list = [&](const char* name) {
    return flag(name) ? parsed.values[name].as<std::vector<std::string>>()
                      : std::vector<std::string>();
  };
  run::Options options;
  options.scenes = parsed.positional;
  options.reading.lenient = flag("lenient");
  if (flag("max-scene-size")) {
    options.reading.max_size = text::to_size("--max-scene-size", value("max-scene-size"));
  }
  if (flag("ticks")) options.ticks = text::to_integer("--ticks", value("ticks"));
  if (flag("duration")) {
    options.duration = text::to_number("--duration", value("duration"));
    if (*options.duration < 0) throw text::UsageError("--duration is negative; seconds are due");
  }
  if (options.ticks && options.duration) {
    throw text::UsageError("--ticks and --duration both say how long; give one of them");
  }
  if (flag("seed")) options.seed = text::to_integer("--seed", value("seed"));
  if (flag("clock")) options.clock = to_clock(value("clock"));
  if (flag("real-time")) options.real_time = positive_number("--real-time", value("real-time"));
  if (flag("lua-processes")) {
    options.lua_processes = static_cast<unsigned>(std::min<std::uint64_t>(
        text::to_integer("--lua-processes", value("lua-processes")), 1u << 20));
  }
  for (const auto& each : list("controller")) options.controllers.push_back(to_controller(each));
  options.endpoints = list("endpoint");
  options.without_controllers = flag("without-controllers");
  for (const auto& each : list("deadline")) options.deadlines.push_back(run::to_deadline(each));
  for (const auto& each : list("inject")) options.injections.push_back(run::to_injection(each));
  if (flag("lease")) {
    options.lease = text::to_number("--lease", value("lease"));
    if (options.lease < 0 || options.lease > 4e6) {
      throw text::UsageError("--lease is no number of seconds from 0 to 4000000");
    }
  }
  options.curve_secret = value("curve-secret");
  options.curve_clients = value("curve-clients");
  if (options.curve_secret.empty() != options.curve_clients.empty()) {
    throw text::UsageError("--curve-secret and --curve-clients belong together");
  }
  options.insecure = flag("insecure");
  options.metrics = value("metrics");
  options.hil = flag("hil");
  if (flag("gate")) options.gate = reports::parse_gate(value("gate"));
  options.report_card = value("report-card");
  options.quiet = flag("quiet");
  options.json = flag("json");
  options.hash = flag("hash");
  options.hash_file = value("hash-file");
  options.trace = value("trace");
  options.readings = value("readings");
  options.rays = value("rays");
  options.images = value("images");
  options.summary = value("summary");
  return options;
}

}  // namespace ziggurat::cli
