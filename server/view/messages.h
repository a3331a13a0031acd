// SPDX-License-Identifier: MIT
#pragma once
// Messages of the Foxglove WebSocket protocol, from and to viewers. No sockets here.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "channels/channel.h"
#include "view/send_queue.h"
#include "wire/request.h"

namespace ziggurat::view {

/// A parameter and its value, or the value that is wanted.
struct Parameter {
  std::string name;
  std::variant<std::monostate, bool, double, std::string> value;  ///< nothing: no such parameter
};

/// Answered once, by ViewerServer::answer() or refuse().
struct ViewerCall {
  std::uint64_t viewer = 0;
  std::uint32_t service = 0, number = 0;
  wire::Request request;        ///< without kind: it is about the speed
  std::optional<double> speed;  ///< simulated seconds per second of wall time; 0: without pacing
};

// --- from viewers
// ---------------------------------------------------------------------------------

struct Subscribe {
  struct Entry {
    std::uint32_t id = 0;       ///< the viewer's own
    std::uint32_t channel = 0;  ///< Channel::id
  };
  std::vector<Entry> entries;
};
struct Unsubscribe {
  std::vector<std::uint32_t> ids;
};
struct GetParameters {
  std::vector<std::string> names;  ///< none: all
  std::optional<std::string> id;
};
struct SetParameters {
  std::vector<Parameter> parameters;
  std::optional<std::string> id;
};
struct SubscribeParameters {
  bool wanted = true;
};
struct SubscribeGraph {
  bool wanted = true;
};
/// Our extension: the viewer has shown what it got, and is sent no tick before it says so again.
struct Ready {};
struct CallService {
  std::uint32_t service = 0, call = 0;
  std::string encoding, payload;
};
/// A sentence for the viewer: what it sent is not of this protocol, or is not served.
struct Wrong {
  std::string why;
};

using Incoming = std::variant<Subscribe, Unsubscribe, GetParameters, SetParameters,
                              SubscribeParameters, SubscribeGraph, Ready, CallService, Wrong>;

Incoming read_text(std::string_view text);
Incoming read_binary(std::string_view bytes);

/// A call of a service, or what is wrong with it as a sentence.
std::variant<ViewerCall, std::string> read_call(const CallService& call);

// --- to viewers
// -----------------------------------------------------------------------------------

struct Introduction {
  std::string version, scene, session;
  bool may_steer = false;
};
Item server_info(const Introduction& introduction);
Item advertise(std::span<const channels::Channel* const> channels);
Item unadvertise(std::span<const std::uint32_t> ids);
/// All services.
Item advertise_services();
Item parameter_values(std::span<const Parameter> parameters, const std::optional<std::string>& id);
/// Which topics there are, and by which controller's robot they are filled.
Item connection_graph(std::span<const channels::Channel> channels,
                      std::span<const std::string> subscribed);
Item warning(const std::string& text);

Item time(std::int64_t time_ns);
Item message(std::uint32_t subscription, const channels::Message& message, Keep keep);
Item service_answer(std::uint32_t service, std::uint32_t call, const std::string& json);
Item service_failure(std::uint32_t service, std::uint32_t call, const std::string& text);

}  // namespace ziggurat::view
