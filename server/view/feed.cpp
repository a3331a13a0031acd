// SPDX-License-Identifier: MIT
#include "view/feed.h"

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

namespace ziggurat::view {
namespace {

using channels::Pace;

void add(const std::vector<std::uint32_t>& from, std::vector<std::uint32_t>& to) {
  std::vector<std::uint32_t> both;
  std::ranges::set_union(from, to, std::back_inserter(both));
  to = std::move(both);
}

}  // namespace

// --- the run's thread
// -----------------------------------------------------------------------------

std::unique_ptr<channels::TickCopy> Feed::take_copy() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return std::make_unique<channels::TickCopy>();
  auto copy = std::move(free_.back());
  free_.pop_back();
  return copy;
}

/// With the mutex.
void Feed::give_back(Tick& tick) { free_.push_back(std::move(tick.world)); }

void Feed::populate(const channels::Population& population) {
  auto copy = std::make_shared<const channels::PopulationCopy>(population);
  const std::lock_guard lock(mutex_);
  next_population_ = std::move(copy);
  std::erase_if(waiting_, [this](Item& item) {
    Tick* tick = std::get_if<Tick>(&item);
    if (tick) give_back(*tick);
    return tick != nullptr;
  });
  ticks_ = 0;
}

void Feed::set_layers(const channels::Layers& layers) {
  const std::lock_guard lock(mutex_);
  next_layers_ = layers;
}

void Feed::show(const channels::Moment& moment, Wanted wanted) {
  Tick tick{take_copy(), std::move(wanted)};
  channels::copy(moment, tick.wanted.sensed, *tick.world);
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(tick));
  if (++ticks_ > most_ticks) drop_oldest();
}

void Feed::show_commands(const channels::Moment& moment, std::vector<std::uint32_t> wanted) {
  Tick answer{take_copy(), {{}, std::move(wanted)}, true};
  answer.world->state.tick = moment.state.tick;
  answer.world->state.time_ns = moment.state.time_ns;
  answer.world->commands = moment.commands;
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(answer));
}

/// With the mutex, and two ticks at least: the oldest, and its answer.
void Feed::drop_oldest() {
  const auto is_whole = [](const Item& item) {
    const Tick* tick = std::get_if<Tick>(&item);
    return tick && !tick->is_answer;
  };
  const auto oldest = std::ranges::find_if(waiting_, is_whole);
  const auto next = std::find_if(std::next(oldest), waiting_.end(), is_whole);
  const Wanted& from = std::get<Tick>(*oldest).wanted;
  Wanted& to = std::get<Tick>(*next).wanted;
  add(from.tick, to.tick);
  add(from.latched, to.latched);
  const auto begin = oldest - waiting_.begin(), end = next - waiting_.begin();
  std::deque<Item> kept;
  for (std::ptrdiff_t i = 0; i < std::ssize(waiting_); ++i) {
    Item& item = waiting_[static_cast<std::size_t>(i)];
    Tick* tick = std::get_if<Tick>(&item);
    if (tick && (i < end && (i >= begin || tick->is_answer))) {
      give_back(*tick);
    } else {
      kept.push_back(std::move(item));
    }
  }
  waiting_ = std::move(kept);
  --ticks_;
}

void Feed::show_event(channels::Message message) {
  const std::lock_guard lock(mutex_);
  if (events_ >= most_events) return;
  ++events_;
  waiting_.push_back(std::move(message));
}

// --- the server's thread
// --------------------------------------------------------------------------

void Feed::encode(const Tick& tick, std::vector<channels::Message>& to) {
  const channels::Moment moment = tick.world->view();
  if (!tick.is_answer) {
    channels_.encode(moment, Pace::latched, tick.wanted.latched, to);
    channels_.encode(moment, Pace::tick, tick.wanted.tick, to);
  }
  channels_.encode(moment, Pace::answer, tick.wanted.latched, to);
}

void Feed::pass_on(Hub& hub) {
  std::deque<Item> items;
  std::shared_ptr<const channels::PopulationCopy> population;
  {
    const std::lock_guard lock(mutex_);
    items.swap(waiting_);
    ticks_ = events_ = 0;
    population = std::exchange(next_population_, nullptr);
    if (next_layers_) channels_.set_layers(*std::exchange(next_layers_, std::nullopt));
  }
  if (population) {
    channels_.populate(population->view());
    population_ = population;  // what channels_ referred to before may go now
    hub.set_channels(channels_.list());
  }
  for (Item& item : items) {
    if (const auto* event = std::get_if<channels::Message>(&item)) {
      hub.tell(*event);
      continue;
    }
    Tick& tick = std::get<Tick>(item);
    messages_.clear();
    encode(tick, messages_);
    if (!messages_.empty()) hub.show(tick.world->state.time_ns, messages_);
    const std::lock_guard lock(mutex_);
    give_back(tick);
  }
  messages_.clear();
}

}  // namespace ziggurat::view
