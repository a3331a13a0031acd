#pragma once
// Listens while there is no world yet, and answers who comes (docs/protocol.md, T9 and H12).

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "network/socket.h"
#include "wire/inbox.h"
#include "wire/outbox.h"

namespace ziggurat::network {

/// When `descriptor` is readable, the world is given up: those who wait are told, nobody listens
/// any more, and the last that the thread does is to call `end`.
struct GiveUp {
  int descriptor = -1;
  std::function<void()> end;
};

class Reception {
 public:
  /// Listens at once; a thread of its own has the socket until that is handed over.
  /// @throws EndpointError
  explicit Reception(const Config& config, GiveUp give_up = {});
  /// Tells whoever still waits that there will be no world.
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  const std::vector<std::string>& endpoints() const { return endpoints_; }

  /// What those who wait are told from now on.
  /// @param progress  0 to 1
  void say(double progress, std::string message);

  /// Somebody whose Hello waits for the world.
  struct Visitor {
    std::string peer;   ///< its connection
    std::string hello;  ///< the whole message
    Roles roles;        ///< that its key allows
  };
  struct HandedOver {
    std::unique_ptr<Socket> socket;
    std::vector<Visitor> visitors;  ///< in the order of arrival
  };
  /// From here on nobody is answered until somebody else does. Once.
  HandedOver hand_over();

 private:
  bool is_readable() const;
  void serve();
  void take();
  void take_from(const Visitor& visitor, wire::Inbox::Kind kind);
  void take_hello();
  Delivery tell(const std::string& peer, std::string_view their_form);
  Delivery tell_loading(const Visitor& visitor);
  void refuse(const Visitor& visitor, wire::ErrorCode code, std::string message);
  void fail(wire::ErrorCode code, std::string message, wire::Severity severity);
  void dismiss();
  void stop();

  std::size_t max_visitors_;
  std::size_t max_message_bytes_;
  std::chrono::milliseconds interval_;
  std::unique_ptr<Socket> socket_;
  std::vector<std::string> endpoints_;
  std::vector<Visitor> visitors_;
  std::size_t visitor_bytes_ = 0;
  Socket::Received received_;
  wire::Inbox inbox_;
  wire::Outbox outbox_;
  std::mutex mutex_;  // of the next two
  double progress_ = 0;
  std::string message_;
  std::atomic<bool> is_over_ = false;
  GiveUp give_up_;
  int wake_ = -1;  // an eventfd that ends the thread's wait
  std::thread thread_;
};

}  // namespace ziggurat::network
