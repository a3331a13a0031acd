// SPDX-License-Identifier: MIT
#include "http/port.h"

#include <boost/asio/post.hpp>
#include <cstddef>
#include <list>
#include <utility>

#include "http/exchange.h"
#include "http/listening.h"

namespace ziggurat::http {
namespace {

Service service_of(const std::string& host, const Port::Read& read, const PortOptions& options) {
  Service service;
  service.host = host;
  service.any_host = options.any_host;
  service.time = options.time;
  service.keeps_open = false;
  service.get = [read](std::string_view target, std::string_view) {
    return read(target.substr(0, target.find('?')));
  };
  return service;
}

}  // namespace

struct Port::State {
  State(std::string_view option, const Address& address, const Read& read,
        const PortOptions& options)
      : service(service_of(address.host, read, options)),
        most_clients(options.clients),
        listening(io, option, address, [this](Tcp::socket socket) { take(std::move(socket)); }),
        thread(serve(io)) {}

  void take(Tcp::socket socket) {
    std::erase_if(clients, [](const auto& client) { return client.expired(); });
    if (clients.size() >= most_clients) {
      if (const auto oldest = clients.front().lock()) oldest->close();
      clients.pop_front();
    }
    const auto client = std::make_shared<Exchange>(std::move(socket), service, [] {});
    clients.push_back(client);
    client->start();
  }

  Service service;
  std::size_t most_clients;
  std::list<std::weak_ptr<Exchange>> clients;  // the oldest first
  boost::asio::io_context io{1};               // behind what its connections use
  Listening listening;
  std::thread thread;
};

Port::Port(std::string_view option, const Address& address, Read read, const PortOptions& options)
    : state_(std::make_unique<State>(option, address, read, options)) {}

Port::~Port() {
  state_->io.stop();
  state_->thread.join();
}

std::uint16_t Port::number() const { return state_->listening.port(); }

std::string answer_at_port(std::string_view request, const std::string& host,
                           const Port::Read& read, const PortOptions& options) {
  return answer_to(request, service_of(host, read, options));
}

}  // namespace ziggurat::http
