#include "connection.h"

#include <algorithm>
#include <cstdint>

#include "ziggurat/error.h"

namespace ziggurat {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds slice{500};  // between checks of whether the connection is open

}  // namespace

Connection::Connection(const Options& options)
    : endpoint_(options.endpoint), transport_(make_transport(options)) {}

Connection::~Connection() {
  if (is_expected_open_ && !is_closed_) transport_->linger();
}

void Connection::expect_open() {
  is_expected_open_ = true;
  transport_->expect_open();
}

void Connection::send(const v1::ClientMessage& message) {
  transport_->send(message.ByteSizeLong(), [&](char* to) {
    message.SerializeWithCachedSizesToArray(reinterpret_cast<std::uint8_t*>(to));
  });
}

std::optional<Connection::Kind> Connection::receive(std::optional<milliseconds> timeout,
                                                    const std::function<bool()>& is_interrupted) {
  const auto end = Clock::now() + timeout.value_or(milliseconds{0});
  milliseconds rest = timeout.value_or(slice);
  for (;;) {
    if (transport_->receive(std::clamp(rest, milliseconds{0}, slice))) return parse();
    if (transport_->was_closed()) {
      is_closed_ = true;
      // Messages that the server sent before may still be in the queue.
      if (transport_->receive(milliseconds{0})) return parse();
      throw ConnectionError(endpoint_ + ": the server closed the connection");
    }
    if (is_interrupted && is_interrupted()) return std::nullopt;
    if (!timeout) continue;
    rest = std::chrono::ceil<milliseconds>(end - Clock::now());
    if (rest.count() <= 0) return std::nullopt;
  }
}

}  // namespace ziggurat
