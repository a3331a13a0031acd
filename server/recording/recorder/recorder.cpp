// SPDX-License-Identifier: MIT
#include "recording/recorder/recorder.h"

#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include "math/hash.h"
#include "outputs/output_file.h"
#include "recording/recorder/disk.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::recorder {
namespace {

// Limits of the tasks that wait for the disk: beyond them the run waits.
constexpr std::size_t most_waiting = std::size_t{64} << 20;  // [bytes]
constexpr std::size_t most_tasks = 1024;

// The recorder's thread looks for work so often, or is woken when this much waits: to wake it for
// each tick would cost the run more than all copies.
constexpr std::chrono::milliseconds interval{10};
constexpr std::size_t many_tasks = most_tasks / 4;
constexpr std::size_t much_waiting = most_waiting / 4;  // [bytes]

// Fewer ticks than that never wait for each other, however large they are.
constexpr std::size_t few_ticks = 4;

// Patience is counted in parts: a program that was stopped for a while has waited for one of them.
constexpr int parts_of_patience = 100;

}  // namespace

/// State that the run's thread and the recorder's share.
struct Recorder::Shared {
  explicit Shared(const Settings& settings) : patience(settings.patience), disk(settings.path) {}

  // The run's thread.
  void add(Task task);
  bool has_room_for(const Task& task) const;
  std::size_t unwritten() const;
  channels::TickCopy take_copy();
  bool wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_done);
  void give_up();

  // The recorder's.
  void work(Start start, Settings settings);
  std::deque<Task> next();
  bool has_work() const;
  void done(const Task& task, const Recording& recording);
  void look(const Recording& recording, std::size_t ticks);
  void give_back(channels::TickCopy copy);
  bool is_over();

  void fail(std::string why);

  const std::chrono::milliseconds patience;
  Disk disk;
  std::mutex mutex;  // of all below
  std::condition_variable wake, has_room;
  std::deque<Task> tasks;
  std::vector<channels::TickCopy> copies;  // free ones, whose memory is used again
  std::size_t waiting = 0;                 // of all tasks that are not done [bytes]
  std::size_t unfinished = 0;              // their number
  std::uint64_t finished = 0;              // the number of those that are done
  // Data that a killed run would lose: the chunk being filled, and tasks that are not done.
  std::size_t chunks = 0, chunk_size = 0, chunk_ticks = 0;  // its number, bytes, and ticks so far
  std::size_t tick_size = 0;                                // in a chunk, as those before [bytes]
  std::size_t waiting_ticks = 0, other_size = 0;  // of tasks: their number, and bytes of all others
  std::optional<clock::time_point> chunk_begin;
  std::deque<clock::time_point> begins;  // of the tasks that are not done
  bool is_awaited = false;               // the run waits
  bool is_closing = false, has_failed = false, has_ended = false;
  std::optional<std::string> failure;
};

Recorder::Recorder(Settings settings, Start start)
    : wants_(settings.contents.wants),
      picture_interval_(settings.contents.picture_interval),
      shared_(std::make_shared<Shared>(settings)),
      thread_([shared = shared_, begun = std::move(start), with = std::move(settings)]() mutable {
        shared->work(std::move(begun), std::move(with));
      }) {}

Recorder::~Recorder() { close(); }

// --- the run's thread
// -----------------------------------------------------------------------------

/// Waits for the recorder's thread as long as that, or the disk, gets on.
/// @return  false: it does not any more
bool Recorder::Shared::wait(std::unique_lock<std::mutex>& lock,
                            const std::function<bool()>& is_done) {
  std::uint64_t seen = finished + disk.taken();
  for (int part = 0; part < parts_of_patience; ++part) {
    if (has_room.wait_for(lock, patience / parts_of_patience, is_done)) return true;
    const std::uint64_t now = finished + disk.taken();
    if (std::exchange(seen, now) != now) part = 0;
  }
  return false;
}

void Recorder::Shared::add(Task task) {
  std::unique_lock lock(mutex);
  if (!has_room_for(task)) {
    is_awaited = true;
    wake.notify_one();
    const bool gets_on = wait(lock, [&] { return has_room_for(task); });
    is_awaited = false;
    if (!gets_on) {
      lock.unlock();
      return give_up();
    }
  }
  if (has_failed || is_closing) return;
  waiting += task.size;
  ++unfinished;
  if (task.kind == Task::Kind::tick) {
    ++waiting_ticks;
    if (tick_size == 0) tick_size = task.size;  // a guess, until one is encoded
  }
  if (task.kind == Task::Kind::other) other_size += task.size;
  begins.push_back(task.begin);
  tasks.push_back(std::move(task));
  const bool wakes = has_work();
  lock.unlock();
  if (wakes) wake.notify_one();
}

bool Recorder::Shared::has_room_for(const Task& task) const {
  if (has_failed) return true;
  if (unfinished > 0 && (waiting + task.size > most_waiting || unfinished >= most_tasks))
    return false;
  if (task.kind != Task::Kind::tick) return true;
  const auto oldest = chunk_begin ? *chunk_begin : begins.empty() ? task.begin : begins.front();
  if (task.begin - oldest > longest_unwritten) return false;
  return chunk_ticks + waiting_ticks < few_ticks || unwritten() + tick_size <= most_unwritten;
}

/// Size of the data that is in no file yet, about [bytes].
std::size_t Recorder::Shared::unwritten() const {
  return chunk_size + waiting_ticks * tick_size + other_size;
}

bool Recorder::Shared::has_work() const {
  return tasks.size() >= many_tasks || waiting >= much_waiting ||
         unwritten() >= most_unwritten / 4 * 3;
}

void Recorder::Shared::give_up() {
  disk.abandon();
  fail(fmt::format("{}: cannot be written: the disk has taken nothing for {} s", disk.path(),
                   static_cast<double>(patience.count()) / 1000));
}

channels::TickCopy Recorder::Shared::take_copy() {
  const std::lock_guard lock(mutex);
  if (copies.empty()) return {};
  channels::TickCopy copy = std::move(copies.back());
  copies.pop_back();
  return copy;
}

void Recorder::add(std::function<void(Recording&)> run, std::size_t size, Task::Kind kind) {
  shared_->add({std::move(run), size, kind});
}

void Recorder::populate(const channels::Population& population) {
  auto copy = std::make_shared<const channels::PopulationCopy>(population);
  add([copy = std::move(copy)](Recording& to) { to.populate(copy); }, 0);
}

void Recorder::tick(const channels::Moment& moment) {
  auto copied = std::make_shared<channels::TickCopy>(shared_->take_copy());
  const bool has_pictures = moment.state.tick % picture_interval_ == 0;
  using channels::Sensed;
  channels::copy(moment, has_pictures ? Sensed::numbers_and_pictures : Sensed::numbers, *copied);
  const std::size_t size = size_of(*copied);
  add(
      [shared = shared_.get(), copied = std::move(copied)](Recording& to) {
        to.tick(*copied);
        shared->give_back(std::move(*copied));
      },
      size, Task::Kind::tick);
}

void Recorder::step(const world::Commands& commands, std::vector<world::Metric> metrics) {
  auto copied = std::make_shared<channels::TickCopy>(shared_->take_copy());
  copied->commands = commands;
  const std::size_t metrics_size = metrics.size() * sizeof(world::Metric);
  add(
      [shared = shared_.get(), copied = std::move(copied),
       metrics = std::move(metrics)](Recording& to) {
        to.measured(metrics);
        to.step(copied->commands);
        shared->give_back(std::move(*copied));
      },
      sizeof(channels::TickCopy) + commands.radio_messages.bytes.size() +
          commands.markers.size() * sizeof(world::Marker) + metrics_size,
      Task::Kind::step);
}

void Recorder::add(v1::Act act) {
  const std::chrono::nanoseconds wall = clock::now() - begin_;
  act.set_wall_ns(wall.count());
  const std::size_t size = sizeof act + act.spawn().xml().size();
  add([act = std::move(act)](Recording& to) { to.add(act); }, size);
}

void Recorder::moved(const std::string& entity, const math::Pose& pose) {
  v1::Act act;
  v1::Act::Move& move = *act.mutable_move();
  move.set_entity(v1::valid_utf8(entity));
  for (const double value : pose.position) move.add_position(value);
  const math::Quaternion& q = pose.orientation;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) move.add_orientation(value);
  add(std::move(act));
}

void Recorder::joint_set(const std::string& entity, const std::string& joint, double position,
                         double velocity) {
  v1::Act act;
  v1::Act::SetJoint& set = *act.mutable_set_joint();
  set.set_entity(v1::valid_utf8(entity));
  set.set_joint(v1::valid_utf8(joint));
  set.set_position(position);
  set.set_velocity(velocity);
  add(std::move(act));
}

void Recorder::spawned(const std::string& xml, std::vector<EmbeddedFile> files) {
  for (EmbeddedFile& file : files) {
    const std::size_t size = file.text.size();
    add([file = std::move(file)](Recording& to) { to.attach(file); }, size);
  }
  v1::Act act;
  act.mutable_spawn()->set_xml(v1::valid_utf8(xml));
  add(std::move(act));
}

void Recorder::removed(const std::string& entity) {
  v1::Act act;
  act.mutable_remove()->set_entity(v1::valid_utf8(entity));
  add(std::move(act));
}

void Recorder::reset(std::uint64_t seed) {
  v1::Act act;
  act.mutable_reset()->set_seed(seed);
  add(std::move(act));
  add([](Recording& to) { to.end_epoch(); }, 0);
}

void Recorder::kept(const std::string& snapshot) {
  v1::Act act;
  act.mutable_snapshot()->set_name(snapshot);
  add(std::move(act));
}

void Recorder::restored(const std::string& snapshot, std::span<const std::byte> bytes) {
  v1::Act act;
  act.mutable_restore()->set_name(snapshot);
  if (!bytes.empty()) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    math::Hash hash;
    hash.add(text);
    const std::string file = math::to_hex(hash.digest());
    if (snapshots_.insert(file).second) {
      add([embedded = EmbeddedFile{"snapshot/" + file, std::string(text)}](
              Recording& to) { to.attach(embedded); },
          bytes.size());
    }
    act.mutable_restore()->set_file(file);
  }
  add(std::move(act));
  add([](Recording& to) { to.end_epoch(); }, 0);
}

void Recorder::set_paused(bool is_paused) {
  v1::Act act;
  is_paused ? void(act.mutable_pause()) : void(act.mutable_resume());
  add(std::move(act));
}

void Recorder::log(channels::Severity severity, std::string_view name, std::string_view text) {
  add([severity, name = std::string(name),
       text = std::string(text)](Recording& to) { to.log(severity, name, text); },
      name.size() + text.size());
}

void Recorder::close(std::vector<world::Metric> metrics) {
  if (!metrics.empty()) {
    add([metrics = std::move(metrics)](Recording& to) { to.measured(metrics); }, 0);
  }
  if (!thread_.joinable()) return;
  std::unique_lock lock(shared_->mutex);
  shared_->is_closing = true;
  shared_->wake.notify_one();
  // A thread that waits for the disk was waited for already.
  const bool is_stuck = shared_->disk.is_abandoned();
  const bool has_ended = !is_stuck && shared_->wait(lock, [this] { return shared_->has_ended; });
  lock.unlock();
  if (has_ended) return thread_.join();
  if (!is_stuck) shared_->give_up();
  thread_.detach();  // it ends when the disk lets it go on
}

std::optional<std::string> Recorder::take_failure() {
  const std::lock_guard lock(shared_->mutex);
  return std::exchange(shared_->failure, std::nullopt);
}

// --- the recorder's thread
// ------------------------------------------------------------------------

void Recorder::Shared::give_back(channels::TickCopy copy) {
  const std::lock_guard lock(mutex);
  copies.push_back(std::move(copy));
}

/// The first reason counts.
void Recorder::Shared::fail(std::string why) {
  {
    const std::lock_guard lock(mutex);
    if (!std::exchange(has_failed, true)) failure = std::move(why);
    tasks.clear();
  }
  has_room.notify_all();
}

/// All tasks that wait, after a while if there are none; none and the end: nothing follows.
std::deque<Recorder::Task> Recorder::Shared::next() {
  std::unique_lock lock(mutex);
  if (tasks.empty() && !is_closing) {
    wake.wait_for(lock, interval, [this] { return is_closing || is_awaited || has_work(); });
  }
  return std::exchange(tasks, {});
}

void Recorder::Shared::done(const Task& task, const Recording& recording) {
  {
    const std::lock_guard lock(mutex);
    waiting -= task.size;
    --unfinished;
    ++finished;
    if (task.kind == Task::Kind::tick) --waiting_ticks;
    if (task.kind == Task::Kind::other) other_size -= task.size;
    begins.pop_front();
    look(recording, task.kind == Task::Kind::tick ? 1 : 0);
  }
  has_room.notify_one();
}

/// At the chunk, after it has changed. @pre the mutex is held; @param ticks  that were added
void Recorder::Shared::look(const Recording& recording, std::size_t ticks) {
  if (std::exchange(chunks, recording.chunks()) != recording.chunks()) chunk_ticks = 0;
  chunk_ticks += ticks;
  chunk_size = recording.chunk_size();
  chunk_begin.reset();
  if (chunk_size > 0) chunk_begin = recording.chunk_begin();
  if (chunk_ticks > 0) tick_size = chunk_size / chunk_ticks;
}

bool Recorder::Shared::is_over() {
  const std::lock_guard lock(mutex);
  return is_closing && tasks.empty();
}

void Recorder::Shared::work(Start start, Settings settings) {
  try {
    Recording recording([this](std::string_view bytes) { disk.write(bytes); }, settings.compression,
                        std::move(settings.contents), start);
    while (!is_over()) {
      for (Task& task : next()) {
        if (disk.is_abandoned()) throw outputs::WriteError("given up");  // the run may be gone
        recording.set_now(task.begin);
        task.run(recording);
        task.run = nullptr;
        done(task, recording);
      }
      recording.end_due_chunk();
      {
        const std::lock_guard lock(mutex);
        look(recording, 0);
      }
      has_room.notify_one();
    }
    recording.close();
    disk.close();
  } catch (const std::exception& error) {
    fail(error.what());
  }
  const std::lock_guard lock(mutex);
  has_ended = true;
  has_room.notify_all();
}

}  // namespace ziggurat::recorder
