#include "recorder/recorder.h"

#include <fmt/format.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include "math/hash.h"
#include "recorder/disk.h"
#include "recording/output_file.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat::recorder {
namespace {

// What may wait for the disk: more than that, and the run waits.
constexpr std::size_t most_waiting = std::size_t{64} << 20;  // [bytes]
constexpr std::size_t most_tasks = 1024;

// The recorder's thread looks for work so often, or is woken when this much waits: to wake it for
// each tick would cost the run more than all copies.
constexpr std::chrono::milliseconds interval{10};
constexpr std::size_t many_tasks = most_tasks / 4;
constexpr std::size_t much_waiting = most_waiting / 4;  // [bytes]

// Patience is counted in parts: a program that was stopped for a while has waited for one of them.
constexpr int parts_of_patience = 100;

}  // namespace

/// What the run's thread and the recorder's share.
struct Recorder::Shared {
  explicit Shared(const Settings& settings) : patience(settings.patience), disk(settings.path) {}

  // The run's thread.
  void add(Task task);
  channels::TickCopy take_copy();
  bool wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_done);
  void give_up();

  // The recorder's.
  void work(Start start, Settings settings);
  std::deque<Task> next();
  void done(std::size_t size);
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

// --- the run's thread -----------------------------------------------------------------------------

/// Waits for the recorder's thread as long as that, or the disk, gets on.
/// @return  false: it does not any more
bool Recorder::Shared::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& is_done) {
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
  const bool gets_on = wait(lock, [&] {
    return has_failed || unfinished == 0 ||
           (waiting + task.size <= most_waiting && unfinished < most_tasks);
  });
  if (!gets_on) {
    lock.unlock();
    return give_up();
  }
  if (has_failed || is_closing) return;
  waiting += task.size;
  ++unfinished;
  tasks.push_back(std::move(task));
  const bool wakes = tasks.size() >= many_tasks || waiting >= much_waiting;
  lock.unlock();
  if (wakes) wake.notify_one();
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

void Recorder::add(std::function<void(Recording&)> run, std::size_t size) {
  shared_->add({std::move(run), size});
}

void Recorder::populate(const channels::Population& population) {
  auto copy = std::make_shared<const channels::PopulationCopy>(population);
  add([copy = std::move(copy)](Recording& to) { to.populate(copy); }, 0);
}

void Recorder::tick(const channels::Moment& moment) {
  auto copied = std::make_shared<channels::TickCopy>(shared_->take_copy());
  channels::copy(moment, moment.state.tick % picture_interval_ == 0, *copied);
  const std::size_t size = size_of(*copied);
  add(
      [shared = shared_.get(), copied = std::move(copied)](Recording& to) {
        to.tick(*copied);
        shared->give_back(std::move(*copied));
      },
      size);
}

void Recorder::step(const world::Commands& commands, std::vector<world::Metric> metrics) {
  auto copied = std::make_shared<channels::TickCopy>(shared_->take_copy());
  copied->commands = commands;
  const std::size_t metrics_size = metrics.size() * sizeof(world::Metric);
  add(
      [shared = shared_.get(), copied = std::move(copied), metrics = std::move(metrics)](Recording& to) {
        to.measured(metrics);
        to.step(copied->commands);
        shared->give_back(std::move(*copied));
      },
      sizeof(channels::TickCopy) + commands.radio_messages.bytes.size() + metrics_size);
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

// --- the recorder's thread ------------------------------------------------------------------------

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
    wake.wait_for(lock, interval, [this] {
      return is_closing || tasks.size() >= many_tasks || waiting >= much_waiting;
    });
  }
  return std::exchange(tasks, {});
}

/// @param size  of the task's memory
void Recorder::Shared::done(std::size_t size) {
  {
    const std::lock_guard lock(mutex);
    waiting -= size;
    --unfinished;
    ++finished;
  }
  has_room.notify_one();
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
        if (disk.is_abandoned()) throw recording::WriteError("given up");  // the run may be gone
        task.run(recording);
        task.run = nullptr;
        done(task.size);
      }
      recording.end_old_chunk();
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
