// Boost.Beast is in this source only: it takes the compiler long.
#include "view/server.h"

#include <fmt/format.h>
#include <signal.h>

#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <list>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include "text/numbers.h"
#include "view/hub.h"
#include "view/page.h"

namespace ziggurat::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Error = beast::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

constexpr std::uint16_t usual_port = 8765;
constexpr std::chrono::seconds request_time{10};  // for a request and for its answer
constexpr std::chrono::seconds silence{60};       // of a viewer, answers to pings included
constexpr std::uint32_t longest_header = 8 * 1024;                         // [bytes]
constexpr std::size_t longest_message_to_look = std::size_t{64} << 10;     // [bytes]
constexpr std::size_t longest_message_to_steer = std::size_t{2} << 20;     // [bytes]
constexpr std::array protocols{"foxglove.websocket.v1", "foxglove.sdk.v1"};
constexpr int most_posted = 64;  // ticks on their way to the server's thread

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

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

/// What all connections share; everything in it is used on the server's thread only.
struct Shared {
  Rules rules;
  Page page;
  Hub hub;
  std::size_t connections = 0;
  bool is_closing = false;
  std::set<class ViewerConnection*> open{};
};

// --- viewers --------------------------------------------------------------------------------------

class ViewerConnection : public std::enable_shared_from_this<ViewerConnection> {
 public:
  ViewerConnection(beast::tcp_stream stream, Shared& shared)
      : socket_(std::move(stream)), shared_(shared) {
    ++shared_.connections;
  }
  ~ViewerConnection() { --shared_.connections; }

  void start(const Request& request, bool may_steer) {
    websocket::stream_base::timeout times{request_time, silence, true};
    socket_.set_option(times);
    socket_.read_message_max(may_steer ? longest_message_to_steer : longest_message_to_look);
    socket_.auto_fragment(false);
    const std::string protocol = protocol_in(view_of(request[http::field::sec_websocket_protocol]));
    socket_.set_option(websocket::stream_base::decorator([protocol](auto& response) {
      response.set(http::field::sec_websocket_protocol, protocol);
      response.set(http::field::server, "ziggurat");
    }));
    socket_.async_accept(request, [self = shared_from_this(), may_steer](Error error) {
      if (!error) self->opened(may_steer);
    });
  }

  /// Sends what waits, or ends the connection if it is to be ended.
  void pump() {
    if (!viewer_) return;
    if (viewer_->is_over) return close();
    if (is_writing_) return;
    std::optional<Item> item = viewer_->output.next();
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
    shared_.hub.remove(std::exchange(viewer_, nullptr)->id);
    beast::get_lowest_layer(socket_).close();
  }

  /// Tells the viewer that the server ends, if that can be sent now.
  void end() {
    if (is_writing_) return close();
    shared_.hub.remove(std::exchange(viewer_, nullptr)->id);
    socket_.async_close(websocket::close_code::going_away, [self = shared_from_this()](Error) {});
  }

 private:
  void opened(bool may_steer) {
    if (shared_.is_closing || shared_.hub.size() >= Server::most_viewers) {
      return socket_.async_close(websocket::close_code::try_again_later,
                                 [self = shared_from_this()](Error) {});
    }
    viewer_ = &shared_.hub.add(may_steer);
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
                                self->socket_.got_text());
      self->buffer_.consume(self->buffer_.size());
      self->pump();
      if (self->viewer_) self->read();
    });
  }

  websocket::stream<beast::tcp_stream> socket_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  Viewer* viewer_ = nullptr;
  Item sent_;
  bool is_writing_ = false;
};

// --- requests over HTTP ---------------------------------------------------------------------------

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Shared& shared)
      : stream_(std::move(socket)), shared_(shared) {
    ++shared_.connections;
  }
  ~HttpConnection() { --shared_.connections; }

  void read() {
    parser_.emplace();
    parser_->header_limit(longest_header);
    parser_->body_limit(0);
    stream_.expires_after(request_time);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](Error error, std::size_t) {
                       if (!error) self->handle(self->parser_->release());
                     });
  }

 private:
  void handle(Request request) {
    const std::string_view host = view_of(request[http::field::host]);
    const std::string_view target = view_of(request.target());
    const bool is_viewer = websocket::is_upgrade(request);
    if (!allows_host(shared_.rules, host)) {
      return answer(request, {403, Answer().type, {},
                              "403: this server is called by its number or localhost only.\n"});
    }
    if (is_viewer) return upgrade(std::move(request));
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return answer(request, {405, Answer().type, {}, "405: only GET and HEAD are served.\n"});
    }
    answer(request,
           shared_.page.get(target, view_of(request[http::field::if_none_match])));
  }

  void upgrade(Request request) {
    const std::string_view target = view_of(request.target());
    Asker asker{view_of(request[http::field::host]), std::nullopt, target};
    if (request.count(http::field::origin) > 0) {
      asker.origin = view_of(request[http::field::origin]);
    }
    const Access access = access_of(shared_.rules, asker);
    if (access == Access::refused) {
      return answer(request, {403, Answer().type, {},
                              "403: open the address with ?token= that the program printed.\n"});
    }
    if (target.substr(0, target.find('?')) != "/") {
      return answer(request, {404, Answer().type, {}, "404: viewers connect to / only.\n"});
    }
    if (protocol_in(view_of(request[http::field::sec_websocket_protocol])).empty()) {
      return answer(request, {400, Answer().type, {},
                              "400: the subprotocol must be foxglove.websocket.v1.\n"});
    }
    stream_.expires_never();
    std::make_shared<ViewerConnection>(std::move(stream_), shared_)
        ->start(request, access == Access::steer);
  }

  void answer(const Request& request, Answer from) {
    auto response = std::make_shared<Response>(
        static_cast<http::status>(from.status), request.version());
    response->set(http::field::server, "ziggurat");
    response->set(http::field::content_type, from.type);
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Referrer-Policy", "no-referrer");
    response->set("Content-Security-Policy",
                  content_security_policy(view_of(request[http::field::host])));
    response->set(http::field::cache_control, from.etag.empty() ? "no-store" : "no-cache");
    if (!from.etag.empty()) response->set(http::field::etag, from.etag);
    response->keep_alive(request.keep_alive() && from.status < 400);
    const std::size_t size = from.body.size();
    if (request.method() != http::verb::head) response->body() = std::move(from.body);
    response->content_length(size);
    stream_.expires_after(request_time);
    http::async_write(stream_, *response,
                      [self = shared_from_this(), response](Error error, std::size_t) {
                        if (!error && response->keep_alive()) return self->read();
                        Error ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  beast::tcp_stream stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
};

// --- listening ------------------------------------------------------------------------------------

tcp::acceptor listen(asio::io_context& io, const Address& address) {
  Error error;
  const std::string host = address.host == "localhost" ? "127.0.0.1" : address.host;
  const auto found = tcp::resolver(io).resolve(host, std::to_string(address.port),
                                               tcp::resolver::passive, error);
  const auto fail = [&](const std::string& what) {
    return std::runtime_error(
        fmt::format("--view: {}:{} can't be opened: {}", address.host, address.port, what));
  };
  if (error || found.empty()) throw fail(error.message());
  const tcp::endpoint endpoint = found.begin()->endpoint();
  tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) throw fail(error.message());
  return acceptor;
}

tcp::acceptor listen(asio::io_context& io, const std::optional<Address>& address) {
  if (address) return listen(io, *address);
  try {
    return listen(io, Address{"127.0.0.1", usual_port});
  } catch (const std::runtime_error&) {
    return listen(io, Address{"127.0.0.1", 0});
  }
}

Rules rules_of(const Settings& settings) {
  const std::string host = settings.address ? settings.address->host : "127.0.0.1";
  const bool is_open = !is_loopback(host);
  if (is_open && !settings.insecure && settings.token.empty()) {
    throw text::UsageError(fmt::format(
        "--view: other machines can reach {}; use 127.0.0.1, or add --view-token TOKEN with a token "
        "of your own, or --insecure",
        host));
  }
  if (!settings.token.empty()) check_token(settings.token);
  return {host, settings.insecure, is_open && !settings.insecure,
          settings.token.empty() ? random_token() : settings.token};
}

}  // namespace

struct Server::State {
  explicit State(const Settings& settings)
      : shared{rules_of(settings), Page(settings.folder),
               Hub({settings.version, settings.scene, random_token()}, settings.parameters, desk)},
        acceptor(listen(io, settings.address)),
        pause(io) {
    accept();
    // Signals are for the main thread: the new one gets none.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    thread = std::thread([this] { io.run(); });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  void accept() {
    acceptor.async_accept([this](Error error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) {  // without descriptors left it would come back here at once, again and again
        pause.expires_after(std::chrono::milliseconds(20));
        return pause.async_wait([this](Error cancelled) {
          if (!cancelled) accept();
        });
      }
      if (shared.connections < most_connections) {
        socket.set_option(tcp::no_delay(true), error);
        std::make_shared<HttpConnection>(std::move(socket), shared)->read();
      }
      accept();
    });
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
      work(shared.hub);
      pump();
    });
  }

  std::string address(const char* scheme) const {
    std::string host = shared.rules.host;
    if (host == "0.0.0.0" || host == "*") host = "127.0.0.1";
    if (host == "::") host = "::1";
    if (host.find(':') != std::string::npos) host = "[" + host + "]";
    return fmt::format("{}://{}:{}/?token={}", scheme, host, acceptor.local_endpoint().port(),
                       shared.rules.token);
  }

  Desk desk;
  Shared shared;
  asio::io_context io{1};  // behind what its connections use
  tcp::acceptor acceptor;
  asio::steady_timer pause;
  std::atomic<int> posted = 0;  // ticks that the thread has not taken yet
  std::vector<channels::Message> held_back;  // of ticks that were not posted
  std::thread thread;
};

Server::Server(const Settings& settings) : state_(std::make_unique<State>(settings)) {}

Server::~Server() {
  State& state = *state_;
  asio::post(state.io, [&state] {
    state.shared.is_closing = true;
    state.acceptor.close();
    const std::vector<ViewerConnection*> all(state.shared.open.begin(), state.shared.open.end());
    for (ViewerConnection* each : all) each->end();
    state.shared.open.clear();
    state.pause.expires_after(std::chrono::milliseconds(100));
    state.pause.async_wait([&state](Error) { state.io.stop(); });
  });
  state.thread.join();
}

std::string Server::page_address() const { return state_->address("http"); }
std::string Server::viewer_address() const { return state_->address("ws"); }
Desk& Server::desk() { return state_->desk; }

void Server::set_channels(std::vector<channels::Channel> list) {
  state_->post([list = std::move(list)](Hub& hub) mutable { hub.set_channels(std::move(list)); });
}

/// If the server's thread is busy, ticks are dropped here already, but for what must arrive.
void Server::show(std::int64_t time_ns, std::vector<channels::Message> messages) {
  State& state = *state_;
  if (!state.held_back.empty()) {
    messages.insert(messages.begin(), state.held_back.begin(), state.held_back.end());
    state.held_back.clear();
  }
  if (state.posted >= most_posted) {
    for (channels::Message& message : messages) {
      if (message.must_arrive && state.held_back.size() < 1000) {
        state.held_back.push_back(std::move(message));
      }
    }
    return;
  }
  ++state.posted;
  state.post([&state, time_ns, messages = std::move(messages)](Hub& hub) {
    --state.posted;
    hub.show(time_ns, messages);
  });
}

void Server::set_parameter(Parameter parameter) {
  state_->post([parameter = std::move(parameter)](Hub& hub) { hub.set_parameter(parameter); });
}

void Server::answer(const Call& call, std::uint64_t tick) {
  state_->post([call, tick](Hub& hub) {
    hub.answer(call, true, fmt::format("{{\"tick\":{}}}", tick));
  });
}

void Server::refuse(const Call& call, const std::string& why) {
  state_->post([call, why](Hub& hub) { hub.answer(call, false, why); });
}

}  // namespace ziggurat::view
