// SPDX-License-Identifier: MIT
#include "view/hub.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace ziggurat::view {
namespace {

Keep keep_of(const channels::Channel& channel) {
  using channels::Pace;
  if (channel.kind == channels::Kind::log) return Keep::all;
  if (channel.kind == channels::Kind::barrier) return Keep::newest;
  // Metrics belong to their tick: they are dropped with it.
  return channels::pace_of(channel.kind) == Pace::latched ? Keep::newest : Keep::nothing;
}

/// Whether a viewer that subscribes gets the newest message.
bool is_kept(channels::Kind kind) {
  return kind != channels::Kind::log && kind != channels::Kind::radio;
}

/// Names of parameters that viewers may set, and their values; what is wrong with a value.
std::string check(const Parameter& parameter) {
  const auto* number = std::get_if<double>(&parameter.value);
  if (parameter.name == "real_time_factor") {
    const bool is_valid = number && (*number == 0 || (*number >= 1e-6 && *number <= 1e6));
    return is_valid ? "" : "real_time_factor must be 1e-6 to 1e6, or 0 for as fast as it goes";
  }
  if (parameter.name == "frames_per_second") {
    const bool is_valid = number && *number >= 1 && *number <= 1000;
    return is_valid ? "" : "frames_per_second must be 1 to 1000";
  }
  if (parameter.name == "draw_labels" || parameter.name == "draw_frusta") {
    const bool is_valid = std::holds_alternative<bool>(parameter.value);
    return is_valid ? "" : parameter.name + " must be true or false";
  }
  return fmt::format("The parameter \"{}\" can't be set.", parameter.name.substr(0, 64));
}

/// Parameters of these names; all if there is none.
std::vector<Parameter> values_of(std::span<const std::string> names,
                                 const std::vector<Parameter>& all) {
  if (names.empty()) return all;
  std::vector<Parameter> values;
  for (const Parameter& parameter : all) {
    if (std::ranges::find(names, parameter.name) != names.end()) values.push_back(parameter);
  }
  return values;
}

/// The clock comes before the messages of its time, to each viewer: one that has none takes the
/// first for a jump, and may forget what was shown before. Some take a step away from 0 for a jump,
/// too.
void tell_time(std::int64_t time_ns, Viewer& viewer, std::vector<Item>& to) {
  if (std::exchange(viewer.time_ns, time_ns) == time_ns) return;
  to.push_back(time(std::max<std::int64_t>(time_ns, 1)));
}

}  // namespace

Hub::Hub(Introduction introduction, std::vector<Parameter> parameters, ViewerRequests& requests)
    : introduction_(std::move(introduction)),
      parameters_(std::move(parameters)),
      requests_(requests) {}

Viewer& Hub::add(Permission permission) {
  const bool may_steer = permission == Permission::steer;
  auto viewer = std::make_unique<Viewer>();
  viewer->id = next_viewer_++;
  viewer->may_steer = may_steer;
  Viewer& added = *viewer;
  viewers_.emplace(added.id, std::move(viewer));
  Introduction introduction = introduction_;
  introduction.may_steer = may_steer;
  send(added, server_info(introduction));
  if (may_steer) send(added, advertise_services());
  requests_.add_viewer(added.id);
  return added;
}

void Hub::remove(std::uint64_t id) {
  Viewer* viewer = find(id);
  if (!viewer) return;
  for (const auto& [subscription, channel] : viewer->channels) --subscribers_[channel];
  viewers_.erase(id);
  requests_.remove_viewer(id);
  count_subscribers({});
}

Viewer* Hub::find(std::uint64_t viewer) {
  const auto found = viewers_.find(viewer);
  return found == viewers_.end() ? nullptr : found->second.get();
}

const channels::Channel* Hub::channel(std::uint32_t id) const {
  const auto found = std::ranges::lower_bound(channels_, id, {}, &channels::Channel::id);
  return found != channels_.end() && found->id == id ? &*found : nullptr;
}

void Hub::send(Viewer& viewer, Item item) {
  if (!viewer.send_queue.add_answer(std::move(item))) viewer.is_over = true;
}

void Hub::receive(Viewer& viewer, std::string_view message, Frame frame) {
  const Incoming incoming = frame == Frame::text ? read_text(message) : read_binary(message);
  if (!std::holds_alternative<Wrong>(incoming)) viewer.faults = 0;
  std::visit([&](const auto& each) { handle(viewer, each); }, incoming);
}

std::optional<Item> Hub::next(Viewer& viewer) {
  if (viewer.send_queue.has_answer()) return viewer.send_queue.next();
  const bool has_tick = !viewer.send_queue.empty() && (viewer.is_ready || !viewer.is_paced);
  if (!(has_tick && std::exchange(viewer.was_told, false))) {
    if (auto news = viewer.known.next(channels_)) {
      viewer.was_told = true;
      return news;
    }
  }
  if (std::exchange(viewer.lacks_graph, false)) return graph();
  if (viewer.is_paced && !viewer.is_ready) return std::nullopt;
  auto item = viewer.send_queue.next();
  if (item && viewer.send_queue.empty()) viewer.is_ready = false;
  return item;
}

void Hub::handle(Viewer& viewer, const Wrong& message) {
  if (++viewer.faults >= most_faults) viewer.is_over = true;
  send(viewer, warning(message.why));
}

void Hub::handle(Viewer& viewer, const Subscribe& message) {
  std::vector<std::uint32_t> fresh;
  std::vector<Item> known;
  for (const auto& [id, wanted] : message.entries) {
    const channels::Channel* found = channel(wanted);
    if (!found || viewer.channels.contains(id) || viewer.subscriptions.contains(wanted)) {
      handle(viewer, Wrong{fmt::format("subscription {} of channel {}: {}", id, wanted,
                                       found ? "that subscription is there already"
                                             : "there is no such channel")});
      continue;
    }
    viewer.channels.emplace(id, wanted);
    viewer.subscriptions.emplace(wanted, id);
    const auto newest = newest_.find(wanted);
    if (newest != newest_.end()) {
      tell_time(time_ns_, viewer, known);
      known.push_back(view::message(id, newest->second, keep_of(*found)));
    }
    if (++subscribers_[wanted] == 1) fresh.push_back(wanted);
  }
  viewer.send_queue.add_to_newest(std::move(known));
  count_subscribers(std::move(fresh));
}

void Hub::handle(Viewer& viewer, const Unsubscribe& message) {
  for (const std::uint32_t id : message.ids) {
    const auto found = viewer.channels.find(id);
    if (found == viewer.channels.end()) continue;
    --subscribers_[found->second];
    viewer.subscriptions.erase(found->second);
    viewer.channels.erase(found);
  }
  count_subscribers({});
}

/// Tells the run which channels are wanted. What no viewer wants is not kept either.
void Hub::count_subscribers(std::vector<std::uint32_t> fresh) {
  std::erase_if(subscribers_, [](const auto& entry) { return entry.second == 0; });
  std::erase_if(newest_, [&](const auto& entry) { return !subscribers_.contains(entry.first); });
  std::vector<std::uint32_t> wanted;
  channels::Kinds kinds;
  for (const auto& [id, count] : subscribers_) {
    wanted.push_back(id);
    if (const auto* found = channel(id)) kinds.set(channels::index_of(found->kind));
  }
  requests_.set_wanted(std::move(wanted), std::move(fresh), kinds);
}

void Hub::handle(Viewer& viewer, const GetParameters& message) {
  send(viewer, parameter_values(values_of(message.names, parameters_), message.id));
}

/// Sets a parameter. @return  its fault; empty: it is set
std::string Hub::set(const Parameter& parameter) {
  if (std::string why = check(parameter); !why.empty()) return why;
  requests_.add_parameter(parameter);
  set_parameter(parameter);
  return {};
}

void Hub::handle(Viewer& viewer, const SetParameters& message) {
  std::vector<std::string> names;
  for (const Parameter& parameter : message.parameters) {
    names.push_back(parameter.name);
    const std::string why = viewer.may_steer
                                ? set(parameter)
                                : "Parameters are set with the token in the address only.";
    if (!why.empty()) send(viewer, warning(why));
  }
  if (!names.empty()) send(viewer, parameter_values(values_of(names, parameters_), message.id));
}

void Hub::handle(Viewer& viewer, const SubscribeParameters& message) {
  viewer.wants_parameters = message.wanted;
}

void Hub::handle(Viewer& viewer, const SubscribeGraph& message) {
  viewer.wants_graph = message.wanted;
  viewer.lacks_graph = message.wanted;
}

void Hub::handle(Viewer& viewer, const Ready&) { viewer.is_paced = viewer.is_ready = true; }

Item Hub::graph() const {
  std::vector<std::string> subscribed;
  for (const auto& [id, count] : subscribers_) {
    if (const auto* found = channel(id)) subscribed.push_back(found->topic);
  }
  return connection_graph(channels_, subscribed);
}

void Hub::handle(Viewer& viewer, const CallService& message) {
  const auto refuse = [&](const std::string& why) {
    send(viewer, service_failure(message.service, message.call, why));
  };
  if (!viewer.may_steer) {
    return refuse("Services need the token: open the address that the program printed.");
  }
  if (message.payload.size() > largest_queued && viewer.unanswered > 0) {
    return refuse("Other calls wait for their answers: a large one must wait, too.");
  }
  auto call = read_call(message);
  if (const auto* why = std::get_if<std::string>(&call)) return refuse(*why);
  if (viewer.unanswered >= most_unanswered) {
    return refuse(fmt::format("{} calls wait for their answers already.", most_unanswered));
  }
  ++viewer.unanswered;
  std::get<ViewerCall>(call).viewer = viewer.id;
  requests_.add_call(std::move(std::get<ViewerCall>(call)));
}

void Hub::set_channels(std::vector<channels::Channel> list) {
  std::vector<std::uint32_t> gone;
  for (const auto& old : channels_) {
    if (!std::ranges::binary_search(list, old.id, {}, &channels::Channel::id)) {
      gone.push_back(old.id);
    }
  }
  const bool is_all_old =
      std::ranges::all_of(list, [&](const auto& each) { return channel(each.id); });
  channels_ = std::move(list);
  for (auto& [id, viewer] : viewers_) {
    for (const std::uint32_t channel : gone) {
      const auto found = viewer->subscriptions.find(channel);
      if (found == viewer->subscriptions.end()) continue;
      viewer->channels.erase(found->second);
      viewer->subscriptions.erase(found);
      --subscribers_[channel];
    }
    viewer->send_queue.forget(gone);
    viewer->known.change(gone, is_all_old);
    viewer->lacks_graph |= viewer->wants_graph && !(gone.empty() && is_all_old);
  }
  if (!gone.empty()) count_subscribers({});
}

void Hub::keep(std::int64_t time_ns, std::span<const channels::Message> messages) {
  for (const channels::Message& each : messages) {
    const channels::Channel* found = channel(each.channel);
    if (found && is_kept(found->kind) && subscribers_.contains(each.channel)) {
      newest_.insert_or_assign(each.channel, each);
    }
  }
  time_ns_ = time_ns;
}

/// Items of those messages to which the viewer subscribes, and the clock before them.
std::vector<Item> Hub::wanted_of(Viewer& viewer, std::int64_t time_ns,
                                 std::span<const channels::Message> messages) {
  std::vector<Item> items;
  if (!viewer.channels.empty()) tell_time(time_ns, viewer, items);
  for (const channels::Message& each : messages) {
    const auto subscription = viewer.subscriptions.find(each.channel);
    const channels::Channel* found = channel(each.channel);
    if (!found || subscription == viewer.subscriptions.end()) continue;
    items.push_back(view::message(subscription->second, each, keep_of(*found)));
  }
  return items;
}

void Hub::show(std::int64_t time_ns, std::span<const channels::Message> messages) {
  keep(time_ns, messages);
  for (auto& [id, viewer] : viewers_) {
    viewer->send_queue.add_frame(wanted_of(*viewer, time_ns, messages));
    viewer->is_over |= viewer->send_queue.is_too_much();
  }
}

void Hub::tell(const channels::Message& message) {
  const std::span<const channels::Message> one(&message, 1);
  keep(message.time_ns, one);
  for (auto& [id, viewer] : viewers_) {
    viewer->send_queue.add_to_newest(wanted_of(*viewer, message.time_ns, one));
    viewer->is_over |= viewer->send_queue.is_too_much();
  }
}

void Hub::set_parameter(const Parameter& parameter) {
  const auto found = std::ranges::find(parameters_, parameter.name, &Parameter::name);
  if (found == parameters_.end() || found->value == parameter.value) return;
  found->value = parameter.value;
  for (auto& [id, viewer] : viewers_) {
    if (viewer->wants_parameters) {
      send(*viewer, parameter_values(std::span(&parameter, 1), std::nullopt));
    }
  }
}

void Hub::answer(const ViewerCall& call, Outcome outcome, const std::string& text) {
  Viewer* viewer = find(call.viewer);
  if (!viewer) return;
  --viewer->unanswered;
  send(*viewer, outcome == Outcome::done ? service_answer(call.service, call.number, text)
                                         : service_failure(call.service, call.number, text));
}

}  // namespace ziggurat::view
