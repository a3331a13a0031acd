#pragma once
// A connection without encryption: ZeroMQ's wire protocol (RFC 37) on a socket of our own. libzmq hands each message
// to a thread and takes it from one; without them a tick needs two wake-ups of a processor instead of four. And it reads
// ahead, as many frames as a server likes to send: here one frame is read at a time, so that its longest is all that a
// server can make a client keep.

#include <chrono>
#include <cstdint>
#include <future>
#include <string>

#include "plain_endpoint.h"
#include "transport.h"
#include "zmtp/frame.h"

namespace ziggurat {

class PlainStream final : public Transport {
 public:
  /// Starts to connect; the server may start later.
  explicit PlainStream(PlainEndpoint endpoint);
  ~PlainStream() override;
  PlainStream(const PlainStream&) = delete;
  PlainStream& operator=(const PlainStream&) = delete;

  void send(std::size_t size, const std::function<void(char*)>& write) override;
  bool receive(std::chrono::milliseconds timeout) override;
  std::string_view content() override { return content_; }
  bool has_more() const override { return has_more_; }
  bool was_closed() override;
  bool is_accepted() override { return is_connected(); }
  void linger() override { lingers_ = true; }

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { closed, looking_up, connecting, greeting, ready, open };  // in this order
  enum class Step { incomplete, passed, message };

  bool is_connected() const { return stage_ >= Stage::greeting; }
  bool has_output() const;
  void go_on();
  void connect();
  void greet();
  void close();
  void make_room();
  bool wait(Clock::time_point end, short events);
  void flush();
  bool fill();
  Step take();
  void end_greeting();
  Step take_greeting(zmtp::Bytes input);
  bool take_command(zmtp::Bytes body);

  PlainEndpoint endpoint_;
  std::future<SocketAddress> address_;  // while it is looked up
  int socket_ = -1;
  Stage stage_ = Stage::closed;
  Clock::time_point next_try_{}, handshake_end_{};
  bool has_greeted_ = false, was_open_ = false, lingers_ = false;
  std::string handshake_;  // of our end, what is not sent yet
  std::string output_;     // messages; sent when the connection is open
  std::size_t sent_ = 0;   // of output_ [bytes]
  std::string input_;      // its first filled_ bytes have arrived
  std::size_t filled_ = 0, taken_ = 0;
  std::size_t frame_ = 0;     // of the input, not whole yet: its size, if that is known [bytes]
  std::string_view content_;  // into input_
  bool has_more_ = false;
  bool is_protected_ = false;  // the server asks for keys
  bool is_broken_ = false;     // nothing can be sent any more
};

}  // namespace ziggurat
