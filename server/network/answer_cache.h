// SPDX-License-Identifier: MIT
#pragma once
// Answers to requests that change nothing, `status` and `read`: clients that ask the same while
// nothing has changed get the same answer, which is computed once.

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "wire/answer.h"
#include "wire/outbox.h"
#include "wire/request.h"

namespace ziggurat::network {

class AnswerCache {
 public:
  using Write = std::function<void(wire::Outbox&)>;

  /// State that the kept answers describe.
  struct Version {
    std::uint64_t changes = 0;  ///< another number: answers have changed
    std::uint64_t commands =
        0;  ///< another number: sessions have answered the tick, told a little later
  };
  /// @param write  writes the answer with number 0
  wire::Answer& find(const wire::Request& request, const Version& version, const Write& write);

 private:
  struct Entry {
    wire::Request::Kind kind;
    std::vector<std::string> entities;
    wire::Answer answer;
  };

  std::vector<Entry> entries_;
  Version version_;
  std::chrono::steady_clock::time_point made_{};  // the first of them
  wire::Outbox outbox_;
};

}  // namespace ziggurat::network
