// SPDX-License-Identifier: MIT
#include "program/options.h"

#include <boost/program_options.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "script/trimmed.h"
#include "ziggurat/session.h"

namespace ziggurat::lua {
namespace {

namespace po = boost::program_options;

constexpr const char* introduction =
    R"(Runs Lua controllers of robots against a Ziggurat server.

usage: ziggurat-lua [--connect URL] [--robot GLOB]... [--script FILE]

  ziggurat serve vehicle.argos           in one terminal, and
  ziggurat-lua                           in another: all robots of the scene that have a Lua script
  ziggurat-lua --robot 'scout*'          some of them
  ziggurat-lua --script other.lua        with your own script
  ziggurat-lua --connect tcp://127.0.0.1:5770
      a server that was started with --endpoint, or one of several

`ziggurat run` starts this program itself. A script has robot, log and logerr, and defines init,
step, reset and destroy; that of a director has world: see docs/lua-api.md. A script that fails ends only its own robot.
A script can't start programs, and uses only files below the working directory, unless --trust-scripts
or --script-folder allows more.

Exit codes: 0 the run is over; 1 an error in an argument, the connection or the server's answer;
3 a script failed; 130 Ctrl-C.)";

auto text(const char* name) { return po::value<std::string>()->value_name(name); }

po::options_description description() {
  po::options_description options("Options", 96);
  options.add_options()  //
      ("connect", text("URL"),
       "endpoint of the server: tcp://host:port or ipc:///path; default: ZIGGURAT_ENDPOINT, then "
       "the only server that runs here")  //
      ("robot", po::value<std::vector<std::string>>()->composing()->value_name("GLOB"),
       "robots to run: an id or a pattern of * ? [a-z]; may be repeated")         //
      ("robots-file", text("FILE"), "robots to run: one id or pattern per line")  //
      ("robots-from", text("PIPE"),
       "run each robot whose id arrives on this named pipe, one a line, in a session of its own")  //
      ("controller", text("ID"), "robots that have this controller in the scene")  //
      ("director", text("ID"),
       "run the script of the scene's director ID, no robots; with --script another")          //
      ("server-key", text("KEY"), "public key of a server with an encrypted endpoint")         //
      ("curve-secret", text("FILE"), "secret key of this program for it ('ziggurat keygen')")  //
      ("script", text("FILE"), "run this script instead of those of the scene")                //
      ("name", text("NAME"), "name of this program in the server's messages")                  //
      ("script-folder", po::value<std::vector<std::string>>()->composing()->value_name("DIR"),
       "the server may name only scripts below DIR, and scripts may use only files below it; may "
       "be "
       "repeated; default: the working directory, and the folder of --script, where the server may "
       "name only "
       "files that end with .lua")  //
      ("read-only-file", po::value<std::vector<std::string>>()->composing()->value_name("FILE"),
       "scripts may not change FILE; may be repeated")  //
      ("hidden-file", po::value<std::vector<std::string>>()->composing()->value_name("FILE"),
       "scripts may not use FILE; may be repeated; the file of --curve-secret is hidden, too")  //
      ("trust-scripts",
       "scripts may use all of Lua, start programs, and read and write all files; no limits of "
       "instructions and time unless one is set")                                  //
      ("max-memory", text("MIB"), "largest memory of the script of a robot; 256")  //
      ("max-instructions", text("MILLIONS"),
       "most Lua instructions of a robot at one tick, in millions; 1000")  //
      ("max-time", text("SECONDS"),
       "most processor time of a robot's script at one tick; 20")  //
      ("place-file", text("FILE"),
       "keep the robot whose script runs in FILE, with the script's line if that takes long")  //
      ("echo",
       "print log lines here too; the default on a terminal. The server always gets them. Control "
       "characters of scripts are printed as \\u001b, unless --trust-scripts")  //
      ("quiet", "print only errors and what scripts print themselves")          //
      ("version", "print the version")                                          //
      ("help", "print this");
  return options;
}

std::string help() {
  std::ostringstream out;
  out << introduction << "\n\n" << description();
  return out.str();
}

void append_robots(const std::string& path, std::vector<std::string>& robots) {
  std::error_code error;
  const bool is_file =
      std::filesystem::is_regular_file(path, error);  // a pipe may never have a writer
  std::ifstream file(is_file ? path : "");
  if (!file)
    throw std::runtime_error("--robots-file " + path + ": can't be read, or is not a regular file");
  const auto before = robots.size();
  for (std::string line; std::getline(file, line);) {
    if (const auto id = trimmed(line); !id.empty()) robots.emplace_back(id);
  }
  if (file.bad() || robots.size() == before) {
    throw std::runtime_error("--robots-file " + path +
                             ": has no robot; write one id or pattern per line");
  }
}

std::uint64_t to_count(const char* option, const std::string& value, const char* unit) {
  constexpr unsigned long long most = 1ULL << 20;
  std::size_t used = 0;
  unsigned long long number = 0;
  try {
    number = std::stoull(value, &used);
  } catch (const std::logic_error&) {
  }
  if (used != value.size() || value[0] == '-' || number == 0 || number > most) {
    throw std::runtime_error(std::string(option) + " " + value + ": must be a number of " + unit +
                             " from 1 to 1048576");
  }
  return number;
}

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

po::variables_map parse(int count, const char* const* arguments) {
  namespace style = po::command_line_style;
  constexpr int exact = style::unix_style & ~style::allow_guessing;
  po::variables_map found;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    const bool is_value = i > 1 && arguments[i - 1][0] == '-';
    if (is_value || word.starts_with('-') || !word.ends_with(".lua")) continue;
    throw std::runtime_error("'" + word + "' is no option; to run this script, write --script " +
                             word);
  }
  try {
    // No positional arguments: boost's message names the first one.
    po::store(po::command_line_parser(count, arguments)
                  .options(description())
                  .positional({})
                  .style(exact)
                  .run(),
              found);
  } catch (const po::error& error) {
    throw std::runtime_error(std::string(error.what()) + "; see ziggurat-lua --help");
  }
  return found;
}

void read_limits(const po::variables_map& found, ProgramOptions& options) {
  const auto text_of = [&](const char* name) { return found[name].as<std::string>(); };
  if (found.count("script-folder")) {
    const auto folders = found["script-folder"].as<std::vector<std::string>>();
    options.folders.assign(folders.begin(), folders.end());
    options.names_any_ending = true;
  } else if (options.script) {
    options.folders.push_back(options.script->has_parent_path() ? options.script->parent_path()
                                                                : ".");
  }
  const auto add = [&](const char* name, std::vector<std::filesystem::path>& files) {
    if (!found.count(name)) return;
    const auto& texts = found[name].as<std::vector<std::string>>();
    files.insert(files.end(), texts.begin(), texts.end());
  };
  add("read-only-file", options.exceptions.read_only);
  add("hidden-file", options.exceptions.hidden);
  if (!options.curve_secret.empty()) options.exceptions.hidden.emplace_back(options.curve_secret);
  options.trusts_scripts = found.count("trust-scripts") > 0;
  if (options.trusts_scripts) options.max_instructions = options.max_computing = 0;
  if (found.count("max-memory")) {
    options.max_memory = to_count("--max-memory", text_of("max-memory"), "MiB") << 20;
  }
  if (found.count("max-instructions")) {
    options.max_instructions =
        to_count("--max-instructions", text_of("max-instructions"), "millions") * 1'000'000;
  }
  if (found.count("max-time")) {
    options.max_computing = to_count("--max-time", text_of("max-time"), "seconds");
  }
}

}  // namespace

Request read_arguments(int count, const char* const* arguments, bool is_terminal) {
  const auto found = parse(count, arguments);
  const auto value = [&](const char* name, std::string otherwise = {}) {
    return found.count(name) ? found[name].as<std::string>() : otherwise;
  };
  Request request;
  if (found.count("help")) request.text = help();
  if (found.count("version")) request.text = "ziggurat-lua " ZIGGURAT_VERSION "\n";
  if (!request.text.empty()) return request;

  ProgramOptions& options = request.options;
  options.endpoint = value("connect", environment("ZIGGURAT_ENDPOINT"));
  if (options.endpoint.empty()) options.endpoint = find_server();
  if (found.count("robot")) options.robots = found["robot"].as<std::vector<std::string>>();
  options.has_list = found.count("robots-file") > 0;
  if (options.has_list) append_robots(value("robots-file"), options.robots);
  options.robots_from = value("robots-from");
  if (!options.robots_from.empty() && !options.robots.empty()) {
    throw std::runtime_error("--robots-from and --robot or --robots-file exclude each other");
  }
  if (found.count("director")) options.director = value("director");
  if (options.director &&
      (!options.robots.empty() || !options.robots_from.empty() || found.count("controller"))) {
    throw std::runtime_error(
        "--director runs no robots: remove --robot, --robots-file, --robots-from and --controller");
  }
  options.controller = value("controller");
  if (options.controller.empty() && options.robots.empty() && options.robots_from.empty() &&
      !options.director) {
    options.controller = environment("ZIGGURAT_CONTROLLER");
  }
  options.server_key = value("server-key", environment("ZIGGURAT_SERVER_KEY"));
  options.curve_secret = value("curve-secret", environment("ZIGGURAT_CURVE_SECRET"));
  if (options.robots_from.empty()) options.session_token = take_session_token();
  if (found.count("script")) options.script = value("script");
  options.name = value("name", options.name);
  options.place_file = value("place-file");
  read_limits(found, options);
  options.quiet = found.count("quiet") > 0;
  options.echo = found.count("echo") > 0 || (is_terminal && !options.quiet);
  return request;
}

}  // namespace ziggurat::lua
