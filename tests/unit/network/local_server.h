// SPDX-License-Identifier: MIT
#pragma once
// A server on this machine, for tests on real sockets.

#include <chrono>

#include "network/server.h"

namespace ziggurat::network {

constexpr Wait patience{std::chrono::milliseconds{20'000}, {}};

inline Config local_config() {
  Config config;
  config.endpoints = {"tcp://127.0.0.1:*"};
  return config;
}

}  // namespace ziggurat::network
