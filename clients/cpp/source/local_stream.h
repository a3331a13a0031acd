#pragma once
// A connection to a server on this machine, without encryption: ZeroMQ's wire protocol (RFC 37) on
// a socket of our own. libzmq hands each message to a thread and takes it from one; without them a
// tick needs two wake-ups of a processor instead of four.

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "transport.h"
#include "zmtp/frame.h"

namespace ziggurat {

class LocalStream final : public Transport {
 public:
  /// The path of an endpoint that this class can connect to.
  static std::optional<std::string> path_of(const SessionOptions& options);

  /// Starts to connect; the server may start later.
  explicit LocalStream(const SessionOptions& options);
  ~LocalStream() override;
  LocalStream(const LocalStream&) = delete;
  LocalStream& operator=(const LocalStream&) = delete;

  void send(std::size_t size, const std::function<void(char*)>& write) override;
  bool receive(std::chrono::milliseconds timeout) override;
  std::string_view content() override { return content_; }
  bool has_more() const override { return has_more_; }
  bool was_closed() override;
  bool is_accepted() override { return stage_ != Stage::closed; }
  void linger() override { lingers_ = true; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { closed, greeting, ready, open };
  enum class Step { incomplete, passed, message };

  void connect();
  void close();
  bool wait(Clock::time_point end);
  void flush();
  bool fill();
  Step take();
  Step take_greeting(zmtp::Bytes input);
  bool take_command(zmtp::Bytes body);

  std::string path_;
  int socket_ = -1;
  Stage stage_ = Stage::closed;
  Clock::time_point next_try_{};
  bool was_open_ = false, lingers_ = false;
  std::string handshake_;  // of our end, what is not sent yet
  std::string output_;     // messages; sent when the connection is open
  std::size_t sent_ = 0;   // of output_ [bytes]
  std::string input_;      // its first filled_ bytes have arrived
  std::size_t filled_ = 0, taken_ = 0;
  std::string_view content_;  // into input_
  bool has_more_ = false;
  bool is_protected_ = false;  // the server asks for keys
};

}  // namespace ziggurat
