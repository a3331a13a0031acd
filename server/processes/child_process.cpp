// SPDX-License-Identifier: MIT
#include "processes/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <thread>

namespace ziggurat::processes {
namespace {

std::vector<std::string> environment_with(
    const std::vector<std::pair<std::string, std::string>>& added) {
  std::vector<std::string> result;
  for (const auto& [name, value] : added) result.push_back(name + "=" + value);
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text = *entry;
    const bool replaced = std::ranges::any_of(
        added, [&](const auto& each) { return text.starts_with(each.first + "="); });
    if (!replaced) result.emplace_back(text);
  }
  return result;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (auto& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

// Creates the file, or empties it. @throws std::system_error
int open_output(const std::string& path) {
  if (path.empty()) return -1;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) throw std::system_error(errno, std::generic_category(), path);
  return file;
}

// Between fork and exec: async-signal-safe calls only. Reports errno through the pipe.
[[noreturn]] void become(char* const* arguments, char* const* environment, pid_t parent, int report,
                         int output, const Guardian* guardian) {
  ::setpgid(0, 0);
  if (guardian) guardian->end_group(::getpid());
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // the parent died before prctl()
  for (const int number : {SIGINT, SIGTERM, SIGPIPE, SIGXFSZ, SIGCHLD}) ::signal(number, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int empty = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (empty >= 0) ::dup2(empty, STDIN_FILENO);
  if (output >= 0) {
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
  }
  ::execvpe(arguments[0], arguments, environment);
  const int error = errno;
  [[maybe_unused]] const auto written = ::write(report, &error, sizeof error);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(const Program& program, const Guardian* guardian) : guardian_(guardian) {
  auto arguments = program.arguments;
  auto environment = environment_with(program.environment);
  const auto argument_pointers = pointers(arguments);
  const auto environment_pointers = pointers(environment);
  const int output = open_output(program.output);
  int report[2];
  if (::pipe2(report, O_CLOEXEC) != 0) {
    const int error = errno;
    if (output >= 0) ::close(output);
    throw std::system_error(error, std::generic_category());
  }
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ == 0) {
    become(argument_pointers.data(), environment_pointers.data(), parent, report[1], output,
           guardian);
  }
  const int fork_error = errno;
  if (output >= 0) ::close(output);
  ::close(report[1]);
  if (id_ < 0) {
    ::close(report[0]);
    throw std::system_error(fork_error, std::generic_category());
  }
  ::setpgid(id_, id_);  // in both processes, so that neither must wait for the other
  int error = 0;
  ssize_t count;
  do {
    count = ::read(report[0], &error, sizeof error);
  } while (count < 0 && errno == EINTR);
  ::close(report[0]);
  if (count == sizeof error) {
    collect();
    throw std::system_error(error, std::generic_category());
  }
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : guardian_(other.guardian_), id_(std::exchange(other.id_, -1)), status_(other.status_) {}

ChildProcess::~ChildProcess() {
  if (id_ < 0) return;
  // Until waitpid() the id of the group cannot be reused.
  if (!status_) {
    signal(SIGKILL);
    collect();
  }
}

/// Waits until it has ended. Afterwards its id may be that of another process.
int ChildProcess::collect() {
  if (guardian_) guardian_->forget_group(id_);
  int status = 0;
  ::waitpid(id_, &status, 0);
  return status;
}

bool ChildProcess::poll() {
  if (status_) return true;
  siginfo_t info{};
  if (::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
      info.si_pid == 0) {
    return false;
  }
  signal(SIGKILL);  // the processes that it left in its group
  status_ = collect();
  return true;
}

std::string ChildProcess::how_it_ended() const {
  const int status = status_.value();
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return fmt::format("was killed by signal {} ({})", number, ::strsignal(number));
  }
  return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

int ChildProcess::exit_code() const {
  const int status = status_.value();
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

void ChildProcess::signal(int number) const {
  if (id_ > 0 && !status_) ::kill(-id_, number);  // later the id may be another group's
}

void end_all(std::vector<ChildProcess*> children, int patience_ms,
             const std::function<bool()>& hurry,
             const std::function<void(const ChildProcess&)>& tell_slow) {
  using clock = std::chrono::steady_clock;
  for (const int number : {0, SIGTERM, SIGKILL}) {
    for (const auto* child : children) {
      if (number == SIGTERM && tell_slow) tell_slow(*child);
      if (number != 0) child->signal(number);
    }
    const auto deadline = clock::now() + std::chrono::milliseconds(patience_ms);
    while (number == SIGKILL || clock::now() < deadline) {
      std::erase_if(children, [](ChildProcess* child) { return child->poll(); });
      if (children.empty()) return;
      if (hurry()) {
        for (const auto* child : children) child->signal(SIGKILL);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

}  // namespace ziggurat::processes
