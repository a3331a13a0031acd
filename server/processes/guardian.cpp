// SPDX-License-Identifier: MIT
#include "processes/guardian.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "processes/private_folder.h"

namespace ziggurat::processes {
namespace {

enum class Kind : std::int32_t { end_group, forget_group, remove_dead_socket, remove_folder };

/// One write to the pipe: shorter than PIPE_BUF, so that orders of several processes do not mix.
struct Order {
  Kind kind{};
  pid_t group = 0;
  char path[512] = {};
};

void send(int pipe, const Order& order) noexcept {
  while (::write(pipe, &order, sizeof order) < 0 && errno == EINTR) {
  }
}

void send_path(int pipe, Kind kind, const std::string& path) noexcept {
  Order order;
  order.kind = kind;
  if (path.size() >= sizeof order.path) return;
  std::memcpy(order.path, path.c_str(), path.size() + 1);
  send(pipe, order);
}

// --- the guardian's process
// -----------------------------------------------------------------------

/// Processes, sockets and folders that remain if the watched process ends now.
struct Left {
  std::vector<pid_t> groups;
  std::vector<std::string> sockets, folders;
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
      left.sockets.emplace_back(order.path);
      break;
    case Kind::remove_folder:
      left.folders.emplace_back(order.path);
      break;
  }
}

/// Whether this is a socket at which no process listens: another server may have begun at its path.
bool is_dead_socket(const std::string& path) {
  sockaddr_un address{};
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISSOCK(status.st_mode) ||
      path.size() >= sizeof address.sun_path)
    return false;
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, path.size());
  const int client = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const bool is_dead =
      ::connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 &&
      errno == ECONNREFUSED;
  ::close(client);
  return is_dead;
}

void clean_up(const Left& left) {
  for (const pid_t group : left.groups) ::kill(-group, SIGKILL);
  // A process that is being killed may still write into the folder.
  const auto is_there = [](pid_t group) { return ::kill(-group, 0) == 0; };
  const timespec millisecond{0, 1'000'000};
  for (int i = 0; i < 1000 && std::ranges::any_of(left.groups, is_there); ++i)
    ::nanosleep(&millisecond, nullptr);
  for (const std::string& socket : left.sockets) {
    if (is_dead_socket(socket)) ::unlink(socket.c_str());
  }
  for (const std::string& folder : left.folders) remove_locked_folder(folder);
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

/// @param watched  process that starts this one
[[noreturn]] void guard(int pipe, pid_t watched, std::span<char*> arguments) {
  detach(pipe);
  show_name(arguments);
  pollfd end{static_cast<int>(::syscall(SYS_pidfd_open, watched, 0)), POLLIN, 0};
  Left left;
  while (const auto order = read_order(pipe)) take(*order, left);
  // A process that is killed closes its files one after the other: its sockets live until it has
  // ended.
  while (end.fd >= 0 && ::poll(&end, 1, -1) < 0 && errno == EINTR) {
  }
  clean_up(left);
  ::_exit(0);
}

}  // namespace

Guardian::Guardian(std::span<char*> arguments) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pipe");
  }
  const pid_t watched = ::getpid();
  process_ = ::fork();
  if (process_ == 0) {
    ::close(ends[1]);
    guard(ends[0], watched, arguments);
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
  ::close(orders_);
  ::kill(process_, SIGCONT);  // it was stopped, perhaps
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

void Guardian::remove_dead_socket(const std::string& path) const noexcept {
  send_path(orders_, Kind::remove_dead_socket, path);
}

void Guardian::remove_folder(const std::string& path) const noexcept {
  send_path(orders_, Kind::remove_folder, path);
}

}  // namespace ziggurat::processes
