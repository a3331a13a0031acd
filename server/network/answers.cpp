#include "network/answers.h"

#include <algorithm>

namespace ziggurat::network {
namespace {

constexpr std::size_t most_kept = 8;                   // different questions
constexpr std::chrono::milliseconds longest_age{100};  // a status has times in it

}  // namespace

wire::Answer& Answers::find(const wire::Request& request, std::uint64_t changes,
                            const Write& write) {
  const auto now = std::chrono::steady_clock::now();
  if (changes != changes_ || now - made_ > longest_age) {
    kept_.clear();
    changes_ = changes;
    made_ = now;
  }
  const auto found = std::ranges::find_if(kept_, [&](const Kept& each) {
    return each.kind == request.kind && each.entities == request.entities;
  });
  if (found != kept_.end()) return found->answer;
  write(outbox_);
  if (kept_.size() == most_kept) kept_.erase(kept_.begin());
  kept_.push_back({request.kind, request.entities, wire::Answer(outbox_.message())});
  return kept_.back().answer;
}

}  // namespace ziggurat::network
