// SPDX-License-Identifier: MIT
#include "http/exchange.h"

#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include "http/address.h"

namespace ziggurat::http {
namespace {

namespace beast = boost::beast;
using Field = beast::http::field;

/// Whether the client takes bodies in gzip (RFC 9110, section 12.5.3).
bool takes_gzip(const Request& request) {
  for (const auto& [name, parameters] : beast::http::ext_list(request[Field::accept_encoding])) {
    if (!beast::iequals(name, "gzip")) continue;
    for (const auto& [key, value] : beast::http::param_list(parameters)) {
      if (beast::iequals(key, "q") && value.find_first_of("123456789") == value.npos) return false;
    }
    return true;
  }
  return false;
}

const char* cache_control(const Answer& answer) {
  if (answer.etag.empty()) return "no-store";
  return answer.is_immutable ? "public, max-age=31536000, immutable" : "no-cache";
}

/// Place of a redirection: of another port, under the name by which the client called this one.
std::string place_of(const Request& request, const Answer& answer) {
  if (answer.port == 0) return answer.location;
  const std::string_view called = without_port(view_of(request[Field::host]));
  return "//" + std::string(called.empty() ? "127.0.0.1" : called) + ":" +
         std::to_string(answer.port) + answer.location;
}

/// @param request  may be half read
/// It closes the connection.
Response make_response(const Request& request, Answer from) {
  Response response(static_cast<beast::http::status>(from.status), 11);
  response.set(Field::server, "ziggurat");
  response.set(Field::content_type, from.type);
  response.set("X-Content-Type-Options", "nosniff");
  response.set(Field::cache_control, cache_control(from));
  if (!from.etag.empty()) response.set(Field::etag, from.etag);
  if (!from.location.empty()) response.set(Field::location, place_of(request, from));
  if (!from.gzipped.empty()) {
    response.set(Field::vary, "Accept-Encoding");
    if (takes_gzip(request)) {
      response.set(Field::content_encoding, "gzip");
      from.body = std::move(from.gzipped);
    }
  }
  response.keep_alive(false);
  const std::size_t size = from.body.size();
  if (request.method() != beast::http::verb::head) response.body() = std::move(from.body);
  response.content_length(size);
  return response;
}

Answer refusal(unsigned status, const std::string& why) {
  return {status, Answer().type, {}, std::to_string(status) + ": " + why + ".\n"};
}

/// Refusal of bytes that are no request, or are too long for one.
Answer refusal(Error error) {
  return error == beast::http::error::header_limit || error == beast::http::error::buffer_overflow
             ? refusal(431, "the request is too long")
             : refusal(400, "this is no request over HTTP");
}

bool has_body(const Request& request) {
  return request.count(Field::content_length) > 0 || request.count(Field::transfer_encoding) > 0;
}

/// Whether another program, such as a proxy, could read it as another request: who is called, who
/// asks and where it ends are told once, and as is known here.
bool is_ambiguous(const Request& request) {
  const bool is_upgrade = beast::websocket::is_upgrade(request);
  return request.count(Field::host) > 1 || request.count(Field::origin) > 1 ||
         (is_upgrade && has_body(request)) ||
         (request.count(Field::transfer_encoding) > 0 && !request.chunked());
}

Answer answer_of(const Request& request, const Service& service) {
  if (is_ambiguous(request)) {
    return refusal(400, "Host, Origin and the length of the request must be told once");
  }
  if (!service.any_host && !allows_host(service.host, view_of(request[Field::host]))) {
    return refusal(403, "this server is called by its number or localhost only");
  }
  const auto method = request.method();
  if (method != beast::http::verb::get && method != beast::http::verb::head) {
    return refusal(405, "only GET and HEAD are served");
  }
  return service.get(view_of(request.target()), view_of(request[Field::if_none_match]));
}

Response respond(const Request& request, const Service& service) {
  const bool keeps_open = service.keeps_open && request.keep_alive() && !has_body(request);
  Response response = make_response(request, answer_of(request, service));
  response.keep_alive(keeps_open && response.result_int() < 400);
  if (service.decorate) service.decorate(request, response);
  return response;
}

void bound(beast::http::request_parser<beast::http::empty_body>& parser) {
  parser.header_limit(longest_header);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // it is not read
}

}  // namespace

Exchange::Exchange(Tcp::socket socket, const Service& service, std::function<void()> ended)
    : stream_(std::move(socket)), service_(service), ended_(std::move(ended)) {}

Exchange::~Exchange() { ended_(); }

void Exchange::start() {
  stream_.expires_after(service_.time);
  read();
}

void Exchange::read() {
  parser_.emplace();
  bound(*parser_);
  received_ = buffer_.size();
  parse();
}

/// Parses the bytes that have arrived, and reads more until the request's header is complete. A
/// body is never read.
void Exchange::parse() {
  Error error;
  buffer_.consume(parser_->put(buffer_.cdata(), error));
  if (parser_->is_header_done()) return handle(parser_->release());
  if (error == beast::http::error::need_more && received_ >= longest_header) {
    error = beast::http::error::header_limit;
  }
  if (error && error != beast::http::error::need_more) {
    return write(make_response({}, refusal(error)));
  }
  stream_.async_read_some(buffer_.prepare(longest_header - received_),
                          [self = shared_from_this()](Error ended, std::size_t count) {
                            if (ended) return;
                            self->buffer_.commit(count);
                            self->received_ += count;
                            self->parse();
                          });
}

void Exchange::handle(Request request) {
  const bool is_allowed =
      !is_ambiguous(request) &&
      (service_.any_host || allows_host(service_.host, view_of(request[Field::host])));
  if (is_allowed && service_.upgrade && beast::websocket::is_upgrade(request)) {
    if (auto refused = service_.refuse_upgrade(request)) {
      return write(make_response(request, *std::move(refused)));
    }
    stream_.expires_never();
    return service_.upgrade(std::move(stream_), request);
  }
  write(respond(request, service_));
}

void Exchange::write(Response response) {
  auto held = std::make_shared<Response>(std::move(response));
  if (service_.keeps_open) stream_.expires_after(service_.time);
  beast::http::async_write(stream_, *held,
                           [self = shared_from_this(), held](Error error, std::size_t) {
                             if (!error && held->keep_alive()) return self->start();
                             Error ignored;
                             self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                           });
}

std::string answer_to(std::string_view request, const Service& service) {
  beast::http::request_parser<beast::http::empty_body> parser;
  bound(parser);
  Error error;
  parser.put(boost::asio::const_buffer(request.data(), request.size()), error);
  std::ostringstream out;
  if (parser.is_header_done()) {
    out << respond(parser.get(), service);
  } else {
    out << make_response({}, refusal(error));
  }
  return out.str();
}

}  // namespace ziggurat::http
