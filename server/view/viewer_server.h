// SPDX-License-Identifier: MIT
#pragma once
// Server of viewers: the page over HTTP, and viewers over WebSocket, on one port and a thread of
// its own. The run never waits for it: it leaves copies and takes the requests of viewers.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "channels/message.h"
#include "http/address.h"
#include "view/access.h"
#include "view/feed.h"
#include "view/viewer_requests.h"

namespace ziggurat::view {

struct Settings {
  std::optional<http::Address>
      address;                 ///< nothing: 127.0.0.1:8765, or another port if that is taken
  bool insecure = false;       ///< other machines may look without token
  std::string token;           ///< the user's own; empty: a random one
  std::string folder;          ///< of the page's files
  std::string version, scene;  ///< that viewers are told
  std::chrono::milliseconds silence{
      60'000};  ///< of a viewer, answers to pings included, until it is disconnected
  std::vector<Parameter> parameters;
};

class ViewerServer {
 public:
  static constexpr std::size_t most_viewers = 64;
  static constexpr std::size_t most_lookers = 48;  ///< of them, without token
  static constexpr std::size_t most_connections =
      128;  ///< the oldest that is no viewer makes place

  /// Listens at once. @throws text::UsageError; std::runtime_error if it can't listen
  explicit ViewerServer(const Settings& settings);
  /// Viewers are told that the server goes away.
  ~ViewerServer();
  ViewerServer(const ViewerServer&) = delete;
  ViewerServer& operator=(const ViewerServer&) = delete;

  /// With the token: "http://127.0.0.1:8765/?token=…", "ws://…".
  std::string page_address() const;
  std::string viewer_address() const;
  /// Host at which it listens.
  const std::string& host() const;

  /// Requests of viewers, for the thread of the run.
  ViewerRequests& requests();

  // Each of these returns at once.

  // Ticks to show: as of Feed.
  void populate(const channels::Population& population);
  void set_layers(const channels::Layers& layers);
  void show(const channels::Moment& moment, Wanted wanted);
  void show_commands(const channels::Moment& moment, std::vector<std::uint32_t> wanted);
  void show_event(channels::Message message);

  void set_parameter(Parameter parameter);
  void answer(const ViewerCall& call, std::uint64_t tick);
  void refuse(const ViewerCall& call, const std::string& why);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat::view
