// SPDX-License-Identifier: MIT
#include "supervision/callers.h"

#include <algorithm>
#include <iterator>

#include "wire/outbox.h"

namespace ziggurat::supervision {

std::vector<network::Call> Callers::take() {
  if (is_held_) return {};
  std::vector<network::Call> calls = server_.take_calls();
  if (local_.take) std::ranges::move(local_.take(), std::back_inserter(calls));
  return calls;
}

bool Callers::can_hear(const network::Call& call) const {
  return call.is_local ? local_.can_hear(call) : server_.can_hear(call);
}

void Callers::done(const network::Call& call, std::uint64_t tick) {
  using Kind = wire::Request::Kind;
  const Kind kind = call.request.kind;
  if (kind == Kind::move || kind == Kind::set_joint || kind == Kind::spawn || kind == Kind::remove)
    ++changes_;
  if (call.is_local) {
    server_.answer(call, [](wire::Outbox&) {});  // no connection has it: questions get new answers
    return local_.done(call, tick);
  }
  server_.answer(call, [&](wire::Outbox& outbox) { outbox.response(call.request.id, tick); });
}

void Callers::refused(const network::Call& call, const wire::Fault& fault) {
  if (call.is_local) return local_.refused(call, fault.message);
  server_.answer(call, [&](wire::Outbox& outbox) { outbox.response(call.request.id, fault); });
}

void answer_waiting(std::vector<network::Call>& waiting, const Callers& callers,
                    const std::function<Reply(const network::Call&)>& answer) {
  std::vector<std::string> busy;  // connections with an earlier request that still waits
  std::erase_if(waiting, [&](const network::Call& call) {
    if (!callers.can_hear(call)) return true;
    if (std::ranges::find(busy, call.peer) != busy.end()) return false;
    if (answer(call) == Reply::given) return true;
    busy.push_back(call.peer);
    return false;
  });
}

}  // namespace ziggurat::supervision
