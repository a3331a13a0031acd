#pragma once
// A socket that takes connections, and the thread that serves them, with Boost.Asio.

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstdint>
#include <functional>
#include <string_view>
#include <thread>

#include "http/address.h"

namespace ziggurat::http {

class Listening {
 public:
  using Take = std::function<void(boost::asio::ip::tcp::socket)>;

  /// @param option  of the program, for messages
  /// @throws std::runtime_error if it can't listen there
  Listening(boost::asio::io_context& io, std::string_view option, const Address& address, Take take);

  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  void close();

 private:
  void accept();

  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  Take take_;
};

/// A thread that serves, at a lower priority than the others: clients that keep it busy leave the processors to
/// the run. Signals are for the main thread: it gets none.
std::thread serve(boost::asio::io_context& io);

}  // namespace ziggurat::http
