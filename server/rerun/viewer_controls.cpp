// SPDX-License-Identifier: MIT
#include "rerun/viewer_controls.h"

#include <utility>

namespace ziggurat::rerun {

void ViewerControls::serve(std::uint64_t tick) {
  if (!calls_.take) return;
  if (stepping_ && !calls_.can_hear(*stepping_)) {
    stepping_.reset();
    set_paused(true);
  }
  for (const network::Call& call : calls_.take()) handle(call, tick);
}

void ViewerControls::set_paused(bool is_paused) {
  is_paused_ = is_paused;
  paused_.update(is_paused);
}

void ViewerControls::handle(const network::Call& call, std::uint64_t tick) {
  using Kind = wire::Request::Kind;
  switch (call.request.kind) {
    case Kind::pause:
    case Kind::resume:
      if (stepping_) calls_.refused(*stepping_, "Another request has ended this step.");
      stepping_.reset();
      set_paused(call.request.kind == Kind::pause);
      return calls_.done(call, tick);
    case Kind::step:
      if (!is_paused_ || stepping_ || call.request.ticks == 0) {
        return calls_.refused(call, "The replay is not paused, or steps already.");
      }
      steps_left_ = call.request.ticks;
      stepping_ = call;
      return set_paused(false);
    case Kind::shutdown:
      is_over_ = true;
      return calls_.done(call, tick);
    default:
      calls_.refused(call, "This is a recording: it can be paused and stepped, not changed.");
  }
}

void ViewerControls::stepped(std::uint64_t tick) {
  if (!stepping_ || --steps_left_ > 0) return;
  set_paused(true);
  calls_.done(*std::exchange(stepping_, std::nullopt), tick);
}

}  // namespace ziggurat::rerun
