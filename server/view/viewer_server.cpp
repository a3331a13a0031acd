// SPDX-License-Identifier: MIT
// Boost.Beast is in this source only: it takes the compiler long.
#include "view/viewer_server.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <list>
#include <new>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "http/exchange.h"
#include "http/listening.h"
#include "text/hosts.h"
#include "text/numbers.h"
#include "view/feed.h"
#include "view/hub.h"
#include "view/page.h"

namespace ziggurat::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Error = http::Error;
using Field = beast::http::field;

constexpr std::uint16_t usual_port = 8765;
constexpr std::chrono::seconds request_time{10};  // for a request and for its answer
constexpr std::size_t longest_message_to_look = std::size_t{64} << 10;  // [bytes]
constexpr std::size_t longest_message_to_steer = std::size_t{2} << 20;  // [bytes]
// Messages of a viewer: 50 a second, with the token 500, as who drags an entity sends them.
constexpr std::chrono::milliseconds time_of_a_message_to_look{20}, time_of_a_message_to_steer{2};
constexpr int most_messages_at_once = 1000;  // some clients subscribe to each topic by itself
constexpr std::array protocols{"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// The protocol that both speak; empty: there is none.
std::string protocol_in(std::string_view offered) {
  for (const std::string protocol : protocols) {
    for (std::size_t at = 0; at <= offered.size();) {
      const std::size_t comma = std::min(offered.find(',', at), offered.size());
      std::string_view name = offered.substr(at, comma - at);
      while (name.starts_with(' ')) name.remove_prefix(1);
      while (name.ends_with(' ')) name.remove_suffix(1);
      if (name == protocol) return protocol;
      at = comma + 1;
    }
  }
  return {};
}

/// State that all connections share, used on the server's thread only.
struct Shared {
  Rules rules;
  Page page;
  std::chrono::milliseconds silence;  // of a viewer
  Hub hub;
  std::size_t connections = 0;
  bool is_closing = false;
  std::set<class ViewerConnection*> open{};
  std::list<std::weak_ptr<class ViewerConnection>>
      refused{};  // there were too many; the oldest first
};

// --- viewers
// --------------------------------------------------------------------------------------

class ViewerConnection : public std::enable_shared_from_this<ViewerConnection> {
 public:
  ViewerConnection(http::Stream stream, Shared& shared)
      : socket_(std::move(stream)), shared_(shared), turn_(socket_.get_executor()) {
    ++shared_.connections;
  }
  ~ViewerConnection() {
    close();
    --shared_.connections;
  }

  void start(const http::Request& request, Permission permission) {
    const bool may_steer = permission == Permission::steer;
    websocket::stream_base::timeout times{request_time, shared_.silence, true};
    socket_.set_option(times);
    socket_.read_message_max(may_steer ? longest_message_to_steer : longest_message_to_look);
    socket_.auto_fragment(false);
    const std::string protocol = protocol_in(http::view_of(request[Field::sec_websocket_protocol]));
    socket_.set_option(websocket::stream_base::decorator([protocol](auto& response) {
      response.set(Field::sec_websocket_protocol, protocol);
      response.set(Field::server, "ziggurat");
    }));
    socket_.async_accept(request, [self = shared_from_this(), permission](Error error) {
      if (!error) self->opened(permission);
    });
  }

  /// Sends what waits, or ends the connection if it is to be ended.
  void pump() {
    if (!viewer_) return;
    if (viewer_->is_over) return close();
    if (is_writing_) return;
    std::optional<Item> item = shared_.hub.next(*viewer_);
    if (!item) return;
    is_writing_ = true;
    sent_ = std::move(*item);
    socket_.text(sent_.is_text);
    // Pictures are encoded here.
    const std::string_view content =
        sent_.content ? std::string_view(sent_.content->bytes()) : std::string_view();
    const std::array buffers{asio::const_buffer(sent_.head.data(), sent_.head.size()),
                             asio::const_buffer(content.data(), content.size())};
    socket_.async_write(buffers, [self = shared_from_this()](Error error, std::size_t) {
      self->is_writing_ = false;
      self->sent_ = {};
      error ? self->close() : self->pump();
    });
  }

  void close() {
    if (!viewer_) return;
    shared_.open.erase(this);
    turn_.cancel();
    shared_.hub.remove(std::exchange(viewer_, nullptr)->id);
    beast::get_lowest_layer(socket_).close();
  }

  /// At once, of one that was refused and does not go by itself.
  void abandon() { beast::get_lowest_layer(socket_).close(); }

  /// Tells the viewer that the server ends, if that can be sent now.
  void end() {
    if (is_writing_) return close();
    shared_.hub.remove(std::exchange(viewer_, nullptr)->id);
    socket_.async_close(websocket::close_code::going_away, [self = shared_from_this()](Error) {});
  }

 private:
  void opened(Permission permission) {
    const bool may_steer = permission == Permission::steer;
    const std::size_t most = may_steer ? ViewerServer::most_viewers : ViewerServer::most_lookers;
    if (shared_.is_closing || shared_.hub.size() >= most) {
      shared_.refused.push_back(weak_from_this());
      return socket_.async_close(websocket::close_code::try_again_later,
                                 [self = shared_from_this()](Error) {});
    }
    viewer_ = &shared_.hub.add(permission);
    shared_.open.insert(this);
    read();
    pump();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
      if (!self->viewer_) return;
      if (error) return self->close();
      const auto data = self->buffer_.cdata();
      self->shared_.hub.receive(*self->viewer_,
                                {static_cast<const char*>(data.data()), data.size()},
                                self->socket_.got_text() ? Hub::Frame::text : Hub::Frame::binary);
      self->buffer_.consume(self->buffer_.size());
      self->pump();
      if (self->viewer_) self->read_in_time();
    });
  }

  /// Reads on; later if more messages came than a viewer needs, so that each waits its turn in the
  /// system.
  void read_in_time() {
    const auto now = std::chrono::steady_clock::now();
    const auto each = viewer_->may_steer ? time_of_a_message_to_steer : time_of_a_message_to_look;
    paid_until_ = std::max(paid_until_, now - most_messages_at_once * each) + each;
    if (paid_until_ <= now) return read();
    turn_.expires_at(paid_until_);
    turn_.async_wait([self = shared_from_this()](Error error) {
      if (!error && self->viewer_) self->read();
    });
  }

  websocket::stream<http::Stream> socket_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  Viewer* viewer_ = nullptr;
  Item sent_;
  bool is_writing_ = false;
  asio::steady_timer turn_;
  std::chrono::steady_clock::time_point paid_until_{};  // the time of all messages so far
};

// --- the port
// -------------------------------------------------------------------------------------

RequestHead head_of(const http::Request& request) {
  RequestHead head{http::view_of(request[Field::host]), std::nullopt,
                   http::view_of(request.target())};
  if (request.count(Field::origin) > 0) head.origin = http::view_of(request[Field::origin]);
  return head;
}

/// Why a handshake is refused, if it is.
std::optional<http::Answer> refusal_of(const Rules& rules, const http::Request& request) {
  const auto refuse = [](unsigned status, const char* why) {
    return http::Answer{status, http::Answer().type, {}, why};
  };
  const RequestHead head = head_of(request);
  if (permission_of(rules, head) == Permission::refused) {
    return refuse(403, "403: open the address with ?token= that the program printed.\n");
  }
  if (head.target.substr(0, head.target.find('?')) != "/") {
    return refuse(404, "404: viewers connect to / only.\n");
  }
  if (protocol_in(http::view_of(request[Field::sec_websocket_protocol])).empty()) {
    return refuse(400, "400: the subprotocol must be foxglove.websocket.v1.\n");
  }
  return std::nullopt;
}

http::Service service_of(Shared& shared) {
  http::Service service;
  service.host = shared.rules.host;
  service.any_host = shared.rules.any_host;
  service.time = request_time;
  service.get = [&shared](std::string_view target, std::string_view etag) {
    return shared.page.get(target, etag);
  };
  service.decorate = [](const http::Request& request, http::Response& response) {
    response.set("Referrer-Policy", "no-referrer");
    response.set("Content-Security-Policy",
                 content_security_policy(http::view_of(request[Field::host])));
  };
  service.refuse_upgrade = [&shared](const http::Request& request) {
    return refusal_of(shared.rules, request);
  };
  service.upgrade = [&shared](http::Stream stream, const http::Request& request) {
    const Permission permission = permission_of(shared.rules, head_of(request));
    std::make_shared<ViewerConnection>(std::move(stream), shared)->start(request, permission);
  };
  return service;
}

/// The usual port, or a free one.
http::Listening listen(asio::io_context& io, const std::optional<http::Address>& address,
                       const http::Listening::Take& take) {
  if (address) return {io, "--view", *address, take};
  try {
    return {io, "--view", {"127.0.0.1", usual_port}, take};
  } catch (const std::runtime_error&) {
    return {io, "--view", {"127.0.0.1", 0}, take};
  }
}

Rules rules_of(const Settings& settings) {
  const std::string host = settings.address ? settings.address->host : "127.0.0.1";
  const bool is_open = !http::is_loopback(host);
  if (is_open && !settings.insecure && settings.token.empty()) {
    throw text::UsageError(
        fmt::format("--view: other machines can reach {}; use 127.0.0.1, or add --view-token TOKEN "
                    "with a token "
                    "of your own, or --insecure",
                    host));
  }
  if (!settings.token.empty()) check_token(settings.token);
  return {host, settings.insecure, is_open && !settings.insecure,
          settings.token.empty() ? random_token() : settings.token};
}

}  // namespace

struct ViewerServer::State {
  explicit State(const Settings& settings)
      : shared{rules_of(settings), Page(settings.folder), settings.silence,
               Hub({settings.version, settings.scene, random_token()}, settings.parameters,
                   requests)},
        listening(listen(io, settings.address,
                         [this](http::Tcp::socket socket) { take(std::move(socket)); })),
        pause(io),
        thread(http::serve(io)) {}

  /// Ends the oldest connection that is no viewer.
  /// @returns false if there is none
  bool make_place() {
    if (!shared.refused.empty()) {
      shared.refused.front().lock()->abandon();
      shared.refused.pop_front();
    } else if (!exchanges.empty()) {
      exchanges.front().lock()->close();
      exchanges.pop_front();
    } else {
      return false;
    }
    return true;
  }

  void take(http::Tcp::socket socket) {
    const auto is_over = [](const auto& each) { return each.expired(); };
    std::erase_if(shared.refused, is_over);
    std::erase_if(exchanges, is_over);
    if (shared.connections >= most_connections && !make_place()) return;
    ++shared.connections;
    const auto exchange = std::make_shared<http::Exchange>(std::move(socket), service,
                                                           [this] { --shared.connections; });
    exchanges.push_back(exchange);
    exchange->start();
  }

  void pump() {
    const std::vector<ViewerConnection*> all(shared.open.begin(), shared.open.end());
    for (ViewerConnection* each : all) {
      if (shared.open.contains(each)) each->pump();
    }
  }

  template <class Work>
  void post(Work work) {
    asio::post(io, [this, work = std::move(work)]() mutable {
      feed.pass_on(shared.hub);  // what was shown before
      work(shared.hub);
      pump();
    });
  }

  /// Something waits in the feed. Ticks are shown sixty times a second at most, and each wakes the
  /// server's thread: to look for them again and again would cost more.
  void wake() {
    if (is_awake.exchange(true)) return;
    asio::post(io, [this] {
      is_awake = false;
      pass_on();
      pump();
    });
  }

  /// Without memory for what waits it is lost, and the run goes on.
  void pass_on() {
    try {
      feed.pass_on(shared.hub);
    } catch (const std::bad_alloc&) {
    }
  }

  std::string address(const char* scheme) const {
    std::string host = text::host_to_call(shared.rules.host);
    if (host.find(':') != std::string::npos) host = "[" + host + "]";
    return fmt::format("{}://{}:{}/?token={}", scheme, host, listening.port(), shared.rules.token);
  }

  ViewerRequests requests;
  Shared shared;
  http::Service service = service_of(shared);
  std::list<std::weak_ptr<http::Exchange>> exchanges;  // the oldest first
  asio::io_context io{1};                              // behind what its connections use
  http::Listening listening;
  asio::steady_timer pause;
  Feed feed;
  std::atomic<bool> is_awake = false;  // the thread is about to look into the feed
  std::thread thread;
};

ViewerServer::ViewerServer(const Settings& settings) : state_(std::make_unique<State>(settings)) {}

ViewerServer::~ViewerServer() {
  State& state = *state_;
  asio::post(state.io, [&state] {
    state.shared.is_closing = true;
    state.listening.close();
    const std::vector<ViewerConnection*> all(state.shared.open.begin(), state.shared.open.end());
    for (ViewerConnection* each : all) each->end();
    state.shared.open.clear();
    state.pause.expires_after(std::chrono::milliseconds(100));
    state.pause.async_wait([&state](Error) { state.io.stop(); });
  });
  state.thread.join();
}

std::string ViewerServer::page_address() const { return state_->address("http"); }
const std::string& ViewerServer::host() const { return state_->shared.rules.host; }
std::string ViewerServer::viewer_address() const { return state_->address("ws"); }
ViewerRequests& ViewerServer::requests() { return state_->requests; }

void ViewerServer::populate(const channels::Population& population) {
  state_->feed.populate(population);
  state_->wake();
}

void ViewerServer::set_layers(const channels::Layers& layers) { state_->feed.set_layers(layers); }

void ViewerServer::show(const channels::Moment& moment, Wanted wanted) {
  state_->feed.show(moment, std::move(wanted));
  state_->wake();
}

void ViewerServer::show_commands(const channels::Moment& moment,
                                 std::vector<std::uint32_t> wanted) {
  state_->feed.show_commands(moment, std::move(wanted));
  state_->wake();
}

void ViewerServer::show_event(channels::Message message) {
  state_->feed.show_event(std::move(message));
  state_->wake();
}

void ViewerServer::set_parameter(Parameter parameter) {
  state_->post([parameter = std::move(parameter)](Hub& hub) { hub.set_parameter(parameter); });
}

void ViewerServer::answer(const ViewerCall& call, std::uint64_t tick) {
  state_->post([call, tick](Hub& hub) {
    hub.answer(call, Hub::Outcome::done, fmt::format("{{\"tick\":{}}}", tick));
  });
}

void ViewerServer::refuse(const ViewerCall& call, const std::string& why) {
  state_->post([call, why](Hub& hub) { hub.answer(call, Hub::Outcome::refused, why); });
}

}  // namespace ziggurat::view
