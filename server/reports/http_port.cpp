#include "reports/http_port.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "text/trim.h"

namespace ziggurat::reports {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t most_clients = 16;             // the oldest makes place
constexpr std::size_t longest_request = 8 * 1024;    // [bytes] with all headers
constexpr std::chrono::seconds time_of_a_client{5};  // from its connection to the end of the answer
constexpr std::string_view end_of_header = "\r\n\r\n", end_of_line = "\r\n";

std::string make_answer(std::string_view status, const HttpPort::Content& content) {
  return fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}",
      status, content.type, content.text.size(), content.text);
}

std::string make_error(std::string_view status) {
  return make_answer(status, {"text/plain", fmt::format("{}\n", status)});
}

bool starts_without_case(std::string_view text, std::string_view beginning) {
  return text.size() >= beginning.size() &&
         std::equal(
             beginning.begin(), beginning.end(), text.begin(),
             [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

/// What the request calls this machine, without port and in small letters; none if it does not say.
std::optional<std::string> host_of(std::string_view header) {
  constexpr std::string_view name = "Host:";
  for (std::size_t at = header.find(end_of_line); at != std::string_view::npos;
       at = header.find(end_of_line, at)) {
    at += end_of_line.size();
    std::string_view line = header.substr(at, header.find(end_of_line, at) - at);
    if (!starts_without_case(line, name)) continue;
    line = text::trimmed(line.substr(name.size()));
    const std::size_t port = line.rfind(':');
    const bool has_port = port != std::string_view::npos && line.find(']', port) == line.npos;
    std::string host(has_port ? line.substr(0, port) : line);
    std::ranges::transform(host, host.begin(), [](unsigned char c) { return std::tolower(c); });
    return host;
  }
  return std::nullopt;
}

bool is_same_name(std::string_view a, std::string_view b) {
  return a.size() == b.size() && starts_without_case(a, b);
}

bool is_number_of_a_machine(std::string host) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  std::uint8_t address[16];
  return ::inet_pton(AF_INET, host.c_str(), address) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), address) == 1;
}

}  // namespace

std::string answer_to(std::string_view request, const std::string& host,
                      const HttpPort::Read& read) {
  const std::size_t end = request.find(end_of_header);
  if (end == std::string_view::npos) return make_error("431 Request Header Fields Too Large");
  const std::string_view header = request.substr(0, end + end_of_line.size());
  const std::string_view line = header.substr(0, header.find(end_of_line));
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last ||
      !line.substr(last + 1).starts_with("HTTP/1.")) {
    return make_error("400 Bad Request");
  }
  if (line.substr(0, first) != "GET") return make_error("405 Method Not Allowed");
  const auto called = host_of(header);
  const bool is_allowed = !called || host == "*" || is_same_name(*called, host) ||
                          *called == "localhost" || is_number_of_a_machine(*called);
  if (!is_allowed) return make_error("403 Forbidden");
  std::string_view path = line.substr(first + 1, last - first - 1);
  path = path.substr(0, path.find('?'));
  const HttpPort::Content content = read(path);
  return content.type.empty() ? make_error("404 Not Found") : make_answer("200 OK", content);
}

HttpPort::HttpPort(network::Listener listener, std::string host, Read read)
    : listener_(std::move(listener)),
      host_(std::move(host)),
      read_(std::move(read)),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  // Signals are for the main thread: the new one gets none.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { serve(); });
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

HttpPort::~HttpPort() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(wake_.number(), &one, sizeof one);
  thread_.join();
}

void HttpPort::serve() {
  std::vector<pollfd> items;
  for (;;) {
    items.assign({{wake_.number(), POLLIN, 0}, {listener_.number(), POLLIN, 0}});
    const Time now = Clock::now();
    std::erase_if(clients_, [&](const Client& client) { return client.end <= now; });
    for (const Client& client : clients_) {
      const auto wanted = static_cast<short>(client.answer.empty() ? POLLIN : POLLOUT);
      items.push_back({client.descriptor.number(), wanted, 0});
    }
    const auto rest =
        clients_.empty() ? std::chrono::milliseconds{-1}
                         : std::chrono::ceil<std::chrono::milliseconds>(clients_.front().end - now);
    ::poll(items.data(), items.size(), static_cast<int>(rest.count()));
    if (items[0].revents != 0) return;
    auto item = items.begin() + 2;
    for (auto next = clients_.begin(); next != clients_.end();) {
      const auto client = next++;
      const bool is_ready = (item++)->revents != 0;
      if (is_ready && !(client->answer.empty() ? receive(*client) : send(*client))) {
        clients_.erase(client);
      }
    }
    if (items[1].revents != 0) accept();
  }
}

void HttpPort::accept() {
  network::Descriptor descriptor = listener_.accept();
  if (!descriptor.is_open()) {
    // Without descriptors left it would come back here at once, again and again.
    if (errno == EMFILE || errno == ENFILE)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return;
  }
  if (clients_.size() >= most_clients) clients_.pop_front();
  clients_.push_back({std::move(descriptor), Clock::now() + time_of_a_client, {}, {}});
}

/// False if the connection is over.
bool HttpPort::receive(Client& client) const {
  char part[2048];
  const ssize_t size = ::recv(client.descriptor.number(), part, sizeof part, 0);
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  if (size == 0) return false;
  client.request.append(part, static_cast<std::size_t>(size));
  const bool is_complete = client.request.find(end_of_header) != std::string::npos;
  if (!is_complete && client.request.size() < longest_request) return true;
  client.answer = reports::answer_to(client.request, host_, read_);
  return send(client);
}

/// False if the connection is over.
bool HttpPort::send(Client& client) const {
  const ssize_t size =
      ::send(client.descriptor.number(), client.answer.data(), client.answer.size(), MSG_NOSIGNAL);
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  client.answer.erase(0, static_cast<std::size_t>(size));
  if (!client.answer.empty()) return true;
  ::shutdown(client.descriptor.number(), SHUT_WR);
  return false;
}

}  // namespace ziggurat::reports
