// SPDX-License-Identifier: MIT
#pragma once
// Two ways to run the same lock-step ticks with messages of the same sizes: with our server, and
// with bare ZeroMQ. Each owns its controller processes.

#include <sys/types.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ziggurat::bench {

/// Keys of connections that CURVE protects.
struct Keys {
  std::string server_secret, server_public, client_public;  ///< Z85
  std::string client_secret;                                ///< path of a file
};

struct Setup {
  std::size_t processes = 1;
  std::size_t robots = 1;  ///< per process
  std::string transport = "ipc";
  std::string client;        ///< path of bench_lockstep_client
  std::optional<Keys> keys;  ///< for our server; none: not encrypted
};

/// Sizes of one session's messages in a tick, on the wire [bytes].
struct Bytes {
  std::size_t observation = 0;
  std::size_t command = 0;
};

/// Child processes; the destructor kills them.
class Processes {
 public:
  void start(const std::string& program, const std::vector<std::string>& arguments);
  ~Processes();

 private:
  std::vector<pid_t> pids_;
};

class Ours {
 public:
  explicit Ours(const Setup& setup);
  ~Ours();
  void tick();
  Bytes bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

class Bare {
 public:
  Bare(const Setup& setup, const Bytes& bytes);
  ~Bare();
  void tick();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::bench
