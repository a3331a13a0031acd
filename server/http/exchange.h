// SPDX-License-Identifier: MIT
#pragma once
// Requests over HTTP and their answers on one connection, with Boost.Beast; GET and HEAD without a
// body. Only sources of ports include this: Beast takes the compiler long.

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "http/answer.h"

namespace ziggurat::http {

using Tcp = boost::asio::ip::tcp;
using Error = boost::beast::error_code;
using Stream = boost::beast::tcp_stream;
using Request = boost::beast::http::request<boost::beast::http::empty_body>;
using Response = boost::beast::http::response<boost::beast::http::string_body>;

inline std::string_view view_of(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

/// Service of a port, and its timeouts.
struct Service {
  std::string host;                        ///< what clients may call it, see allows_host()
  bool any_host = false;                   ///< any name
  std::chrono::milliseconds time{10'000};  ///< for a request, and for its answer
  bool keeps_open = true;  ///< false: one request per connection, and the time is for all of it
  /// @param etag  of `If-None-Match`; empty: none
  std::function<Answer(std::string_view target, std::string_view etag)> get;
  std::function<void(const Request&, Response&)> decorate = {};  ///< adds fields; may be empty

  // Handlers of WebSocket handshakes; if both are empty, handshakes are requests as others.
  std::function<std::optional<Answer>(const Request&)> refuse_upgrade = {};
  std::function<void(Stream, const Request&)> upgrade = {};
};

/// [bytes], of a request with all its fields
constexpr std::uint32_t longest_header = 8 * 1024;

class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  /// @param service  must outlive this
  /// @param ended  is called when the connection ends, also by an upgrade
  Exchange(Tcp::socket socket, const Service& service, std::function<void()> ended);
  ~Exchange();

  /// Reads and answers until the connection ends.
  void start();
  void close() { stream_.close(); }

 private:
  void read();
  void parse();
  void handle(Request request);
  void write(Response response);

  Stream stream_;
  const Service& service_;
  std::function<void()> ended_;
  boost::beast::flat_buffer buffer_;
  std::size_t received_ = 0;  // [bytes] of the request
  std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
};

/// The bytes of the answer to the bytes of a request, as a connection gives it; one that is not
/// complete is a bad one.
std::string answer_to(std::string_view request, const Service& service);

}  // namespace ziggurat::http
