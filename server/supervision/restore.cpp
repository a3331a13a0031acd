// SPDX-License-Identifier: MIT
// Snapshots that supervisors take, and the way back (docs/protocol.md, V11 and V16).

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <variant>

#include "processes/spawned_scripts.h"
#include "supervision/population.h"
#include "supervision/supervision.h"
#include "wire/messages.h"

namespace ziggurat::supervision {

using wire::ErrorCode;
using wire::make_fault;

namespace {

std::vector<std::string> clients_without_restore(network::Server& server) {
  std::vector<std::string> clients;
  for (const network::RobotStatus& robot : server.status()) {
    const bool is_known = std::ranges::find(clients, robot.holder) != clients.end();
    if (!robot.can_restore && !is_known) clients.push_back(robot.holder);
  }
  for (const network::DirectorStatus& director : network::ServerDirectors(server).status()) {
    if (!director.can_restore) clients.push_back(director.client);
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

}  // namespace

/// Takes a snapshot. It waits for a restore that was asked for before. The state of that restore is
/// found already, but in a recording it would follow this snapshot, which may have the same name.
Reply Supervision::snapshot(const network::Call& call) {
  if (resetting_) return Reply::later;
  if (auto fault = snapshots_.keep(call.request.text, world_)) return fail(call, std::move(*fault));
  callers_.tell(SnapshotTaken{call.request.text});
  return done(call);
}

/// Answered by restart().
Reply Supervision::restore(const network::Call& call) {
  if (resetting_) return Reply::later;
  if (const auto clients = clients_without_restore(server_); !clients.empty()) {
    return fail(call,
                make_fault(ErrorCode::out_of_state, {},
                           fmt::format("These clients have not said that their controllers can go "
                                       "back to a snapshot: {}. Let them leave first, or connect "
                                       "clients that set can_restore in their Hello.",
                                       list_of(clients))));
  }
  auto found =
      snapshots_.find(call.request.text, world_, opener(population_.allowed(), world_.path));
  if (auto* fault = std::get_if<wire::Fault>(&found)) return fail(call, std::move(*fault));
  restoring_ = std::get<FoundSnapshot>(std::move(found));
  resetting_ = call;
  return Reply::given;
}

bool Supervision::restart() {
  std::size_t common = 0;
  if (restoring_) {
    common = common_robots(world_.simulation.history(), restoring_->snapshot.history,
                           world_.simulation.layout());
  }
  try {
    restoring_ ? world_.restore(restoring_->snapshot)
               : world_.reset(resetting_->request.seed.value_or(world_.seed),
                              [this] { network::keep_alive(server_); });
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
    world::forget_sent(simulation.commands());  // controllers send it again
    restart.snapshot = {resetting_->request.text, simulation.state().tick, &simulation.commands(),
                        common};
  }
  server_.restart(restart);
  if (restoring_) {
    callers_.tell(Restored{resetting_->request.text, std::move(restoring_->bytes)});
  } else {
    callers_.tell(WasReset{world_.seed});
  }
  population_.restart(restart.snapshot ? restart.snapshot->robots
                                       : simulation.layout().robots.size());
  is_gathered_ = false;  // until every robot has its controller again
  end_steps();
  answer_waiting(
      waiting_, callers_,
      [this](const network::Call& call) {  // also those that waited for their turn
        if (call.request.kind != wire::Request::Kind::step) return Reply::later;
        return fail(
            call,
            make_fault(ErrorCode::out_of_state, {},
                       "A reset or restore has ended these steps; send a Step again for others."));
      });
  done(*resetting_);
  resetting_.reset();
  restoring_.reset();
  return true;
}

}  // namespace ziggurat::supervision
