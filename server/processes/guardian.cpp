#include "processes/guardian.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <chrono>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "processes/folder_removal.h"

namespace ziggurat::processes {
namespace {

// Time for which files are still removed that appear in a folder during its removal.
constexpr std::chrono::milliseconds longest_removal{2000};

enum class Kind : std::int32_t {
  end_group,
  forget_group,
  remove_dead_socket,
  remove_folder,
  forget_folder,
  remove_empty_folder,
  end_now,
  done
};

/// One write to the pipe: shorter than PIPE_BUF, so that orders of several processes do not mix.
struct Order {
  Kind kind = Kind::done;
  pid_t group = 0;
  char path[512] = {};
  char lock[sizeof sockaddr_un::sun_path] = {};  ///< of a socket's path
};

void send(int pipe, const Order& order) noexcept {
  while (::write(pipe, &order, sizeof order) < 0 && errno == EINTR) {
  }
}

/// False if the text is too long to be sent.
template <std::size_t size>
bool copy(const std::string& text, char (&to)[size]) noexcept {
  if (text.size() >= size) return false;
  std::memcpy(to, text.c_str(), text.size() + 1);
  return true;
}

void send_path(int pipe, Kind kind, const std::string& path, const std::string& lock = {}) noexcept {
  Order order;
  order.kind = kind;
  if (copy(path, order.path) && copy(lock, order.lock)) send(pipe, order);
}

void sleep_ms(int ms) noexcept {
  const timespec time{ms / 1000, (ms % 1000) * 1'000'000L};
  ::nanosleep(&time, nullptr);
}

// --- the guardian's process
// -----------------------------------------------------------------------

/// Processes and folders that remain if the watched process ends now.
struct Left {
  std::vector<pid_t> groups;
  std::vector<Order> sockets;
  std::vector<std::string> folders, empty_folders;
};

void take(const Order& order, Left& left) {
  switch (order.kind) {
    case Kind::end_group:
      left.groups.push_back(order.group);
      break;
    case Kind::forget_group:
      std::erase(left.groups, order.group);
      break;
    case Kind::remove_dead_socket:
      left.sockets.push_back(order);
      break;
    case Kind::remove_folder:
      left.folders.emplace_back(order.path);
      break;
    case Kind::forget_folder:
      std::erase(left.folders, order.path);
      break;
    case Kind::remove_empty_folder:
      left.empty_folders.emplace_back(order.path);
      break;
    case Kind::end_now:
    case Kind::done:
      break;
  }
}

enum class Socket { none, dead, live };

/// Whether this is a socket, and a process listens at it.
Socket state_of_socket(const std::string& path) {
  sockaddr_un address{};
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode) || path.size() >= sizeof address.sun_path) {
    return Socket::none;
  }
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  const int client = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (client < 0) return Socket::none;
  const int result = ::connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  const bool is_dead = result != 0 && errno == ECONNREFUSED;
  ::close(client);
  return is_dead ? Socket::dead : Socket::live;
}

/// While it is open, no server is between its look at the path of this lock and listening there. -1: one is.
int hold(const char* lock) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path + 1, lock, std::min(std::strlen(lock), sizeof address.sun_path - 1));
  const int held = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (held < 0 || ::bind(held, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return held;
  ::close(held);
  return -1;
}

/// Whether nothing is left to do: it is removed, another's, or not there.
bool remove_dead(const Order& socket) {
  const int held = hold(socket.lock);
  if (held < 0) return false;
  const Socket state = state_of_socket(socket.path);
  if (state == Socket::dead) ::unlink(socket.path);
  ::close(held);
  return state != Socket::live;
}

/// A process that is killed closes its files one after the other: its socket may live a little longer than the pipe that tells its end.
/// Meanwhile another server may listen at the same path, with a new file that may have the same inode.
void remove_dead_sockets(std::vector<Order> sockets) {
  for (int wait = 1; wait < 256; wait *= 2) {  // 0.3 s in all, if it is another's
    std::erase_if(sockets, remove_dead);
    if (sockets.empty()) return;
    sleep_ms(wait);
  }
  std::erase_if(sockets, remove_dead);
}

void clean_up(const Left& left) {
  for (const pid_t group : left.groups) ::kill(-group, SIGKILL);
  // A process that is being killed may still write into the folder.
  const auto is_there = [](pid_t group) { return ::kill(-group, 0) == 0; };
  for (int i = 0; i < 1000 && std::ranges::any_of(left.groups, is_there); ++i) sleep_ms(1);
  remove_dead_sockets(left.sockets);
  for (const std::string& folder : left.folders) remove_locked_folder(folder, longest_removal);
  for (const std::string& folder : left.empty_folders) ::rmdir(folder.c_str());
}

/// The next order; none at the end of the pipe.
std::optional<Order> read_order(int pipe) {
  Order order;
  std::size_t have = 0;
  while (have < sizeof order) {
    const ssize_t count = ::read(pipe, reinterpret_cast<char*>(&order) + have, sizeof order - have);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    have += static_cast<std::size_t>(count);
  }
  return order;
}

/// Keeps nothing of the watched process but the pipe: neither its terminal and session, nor its
/// files, whose readers wait for the last writer to close.
void detach(int pipe) {
  ::setsid();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(number, SIG_IGN);
  const int empty = ::open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (pipe != standard) ::dup2(empty, standard);
  }
  if (pipe > 3) ::close_range(3, static_cast<unsigned>(pipe) - 1, 0);
  ::close_range(static_cast<unsigned>(std::max(pipe, 2)) + 1, ~0U, 0);
}

void show_name(std::span<char*> arguments) {
  constexpr std::string_view name = "ziggurat-guardian";
  ::prctl(PR_SET_NAME, "zig-guardian");
  if (arguments.empty()) return;
  // Arguments lie behind each other in memory.
  char* const begin = arguments.front();
  const auto size =
      static_cast<std::size_t>(arguments.back() + std::strlen(arguments.back()) - begin);
  std::memset(begin, 0, size);
  std::memcpy(begin, name.data(), std::min(size, name.size()));
}

/// Ends by SIGKILL only.
struct Second {
  pid_t process = -1;  ///< -1: the system allows none
  int pipe = -1;       ///< to it
};

/// Nothing of it is left then.
void end(const Second& second) {
  if (second.process < 0) return;
  ::close(second.pipe);
  ::kill(second.process, SIGKILL);
  ::waitpid(second.process, nullptr, 0);
}

/// In the second guardian: learns what the first one learns, until that is killed.
void stand_by(int first, Left& left) {
  ::setsid();                          // a signal for the first one's group is not for it
  ::prctl(PR_SET_PDEATHSIG, SIGCONT);  // it may have been stopped
  while (const auto order = read_order(first)) {
    if (order->kind == Kind::done) ::_exit(0);
    take(*order, left);
  }
  ::close(first);
}

/// Starts a second guardian, in which this returns when the first one has been killed; and so on.
Second make_second(Left& left) {
  for (;;) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return {};
    const pid_t process = ::fork();
    if (process != 0) {
      ::close(ends[0]);
      if (process > 0) return {process, ends[1]};
      ::close(ends[1]);
      return {};
    }
    ::close(ends[1]);
    stand_by(ends[0], left);
  }
}

/// The second one has the next order before it is taken out of the pipe: the first may be killed at
/// any moment.
void pass_on(int pipe, Left& left, Second& second) {
  pollfd wait{pipe, POLLIN, 0};
  while (::poll(&wait, 1, -1) < 0 && errno == EINTR) {
  }
  // Without waiting: one that was stopped does not stop the first.
  const auto copy = [&] { return ::tee(pipe, second.pipe, sizeof(Order), SPLICE_F_NONBLOCK); };
  if (copy() >= 0 || errno != EPIPE) return;
  end(second);  // it was killed
  second = make_second(left);
  copy();
}

/// In a process of its own, so that this one can end: the watched process may start others and make files until it has
/// ended, too.
void clean_up_again(int pipe, Left left) {
  if (::fork() != 0) return;
  left.groups.clear();  // killed already: the system may use their ids again
  while (const auto order = read_order(pipe)) take(*order, left);
  clean_up(left);
  ::_exit(0);
}

[[noreturn]] void guard(int pipe, std::span<char*> arguments) {
  detach(pipe);
  show_name(arguments);
  Left left;
  Second second = make_second(left);
  for (;;) {
    pass_on(pipe, left, second);
    const auto order = read_order(pipe);
    if (!order || order->kind == Kind::end_now) clean_up(left);
    if (order && order->kind == Kind::end_now) clean_up_again(pipe, left);
    if (!order || order->kind == Kind::end_now || order->kind == Kind::done) {
      end(second);
      ::_exit(0);
    }
    take(*order, left);
  }
}

}  // namespace

Guardian::Guardian(std::span<char*> arguments) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  }
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[1]);
    guard(ends[0], arguments);
  }
  const int error = errno;
  ::close(ends[0]);
  orders_ = ends[1];
  // So that a guardian that was stopped stops nothing else.
  ::fcntl(orders_, F_SETFL, O_NONBLOCK);
  if (process_ < 0) {
    ::close(orders_);
    throw std::system_error(error, std::generic_category(), "cannot start a process");
  }
}

Guardian::~Guardian() {
  if (process_ < 0) return;
  send(orders_, {});
  ::close(orders_);
  if (has_ended(100)) return;
  ::kill(process_, SIGKILL);  // it has nothing to do any more; it was stopped, perhaps
  ::waitpid(process_, nullptr, 0);
}

void Guardian::end_group(pid_t group) const noexcept {
  Order order;
  order.kind = Kind::end_group;
  order.group = group;
  send(orders_, order);
}

void Guardian::forget_group(pid_t group) const noexcept {
  Order order;
  order.kind = Kind::forget_group;
  order.group = group;
  send(orders_, order);
}

void Guardian::remove_dead_socket(const std::string& path, const std::string& lock) const noexcept {
  send_path(orders_, Kind::remove_dead_socket, path, lock);
}

void Guardian::remove_folder(const std::string& path) const noexcept {
  send_path(orders_, Kind::remove_folder, path);
}

void Guardian::forget_folder(const std::string& path) const noexcept {
  send_path(orders_, Kind::forget_folder, path);
}

void Guardian::remove_empty_folder(const std::string& path) const noexcept {
  send_path(orders_, Kind::remove_empty_folder, path);
}

void Guardian::end_now() noexcept {
  Order order;
  order.kind = Kind::end_now;
  send(orders_, order);  // the pipe stays open: its end is that of this process
  if (!has_ended(300)) ::kill(process_, SIGCONT);  // it goes on by itself, also if it was stopped
  process_ = -1;
}

bool Guardian::has_ended(int most_ms) const noexcept {
  for (int i = 0; i < most_ms; ++i) {
    if (::waitpid(process_, nullptr, WNOHANG) != 0) return true;
    sleep_ms(1);
  }
  return false;
}

}  // namespace ziggurat::processes
