// SPDX-License-Identifier: MIT
#include "processes/signals.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

namespace ziggurat::processes {
namespace {

constexpr int interrupted = 130;  // exit code

void close_if_open(int descriptor) {
  if (descriptor >= 0) ::close(descriptor);
}

bool is_ignored(int number) {
  struct sigaction action {};
  return ::sigaction(number, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

Signals::Signals(const Guardian* guardian) : guardian_(guardian) {
  sigset_t set;
  ::sigemptyset(&set);
  // SIGXCPU: a soft limit of processor time, as of `ulimit -S -t`, ends the run as Ctrl-C does.
  for (const int number : {SIGINT, SIGTERM, SIGXCPU, SIGCHLD}) ::sigaddset(&set, number);
  if (!is_ignored(SIGHUP))
    ::sigaddset(&set, SIGHUP);  // blocked, it would arrive although it is ignored
  ::signal(SIGCHLD,
           SIG_DFL);  // ignored, as a parent may have left it, it would take children away unseen
  ::pthread_sigmask(SIG_BLOCK, &set, &former_);
  ::signal(SIGPIPE, SIG_IGN);
  signals_ = ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  news_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  order_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  const int error = errno;
  if (signals_ < 0 || news_ < 0 || order_ < 0) {
    for (const int descriptor : {signals_, news_, order_}) close_if_open(descriptor);
    throw std::system_error(error, std::generic_category(), "signals cannot be received");
  }
  thread_ = std::thread([this] { watch(); });
}

Signals::~Signals() {
  is_ending_ = true;
  ::eventfd_write(order_, 1);
  thread_.join();
  receive();  // pending signals must not end the program when they are unblocked
  for (const int descriptor : {signals_, news_, order_}) ::close(descriptor);
  ::pthread_sigmask(SIG_SETMASK, &former_, nullptr);
}

Signals::Arrived Signals::take() {
  eventfd_t ignored = 0;
  ::eventfd_read(news_, &ignored);
  return {interruptions_.exchange(0), child_.exchange(false)};
}

/// Whether there was an interruption.
bool Signals::receive() {
  bool is_interrupted = false;
  signalfd_siginfo info;
  while (::read(signals_, &info, sizeof info) == sizeof info) {
    if (info.ssi_signo == SIGCHLD) {
      child_ = true;
    } else {
      if (!was_interrupted_ && !is_interrupted) first_ = static_cast<int>(info.ssi_signo);
      ++interruptions_;
      is_interrupted = true;
    }
  }
  return is_interrupted;
}

void Signals::interrupt_at_end_of(int descriptor) {
  input_ = descriptor;
  ::eventfd_write(order_, 1);
}

/// Reads on. @pre it does not wait for input
bool Signals::has_input_ended() {
  char ignored[4096];
  const ssize_t count = ::read(input_, ignored, sizeof ignored);
  const bool goes_on = count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
  if (goes_on) return false;
  input_ = -1;
  ++interruptions_;
  return true;
}

/// The thread.
void Signals::watch() {
  using clock = std::chrono::steady_clock;
  std::optional<clock::time_point> deadline;
  for (;;) {
    int timeout = -1;
    if (deadline) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - clock::now());
      timeout = std::max(0, static_cast<int>(left.count()));
    }
    pollfd descriptors[] = {{signals_, POLLIN, 0}, {order_, POLLIN, 0}, {input_, POLLIN, 0}};
    ::poll(descriptors, std::size(descriptors), timeout);
    if (is_ending_) return;
    if (deadline && clock::now() >= *deadline) end_by_force();
    eventfd_t ignored = 0;
    if (descriptors[1].revents != 0) ::eventfd_read(order_, &ignored);
    if (descriptors[0].revents == 0 && descriptors[2].revents == 0) continue;
    // take() may have reset the count already.
    bool is_interrupted = receive();
    if (descriptors[2].revents != 0) is_interrupted |= has_input_ended();
    was_interrupted_ = was_interrupted_ || is_interrupted;
    if (is_interrupted && !deadline) deadline = clock::now() + patience;
    ::eventfd_write(news_, 1);
  }
}

void Signals::limit_what_follows() const {
  if (!was_interrupted_) return;
  ::signal(SIGALRM, [](int) { ::_exit(interrupted); });
  ::alarm(1);
}

/// Without destructors: another thread is in the middle of something. The guardian cleans up.
void Signals::end_by_force() {
  constexpr std::string_view text =
      "\nziggurat: interrupted in the middle of a tick or of an output; the program did not wait "
      "for it\n";
  pollfd error{STDERR_FILENO, POLLOUT, 0};
  if (!is_completed_ && ::poll(&error, 1, 0) == 1 && (error.revents & POLLOUT) != 0) {
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
  }
  ::_exit(is_completed_ ? exit_code_.load() : interrupted);
}

}  // namespace ziggurat::processes
