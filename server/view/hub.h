// SPDX-License-Identifier: MIT
#pragma once
// Viewers with their subscriptions and send queues. No sockets here.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "channels/channel.h"
#include "channels/message.h"
#include "view/access.h"
#include "view/known_channels.h"
#include "view/messages.h"
#include "view/send_queue.h"
#include "view/viewer_requests.h"

namespace ziggurat::view {

struct Viewer {
  std::uint64_t id = 0;
  bool may_steer = false;
  SendQueue send_queue;
  std::unordered_map<std::uint32_t, std::uint32_t> channels;       ///< subscription -> channel
  std::unordered_map<std::uint32_t, std::uint32_t> subscriptions;  ///< channel -> subscription
  KnownChannels known;
  bool wants_parameters = false;
  bool wants_graph = false, lacks_graph = false;  ///< at each change; the one of now
  bool is_paced = false, is_ready = false;        ///< it says when it takes ticks; it does now
  bool was_told = false;      ///< of channels, by the last item: a tick may come between two lists
  std::int64_t time_ns = -1;  ///< the clock that it was told; -1: none yet
  unsigned faults = 0;        ///< messages in a row that are none of the protocol
  unsigned unanswered = 0;    ///< calls
  bool is_over = false;       ///< to be disconnected: it sends nonsense, or does not read
};

class Hub {
 public:
  static constexpr unsigned most_faults = 100;
  static constexpr unsigned most_unanswered = 64;
  static constexpr std::size_t largest_queued = std::size_t{64}
                                                << 10;  ///< a call behind others [bytes]

  /// @param parameters  at the start
  /// @param requests  must outlive this
  Hub(Introduction introduction, std::vector<Parameter> parameters, ViewerRequests& requests);

  /// @param permission  not `refused`
  Viewer& add(Permission permission);
  void remove(std::uint64_t viewer);
  Viewer* find(std::uint64_t viewer);
  std::size_t size() const { return viewers_.size(); }

  enum class Frame { text, binary };
  void receive(Viewer& viewer, std::string_view message, Frame frame);
  /// Next item to send to the viewer: answers, changes of the channels, then ticks; these also
  /// between two parts of a long list of channels.
  std::optional<Item> next(Viewer& viewer);

  /// @param list  all channels of now, ascending by id
  void set_channels(std::vector<channels::Channel> list);
  /// The messages of a tick, to those who subscribe to them.
  void show(std::int64_t time_ns, std::span<const channels::Message> messages);
  /// The same of a message that has no tick of its own, as an event.
  void tell(const channels::Message& message);
  void set_parameter(const Parameter& parameter);
  /// @param text  JSON of an answer, or a sentence why it was refused
  enum class Outcome { done, refused };
  void answer(const ViewerCall& call, Outcome outcome, const std::string& text);

  /// Calls visit(viewer) for each.
  template <class Visit>
  void for_each(Visit visit) {
    for (auto& [id, viewer] : viewers_) visit(*viewer);
  }

 private:
  void handle(Viewer& viewer, const Subscribe& message);
  void handle(Viewer& viewer, const Unsubscribe& message);
  void handle(Viewer& viewer, const GetParameters& message);
  void handle(Viewer& viewer, const SetParameters& message);
  void handle(Viewer& viewer, const SubscribeParameters& message);
  void handle(Viewer& viewer, const SubscribeGraph& message);
  void handle(Viewer& viewer, const Ready& message);
  void handle(Viewer& viewer, const CallService& message);
  void handle(Viewer& viewer, const Wrong& message);
  void send(Viewer& viewer, Item item);
  std::vector<Item> wanted_of(Viewer& viewer, std::int64_t time_ns,
                              std::span<const channels::Message> messages);
  void keep(std::int64_t time_ns, std::span<const channels::Message> messages);
  std::string set(const Parameter& parameter);
  const channels::Channel* channel(std::uint32_t id) const;
  void count_subscribers(std::vector<std::uint32_t> fresh);
  Item graph() const;

  Introduction introduction_;
  std::vector<Parameter> parameters_;
  ViewerRequests& requests_;
  std::uint64_t next_viewer_ = 1;
  std::map<std::uint64_t, std::unique_ptr<Viewer>> viewers_;
  std::vector<channels::Channel> channels_;
  std::map<std::uint32_t, std::size_t> subscribers_;             // by channel
  std::unordered_map<std::uint32_t, channels::Message> newest_;  // of these
  std::int64_t time_ns_ = -1;
};

}  // namespace ziggurat::view
