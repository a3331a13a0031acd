#include "recorder/recorder.h"

#include <exception>
#include <memory>
#include <utility>

#include "math/hash.h"
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

}  // namespace

Recorder::Recorder(Settings settings, Start start)
    : wants_(settings.contents.wants),
      picture_interval_(settings.contents.picture_interval),
      disk_(settings.path),
      thread_([this, begun = std::move(start), with = std::move(settings)]() mutable {
        work(std::move(begun), std::move(with));
      }) {}

Recorder::~Recorder() { close(); }

// --- the run's thread -----------------------------------------------------------------------------

void Recorder::add(std::function<void(Recording&)> run, std::size_t size) {
  std::unique_lock lock(mutex_);
  has_room_.wait(lock, [&] {
    return has_failed_ || unfinished_ == 0 ||
           (waiting_ + size <= most_waiting && unfinished_ < most_tasks);
  });
  if (has_failed_ || is_closing_) return;
  waiting_ += size;
  ++unfinished_;
  tasks_.push_back({std::move(run), size});
  const bool wakes = tasks_.size() >= many_tasks || waiting_ >= much_waiting;
  lock.unlock();
  if (wakes) wake_.notify_one();
}

channels::TickCopy Recorder::take_copy() {
  const std::lock_guard lock(mutex_);
  if (copies_.empty()) return {};
  channels::TickCopy copy = std::move(copies_.back());
  copies_.pop_back();
  return copy;
}

void Recorder::give_back(channels::TickCopy copy) {
  const std::lock_guard lock(mutex_);
  copies_.push_back(std::move(copy));
}

void Recorder::populate(const channels::Population& population) {
  auto copy = std::make_shared<const channels::PopulationCopy>(population);
  add([copy = std::move(copy)](Recording& to) { to.populate(copy); }, 0);
}

void Recorder::tick(const channels::Moment& moment) {
  auto copied = std::make_shared<channels::TickCopy>(take_copy());
  channels::copy(moment, moment.state.tick % picture_interval_ == 0, *copied);
  const std::size_t size = size_of(*copied);
  add(
      [this, copied = std::move(copied)](Recording& to) {
        to.tick(*copied);
        give_back(std::move(*copied));
      },
      size);
}

void Recorder::step(const world::Commands& commands, std::vector<world::Metric> metrics) {
  auto copied = std::make_shared<channels::TickCopy>(take_copy());
  copied->commands = commands;
  const std::size_t metrics_size = metrics.size() * sizeof(world::Metric);
  add(
      [this, copied = std::move(copied), metrics = std::move(metrics)](Recording& to) {
        to.measured(metrics);
        to.step(copied->commands);
        give_back(std::move(*copied));
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
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

std::optional<std::string> Recorder::take_failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, std::nullopt);
}

// --- the recorder's thread ------------------------------------------------------------------------

void Recorder::fail(std::string why) {
  {
    const std::lock_guard lock(mutex_);
    has_failed_ = true;
    failure_ = std::move(why);
    tasks_.clear();
  }
  has_room_.notify_all();
}

/// All tasks that wait, after a while if there are none; none and the end: nothing follows.
std::deque<Recorder::Task> Recorder::next() {
  std::unique_lock lock(mutex_);
  if (tasks_.empty() && !is_closing_) {
    wake_.wait_for(lock, interval, [this] {
      return is_closing_ || tasks_.size() >= many_tasks || waiting_ >= much_waiting;
    });
  }
  return std::exchange(tasks_, {});
}

/// @param size  of the task's memory
void Recorder::done(std::size_t size) {
  {
    const std::lock_guard lock(mutex_);
    waiting_ -= size;
    --unfinished_;
  }
  has_room_.notify_one();
}

bool Recorder::is_over() {
  const std::lock_guard lock(mutex_);
  return is_closing_ && tasks_.empty();
}

void Recorder::work(Start start, Settings settings) {
  try {
    Recording recording([this](std::string_view bytes) { disk_.write(bytes); },
                        settings.compression, std::move(settings.contents), start);
    while (!is_over()) {
      for (Task& task : next()) {
        task.run(recording);
        task.run = nullptr;
        done(task.size);
      }
      recording.end_old_chunk();
    }
    recording.close();
    disk_.close();
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

}  // namespace ziggurat::recorder
