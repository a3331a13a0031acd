// SPDX-License-Identifier: MIT
#pragma once
// A socket that takes connections, and the thread that serves them, with Boost.Asio.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string_view>
#include <thread>

#include "http/address.h"

namespace ziggurat::http {

/// Takes connections as they come up to a number in a period; those beyond it wait in the system
/// until the next one. Who connects without end takes little of the processors.
class Listening {
 public:
  static constexpr int most_in_period = 20;
  static constexpr std::chrono::milliseconds period{100};

  using Take = std::function<void(boost::asio::ip::tcp::socket)>;

  /// @param option  of the program, for messages
  /// @throws std::runtime_error if it can't listen there
  Listening(boost::asio::io_context& io, std::string_view option, const Address& address,
            Take take);

  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  void close();

 private:
  using Clock = std::chrono::steady_clock;

  void accept();
  void accept_at(Clock::time_point time);

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  Take take_;
  Clock::time_point period_begun_ = Clock::now();
  int taken_ = 0;  // in this period
};

/// A thread that serves, at a lower priority than the others: clients that keep it busy leave the
/// processors to the run. Signals are for the main thread: it gets none.
std::thread serve(boost::asio::io_context& io);

}  // namespace ziggurat::http
