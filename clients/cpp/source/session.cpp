// SPDX-License-Identifier: MIT
#include "ziggurat/session.h"

#include <stdexcept>

#include "controlling.h"
#include "session_core.h"
#include "text/printable.h"

namespace ziggurat {

struct Session::State {
  explicit State(const Options& from) : options(from), part(options), core(options, part) {}

  Options options;
  Controlling part;
  SessionCore core;
};

Session::Session(const Options& options) : state_(std::make_unique<State>(options)) {
  state_->core.open();
}

Session::~Session() { state_->core.leave_at_the_end(); }

bool Session::next() { return state_->core.next(); }
void Session::leave() { state_->core.leave(v1::Leave::DONE, {}); }
void Session::leave_failed(std::string_view message) {
  state_->core.leave(v1::Leave::FAILED, message);
}

Event Session::event() const noexcept { return state_->core.event; }
std::uint64_t Session::tick() const noexcept { return state_->core.now.tick; }
std::chrono::nanoseconds Session::time() const noexcept {
  return std::chrono::nanoseconds(state_->core.now.time_ns);
}
const std::optional<Ending>& Session::ending() const noexcept { return state_->core.ending; }
std::chrono::nanoseconds Session::tick_length() const noexcept { return state_->core.tick_length; }
std::uint32_t Session::ticks_per_second() const noexcept { return state_->core.ticks_per_second; }
std::uint64_t Session::seed() const noexcept { return state_->core.seed; }
const std::string& Session::scene_hash() const noexcept { return state_->core.scene_hash; }
const std::string& Session::server_version() const noexcept { return state_->core.server_version; }
const std::string& Session::snapshot() const noexcept { return state_->core.snapshot; }
const std::string& Session::token() const noexcept { return state_->core.token; }
std::uint64_t Session::missed() const noexcept { return state_->core.missed; }
std::uint64_t Session::resumes() const noexcept { return state_->core.resumes; }

std::vector<SpawnedRobot> Session::take_spawned() { return state_->part.take_spawned(); }
std::span<Robot> Session::robots() noexcept { return state_->part.robots(); }

Robot& Session::robot(std::string_view id) {
  for (Robot& robot : robots()) {
    if (robot.id() == id) return robot;
  }
  std::string message = "this session has no robot '" + std::string(id) + "'; it has ";
  for (const Robot& robot : robots()) {
    message += (&robot == robots().data() ? "'" : ", '") + robot.id() + "'";
  }
  throw std::out_of_range(text::printable_part(message));
}

}  // namespace ziggurat
