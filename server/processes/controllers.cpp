// SPDX-License-Identifier: MIT
#include "processes/controllers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "outputs/output_file.h"
#include "processes/scripts.h"

namespace ziggurat::processes {
namespace {

// The private endpoint has no keys, so keys in the environment of this program must not reach
// the controllers.
const std::vector<std::pair<std::string, std::string>> no_keys{{"ZIGGURAT_SERVER_KEY", ""},
                                                               {"ZIGGURAT_CURVE_SECRET", ""}};

constexpr const char* token_name = "ZIGGURAT_SESSION_TOKEN";

/// The same process again, which resumes that session.
ControllerProcess start_again(const ControllerProcess& ended, const std::string& token,
                              const Guardian* guardian) {
  Program program = ended.program;
  if (!token.empty()) {
    std::string digits;
    for (const char byte : token) digits += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    program.environment.emplace_back(token_name, digits);
  }
  try {
    return {ended.name,        ended.robots, ChildProcess(program, guardian),
            ended.place_file,  std::nullopt, ended.program,
            ended.restarts + 1};
  } catch (const std::system_error& error) {
    throw std::runtime_error(
        fmt::format("{} cannot be started again: {}", ended.name, error.code().message()));
  }
}

/// @param option, path  where it finds its robots
Launch lua_launch(std::string name, const char* option, const std::string& path,
                  const LaunchSettings& settings) {
  Launch launch;
  launch.name = std::move(name);
  launch.program.arguments = {
      settings.lua_runner, "--connect", settings.endpoint, option, path, "--quiet"};
  launch.program.arguments.insert(launch.program.arguments.end(), settings.lua_arguments.begin(),
                                  settings.lua_arguments.end());
  launch.place_file = path + "-place";
  launch.program.arguments.insert(launch.program.arguments.end(),
                                  {"--place-file", launch.place_file});
  launch.program.environment = no_keys;
  return launch;
}

std::vector<Launch> plan_lua(const std::vector<std::size_t>& robots,
                             const LaunchSettings& settings) {
  const std::size_t wanted = settings.lua_processes == 0 ? robots.size() : settings.lua_processes;
  const std::size_t count = std::min(wanted, robots.size());
  std::vector<Launch> launches;
  for (std::size_t i = 0; i < count; ++i) {
    const auto block = [&](std::size_t n) {
      return robots.begin() + static_cast<std::ptrdiff_t>(n * robots.size() / count);
    };
    const std::string file = fmt::format("{}/robots-{}", settings.folder, i);
    auto& launch = launches.emplace_back(
        lua_launch(count == 1 ? "ziggurat-lua" : fmt::format("ziggurat-lua {} of {}", i + 1, count),
                   "--robots-file", file, settings));
    launch.robots = {block(i), block(i + 1)};
    launch.robots_file = file;
  }
  return launches;
}

/// Sets the environment of a command's program.
/// @param name, id  of the variable that says what it is to drive
void add_environment(const LaunchSettings& settings, const char* name, const std::string& id,
                     Program& program) {
  program.environment = no_keys;
  program.environment.insert(program.environment.end(),
                             {{"ZIGGURAT_ENDPOINT", settings.endpoint},
                              {name, id},
                              {"ZIGGURAT_SCENE_FOLDER", settings.scene_folder}});
  if (!settings.python_path.empty())
    program.environment.emplace_back("PYTHONPATH", settings.python_path);
}

Launch plan_director(const scene::Director& director, const LaunchSettings& settings) {
  Launch launch;
  launch.name = fmt::format("director '{}'", director.id);
  launch.director = director.id;
  launch.program.environment = no_keys;
  if (director.command.empty()) {
    launch.program.arguments = {settings.lua_runner, "--connect", settings.endpoint,
                                "--director",        director.id, "--quiet"};
    launch.program.arguments.insert(launch.program.arguments.end(), settings.lua_arguments.begin(),
                                    settings.lua_arguments.end());
    return launch;
  }
  launch.program.arguments = {"/bin/sh", "-c", director.command};
  add_environment(settings, "ZIGGURAT_DIRECTOR", director.id, launch.program);
  return launch;
}

/// Sentence on a program of ours that is missing: the places that were searched, and the remedy.
std::string missing(const std::string& program) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return fmt::format(
      "there is no {} beside {} and none in the folders of PATH; put it beside, as an installation "
      "does, or "
      "add its folder to PATH",
      program, error ? "this program" : self.string());
}

ControllerProcess start(const Launch& launch, const world::Layout& layout,
                        const Guardian* guardian) {
  if (!launch.robots_file.empty()) {
    outputs::OutputFile file(launch.robots_file);
    for (const std::size_t robot : launch.robots) {
      file.buffer().append(layout.robots[robot].id + "\n");
    }
    file.close();
  }
  try {
    std::optional<RobotPipe> pipe;
    if (!launch.robot_pipe.empty()) pipe.emplace(launch.robot_pipe);
    return {launch.name,
            launch.robots,
            ChildProcess(launch.program, guardian),
            launch.place_file,
            std::move(pipe),
            launch.program,
            0,
            launch.director};
  } catch (const std::system_error& error) {
    const std::string& program = launch.program.arguments[0];
    const bool is_missing = error.code() == std::errc::no_such_file_or_directory &&
                            program.find('/') == std::string::npos;
    throw std::runtime_error(fmt::format("{} cannot be started ({}): {}", launch.name, program,
                                         is_missing ? missing(program) : error.code().message()));
  }
}

/// The processes of the scene's robots.
std::vector<Launch> plan_robots(const scene::Scene& scene, const world::Layout& layout,
                                const std::vector<std::string>& scripts,
                                const LaunchSettings& settings) {
  std::vector<std::size_t> lua;
  std::vector<std::vector<std::size_t>> others(scene.controllers.size());
  for (std::size_t r = 0; r < layout.robots.size(); ++r) {
    const std::size_t controller = layout.robots[r].controller;
    if (!runs_script(scene.controllers[controller])) {
      others[controller].push_back(r);
    } else if (!scripts[r].empty()) {
      lua.push_back(r);
    }
  }
  auto launches = plan_lua(lua, settings);
  for (std::size_t c = 0; c < others.size(); ++c) {
    const auto& controller = scene.controllers[c];
    if (others[c].empty() || controller.command.empty()) continue;
    Launch launch;
    launch.name = fmt::format("the command of controller '{}'", controller.id);
    launch.robots = others[c];
    launch.program.arguments = {"/bin/sh", "-c", controller.command};
    add_environment(settings, "ZIGGURAT_CONTROLLER", controller.id, launch.program);
    launches.push_back(std::move(launch));
  }
  return launches;
}

}  // namespace

std::vector<Launch> plan_controllers(const scene::Scene& scene, const world::Layout& layout,
                                     const std::vector<std::string>& scripts,
                                     const LaunchSettings& settings) {
  std::vector<Launch> launches;
  if (!settings.only_directors) launches = plan_robots(scene, layout, scripts, settings);
  for (const scene::Director& director : settings.directors) {
    if (!director.script.empty() || !director.command.empty()) {
      launches.push_back(plan_director(director, settings));
    }
  }
  return launches;
}

Launch plan_spawned(std::size_t number, const LaunchSettings& settings) {
  const std::string pipe = fmt::format("{}/spawned-{}", settings.folder, number);
  auto launch = lua_launch(fmt::format("ziggurat-lua {} for spawned robots", number + 1),
                           "--robots-from", pipe, settings);
  launch.robot_pipe = pipe;
  return launch;
}

std::vector<ControllerProcess> start_all(const std::vector<Launch>& launches,
                                         const world::Layout& layout, const Guardian* guardian) {
  std::vector<ControllerProcess> processes;
  for (const auto& launch : launches) processes.push_back(start(launch, layout, guardian));
  return processes;
}

Controllers::Controllers(const scene::Scene& scene, const world::Layout& layout,
                         const std::vector<std::string>& scripts, LaunchSettings settings)
    : settings_(std::move(settings)),
      processes_(start_all(plan_controllers(scene, layout, scripts, *settings_), layout,
                           settings_->guardian)) {}

void Controllers::start_spawned(std::size_t robot, const world::Layout& layout) {
  if (!settings_) return;
  ControllerProcess& process = process_for_spawned();
  if (!process.pipe->send(layout.robots[robot].id)) {
    throw std::runtime_error(
        fmt::format("{} does not take robot '{}'", process.name, layout.robots[robot].id));
  }
  process.robots.push_back(robot);
}

/// The one with the fewest robots, or a new one.
ControllerProcess& Controllers::process_for_spawned() {
  constexpr std::size_t most = 16;
  const std::size_t wanted = settings_->lua_processes == 0 ? most : settings_->lua_processes;
  std::size_t count = 0;
  ControllerProcess* fewest = nullptr;
  for (ControllerProcess& each : processes_) {
    if (!each.pipe || each.process.poll()) continue;
    ++count;
    if (fewest == nullptr || each.robots.size() < fewest->robots.size()) fewest = &each;
  }
  if (fewest != nullptr && count >= std::min(wanted, most)) return *fewest;
  auto started = start_all({plan_spawned(spawned_++, *settings_)}, {}, settings_->guardian);
  return processes_.emplace_back(std::move(started.front()));
}

void Controllers::forget_robots(std::size_t first) {
  std::vector<ControllerProcess> kept;
  for (ControllerProcess& each : processes_) {
    std::erase_if(each.robots, [&](std::size_t robot) { return robot >= first; });
    if (each.robots.empty() && each.process.poll()) continue;
    kept.push_back(std::move(each));
  }
  processes_ = std::move(kept);
}

std::optional<BusyScript> busy_script(const ControllerProcess& process) {
  std::ifstream file(process.place_file);
  BusyScript script;
  std::getline(file, script.robot);
  std::getline(file, script.place, '\0');
  if (script.robot.empty() || script.robot[0] == '\0') return std::nullopt;
  return script;
}

std::optional<BusyScript> Controllers::busy_script(std::size_t robot) const {
  for (const ControllerProcess& each : processes_) {
    if (!std::ranges::binary_search(each.robots, robot)) continue;
    if (auto script = processes::busy_script(each)) return script;
  }
  return std::nullopt;
}

bool Controllers::have(std::size_t robot) const {
  return std::ranges::any_of(processes_, [&](const ControllerProcess& each) {
    return std::ranges::find(each.robots, robot) != each.robots.end();
  });
}

bool Controllers::have_director(const std::string& id) const {
  return std::ranges::any_of(processes_,
                             [&](const ControllerProcess& each) { return each.director == id; });
}

const ControllerProcess& Controllers::restart(const ControllerProcess& ended,
                                              const std::string& token) {
  const auto position = static_cast<std::size_t>(&ended - processes_.data());
  auto started = start_again(ended, token, settings_->guardian);
  std::vector<ControllerProcess> processes;  // a process can be moved, but not assigned
  for (std::size_t i = 0; i < processes_.size(); ++i) {
    processes.push_back(std::move(i == position ? started : processes_[i]));
  }
  processes_ = std::move(processes);
  return processes_[position];
}

std::vector<ControllerProcess*> Controllers::ended(
    const std::function<bool(const ControllerProcess&)>& is_needed) {
  std::vector<ControllerProcess*> ended;
  for (ControllerProcess& each : processes_) {
    const bool has_ended = each.process.poll();  // of all: it collects what each leaves behind
    if (has_ended && !each.is_settled && is_needed(each)) ended.push_back(&each);
  }
  return ended;
}

bool Controllers::are_running() {
  return std::ranges::any_of(processes_,
                             [](ControllerProcess& each) { return !each.process.poll(); });
}

void Controllers::kill() {
  for (const ControllerProcess& each : processes_) each.process.signal(SIGKILL);
}

void Controllers::end(int patience_ms, const std::function<bool()>& hurry,
                      const std::function<void(const ControllerProcess&)>& tell_slow) {
  std::vector<ChildProcess*> children;
  for (ControllerProcess& each : processes_) {
    each.pipe.reset();  // no more robots will come
    children.push_back(&each.process);
  }
  end_all(children, patience_ms, hurry, [&](const ChildProcess& slow) {
    tell_slow(*std::ranges::find(processes_, slow.id(),
                                 [](const ControllerProcess& each) { return each.process.id(); }));
  });
}

std::string find_lua_runner() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "ziggurat-lua";
  return !error && ::access(beside.c_str(), X_OK) == 0 ? beside.string() : "ziggurat-lua";
}

std::string names_of(const std::vector<std::size_t>& robots, const world::Layout& layout) {
  constexpr std::size_t most = 8;
  std::string text = robots.size() == 1 ? "robot " : "robots ";
  for (std::size_t i = 0; i < std::min(most, robots.size()); ++i) {
    text += (i ? ", " : "") + layout.robots[robots[i]].id;
  }
  if (robots.size() > most) text += fmt::format(" and {} more", robots.size() - most);
  return text;
}

std::string describe(const ControllerProcess& controller, const std::string& what,
                     const world::Layout& layout) {
  const std::string text =
      fmt::format("{} (process {}) {}", controller.name, controller.process.id(), what);
  if (!controller.director.empty()) return text;
  return fmt::format("{}; it controlled {}", text, names_of(controller.robots, layout));
}

RobotPipe::RobotPipe(const std::string& path) {
  // Open for both ends, so that neither this nor a later write waits for a reader.
  if (::mkfifo(path.c_str(), 0600) == 0) {
    descriptor_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path);
}

RobotPipe::~RobotPipe() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

RobotPipe::RobotPipe(RobotPipe&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

bool RobotPipe::send(const std::string& id) const {
  const std::string line = id + "\n";
  return ::write(descriptor_, line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

}  // namespace ziggurat::processes
