// SPDX-License-Identifier: MIT
#include "network/answer_cache.h"

#include <algorithm>

namespace ziggurat::network {
namespace {

constexpr std::size_t most_kept = 8;                   // different questions
constexpr std::chrono::milliseconds longest_age{100};  // a status has times in it
constexpr std::chrono::milliseconds longest_age_of_commands{10};

}  // namespace

wire::Answer& AnswerCache::find(const wire::Request& request, const Version& version,
                                const Write& write) {
  const auto now = std::chrono::steady_clock::now();
  const auto most = version.commands == version_.commands ? longest_age : longest_age_of_commands;
  if (version.changes != version_.changes || now - made_ > most) {
    entries_.clear();
    version_ = version;
    made_ = now;
  }
  const auto found = std::ranges::find_if(entries_, [&](const Entry& each) {
    return each.kind == request.kind && each.entities == request.entities;
  });
  if (found != entries_.end()) return found->answer;
  write(outbox_);
  if (entries_.size() == most_kept) entries_.erase(entries_.begin());
  entries_.push_back({request.kind, request.entities, wire::Answer(outbox_.message())});
  return entries_.back().answer;
}

}  // namespace ziggurat::network
