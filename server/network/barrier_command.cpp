// The tick path of the barrier.

#include <fmt/format.h>

#include "network/barrier.h"
#include "wire/fault.h"

namespace ziggurat::network {

using wire::ErrorCode;
using wire::make_fault;

void Barrier::publish(const world::Observations& observations,
                      std::span<const std::string> tag_payloads) {
  observations_ = observations;
  tag_payloads_.assign(tag_payloads.begin(), tag_payloads.end());
  std::vector<Session*> gone;
  for (const auto& session : sessions_) {
    if (session->state == SessionState::lost || session->roster.empty()) continue;
    if (!observe(*session)) gone.push_back(session.get());
  }
  for (Session* session : gone) lose(*session, "its connection is gone, or it does not read");
}

/// Sends a session what it senses at the published tick. False if it can't be reached.
bool Barrier::observe(Session& session) {
  const std::size_t limit = session.encoding == wire::Encoding::json
                                ? wire::max_json_observation_bytes
                                : wire::max_observation_bytes;
  if (!session.observation.observation(session.roster, *observations_, tag_payloads_, limit)) {
    auto fault = make_fault(ErrorCode::too_large, {},
                            "The robots of this session heard and saw more at this tick than a "
                            "message can hold; share them among more sessions.");
    fault.severity = wire::Severity::fatal;
    fault.tick = observations_->tick;
    outbox_.error(fault);
    send_(session.peer, outbox_);
    return false;
  }
  session.state = SessionState::stepping;
  session.tick = observations_->tick;
  if (!session.owes) ++owing_;
  session.owes = true;
  session.owes_since = std::chrono::steady_clock::now();
  return send_(session.peer, session.observation) == Delivery::sent;
}

void Barrier::say_command(Session& session, world::Commands* commands) {
  if (session.state == SessionState::draining) {
    // It was on its way when the end came. Its values have no effect, its last words count.
    if (!inbox_.check(session.roster, run_.layout)) {
      inbox_.append_log(session.roster, report_.log);
    }
    return;
  }
  auto fault = check_tick(session);
  if (!fault && commands == nullptr) {
    fault = make_fault(ErrorCode::out_of_state, {}, "No tick is being collected.");
  }
  if (!fault) fault = inbox_.check(session.roster, run_.layout);
  if (fault) return fail(session.peer, &session, std::move(*fault));
  session.faults = 0;
  inbox_.apply(session.roster, *commands);
  inbox_.append_log(session.roster, report_.log);
  settle(session);
}

std::optional<wire::Fault> Barrier::check_tick(const Session& session) const {
  if (session.state == SessionState::ready) {
    return make_fault(ErrorCode::out_of_state, {},
                      "A Command answers an Observation; none was sent yet.");
  }
  const std::uint64_t tick = inbox_.command_tick();
  if (tick > session.tick) {
    return make_fault(
        ErrorCode::future_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {}.", tick, session.tick));
  }
  if (tick < session.tick) {
    return make_fault(
        ErrorCode::stale_tick, "tick",
        fmt::format("The Command is for tick {}; the world is at {} already.", tick, session.tick));
  }
  if (session.owes) return std::nullopt;
  return make_fault(ErrorCode::duplicate_tick, "tick",
                    fmt::format("Tick {} was answered already; the first answer counts.", tick));
}

}  // namespace ziggurat::network
