// SPDX-License-Identifier: MIT
#include "http/listening.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <new>
#include <stdexcept>
#include <string>
#include <utility>

namespace ziggurat::http {
namespace {

namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using Error = boost::system::error_code;

constexpr int less_important =
    5;  // a third of the weight of the run's threads, where processors are scarce

Tcp::acceptor listen(asio::io_context& io, std::string_view option, const Address& address) {
  Error error;
  const std::string host = address.host == "localhost" ? "127.0.0.1" : address.host;
  const auto found =
      Tcp::resolver(io).resolve(host, std::to_string(address.port), Tcp::resolver::passive, error);
  const auto fail = [&](const std::string& what) {
    return std::runtime_error(fmt::format(
        "{}: {}:{} can't be opened: {}; the port must be free (0 takes any free one), and "
        "the host one of this machine",
        option, address.host, address.port, what));
  };
  if (error || found.empty()) throw fail(error.message());
  const Tcp::endpoint endpoint = found.begin()->endpoint();
  Tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw fail(error.message());
  return acceptor;
}

}  // namespace

Listening::Listening(asio::io_context& io, std::string_view option, const Address& address,
                     Take take)
    : acceptor_(listen(io, option, address)), pause_(io), take_(std::move(take)) {
  accept();
}

void Listening::accept() {
  const auto now = Clock::now();
  if (now >= period_begun_ + period) {
    period_begun_ = now;
    taken_ = 0;
  }
  if (taken_ >= most_in_period) return accept_at(period_begun_ + period);
  acceptor_.async_accept([this](Error error, Tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    // Without descriptors left it would come back here at once, again and again.
    if (error) return accept_at(Clock::now() + std::chrono::milliseconds(20));
    ++taken_;
    socket.set_option(Tcp::no_delay(true), error);
    try {
      take_(std::move(socket));
    } catch (const std::bad_alloc&) {  // this connection ends; the next one is taken
    }
    accept();
  });
}

void Listening::accept_at(Clock::time_point time) {
  pause_.expires_at(time);
  pause_.async_wait([this](Error cancelled) {
    if (!cancelled) accept();
  });
}

void Listening::close() {
  Error ignored;
  acceptor_.close(ignored);
  pause_.cancel();
}

std::thread serve(asio::io_context& io) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread([&io] {
    [[maybe_unused]] const int niceness = ::nice(less_important);  // of this thread
    for (;;) {
      try {
        io.run();
        return;
      } catch (const std::bad_alloc&) {  // the connection that needed it has ended
      }
    }
  });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace ziggurat::http
