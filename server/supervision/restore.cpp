// Snapshots that supervisors take, and the way back (docs/protocol.md, V11 and V16).

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "processes/spawned_scripts.h"
#include "supervision/opener.h"
#include "supervision/supervision.h"
#include "wire/fault.h"

namespace ziggurat::supervision {

using wire::ErrorCode;
using wire::make_fault;

namespace {

/// How many of the first robots two pasts have in common: those of the scene, and those spawned
/// before the pasts part.
std::size_t common_robots(const simulation::History& now, const simulation::History& then,
                          const world::Layout& layout) {
  std::size_t entities = layout.entities.size();
  const auto is_same = [](const simulation::Act& a, const simulation::Act& b) {
    return a.kind == b.kind && a.tick == b.tick && a.entity == b.entity && a.xml == b.xml;
  };
  const auto [part, other] = std::ranges::mismatch(now.acts, then.acts, is_same);
  for (auto act = part; act != now.acts.end(); ++act) {
    if (act->kind == simulation::Act::Kind::spawn) entities = std::min(entities, act->entity);
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      layout.robots, [&](const world::RobotLayout& robot) { return robot.entity < entities; }));
}

std::vector<std::string> clients_without_restore(const network::Server& server) {
  std::vector<std::string> clients;
  for (const network::RobotStatus& robot : server.status()) {
    const bool is_known = std::ranges::find(clients, robot.holder) != clients.end();
    if (!robot.can_restore && !is_known) clients.push_back(robot.holder);
  }
  return clients;
}

std::string list_of(const std::vector<std::string>& clients) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(clients.size(), most); ++i) {
    text += (i == 0 ? "'" : ", '") + clients[i] + "'";
  }
  if (clients.size() > most) text += fmt::format(" and {} more", clients.size() - most);
  return text;
}

/// The script of a robot that is back; empty if it has none, or none any more.
std::string script_of(const World& world, const scene::Entity& entity,
                      const processes::AllowedFiles& allowed, reports::Console& console) {
  try {
    const auto script = processes::spawned_script(world.scene, entity, world.path, allowed);
    if (script.fault) console.notice(script.details.value_or(*script.fault));
    return script.path;
  } catch (const std::runtime_error& error) {  // its file is gone
    console.notice(error.what());
    return {};
  }
}

}  // namespace

Supervision::Reply Supervision::snapshot(const network::Call& call) {
  if (auto fault = snapshots_.keep(call.request.text, world_)) return fail(call, std::move(*fault));
  callers_.tell(Kept{call.request.text});
  return done(call);
}

/// Answered by restart().
Supervision::Reply Supervision::restore(const network::Call& call) {
  if (resetting_) return Reply::later;
  if (const auto clients = clients_without_restore(server_); !clients.empty()) {
    return fail(call,
                make_fault(ErrorCode::out_of_state, {},
                           fmt::format("These clients have not said that their controllers can go "
                                       "back to a snapshot: {}. Let them leave first, or connect "
                                       "clients that set can_restore in their Hello.",
                                       list_of(clients))));
  }
  auto found = snapshots_.find(call.request.text, world_, opener(allowed_, world_.path));
  if (auto* fault = std::get_if<wire::Fault>(&found)) return fail(call, std::move(*fault));
  restoring_ = std::get<FoundSnapshot>(std::move(found));
  resetting_ = call;
  return Reply::given;
}

bool Supervision::restart() {
  const simulation::History before = world_.simulation.history();
  const world::Layout layout = world_.simulation.layout();
  try {
    restoring_ ? world_.restore(restoring_->snapshot)
               : world_.reset(resetting_->request.seed.value_or(world_.seed));
  } catch (const std::runtime_error& error) {
    fail(*resetting_, make_fault(ErrorCode::bad_value, restoring_ ? "restore.name" : "reset.seed",
                                 error.what()));
    resetting_.reset();
    restoring_.reset();
    return false;
  }
  wire::Restart restart{world_.seed};
  simulation::Simulation& simulation = world_.simulation;
  if (restoring_) {
    simulation.commands().radio_messages.clear();  // controllers send them again
    restart.snapshot = {resetting_->request.text, simulation.state().tick, &simulation.commands(),
                        common_robots(before, restoring_->snapshot.history, layout)};
  }
  server_.restart(restart);
  if (restoring_) {
    callers_.tell(Restored{resetting_->request.text, std::move(restoring_->bytes)});
  } else {
    callers_.tell(WasReset{world_.seed});
  }
  welcome_back(restart.snapshot ? restart.snapshot->robots : simulation.layout().robots.size());
  is_gathered_ = false;  // until every robot has its controller again
  spawned_ = 0;
  spawnable_size_ = settings_.max_spawned_size;
  for (const simulation::Act& act : simulation.history().acts) {
    if (act.kind != simulation::Act::Kind::spawn) continue;
    ++spawned_;
    spawnable_size_ -= std::min(spawnable_size_, act.xml.size());
  }
  done(*resetting_);
  resetting_.reset();
  restoring_.reset();
  return true;
}

/// Processes of robots that are gone end by themselves; robots that are back are free.
/// @param robots  the first ones, which are the same as before
void Supervision::welcome_back(std::size_t robots) {
  const simulation::Simulation& simulation = world_.simulation;
  const auto& all = simulation.layout().robots;
  controllers_.forget_robots(robots);
  std::vector<std::size_t> absent;
  for (std::size_t i = 0; i < robots; ++i) {
    if (simulation.state().is_absent(all[i].entity)) absent.push_back(i);
  }
  server_.remove_robots(absent);
  if (robots == all.size()) return;
  std::vector<std::string> scripts;
  for (std::size_t i = robots; i < all.size(); ++i) {
    scripts.push_back(script_of(world_, simulation.entities()[all[i].entity], allowed_, console_));
  }
  add_controllers(robots, scripts);
}

}  // namespace ziggurat::supervision
