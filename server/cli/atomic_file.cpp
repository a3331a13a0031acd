// SPDX-License-Identifier: MIT
#include "cli/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

constexpr int interruptions[] = {SIGINT, SIGTERM, SIGHUP};

std::atomic<const char*> unfinished =
    nullptr;  // to be removed; handlers of signals may use no more than this

void remove_and_end(int number) {
  constexpr std::string_view words =
      "ziggurat: interrupted; the file was not finished and is removed\n";
  if (const char* const path = unfinished.exchange(nullptr)) {
    ::unlink(path);
    pollfd reader{STDERR_FILENO, POLLOUT, 0};  // a full pipe must not hold up the end
    if (::poll(&reader, 1, 0) == 1) {
      [[maybe_unused]] const ssize_t told = ::write(STDERR_FILENO, words.data(), words.size());
    }
  }
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// A signal that is ignored, as by nohup, stays so.
void handle_interruptions() {
  for (const int number : interruptions) {
    struct sigaction action = {};
    ::sigaction(number, nullptr, &action);
    if (action.sa_handler != SIG_DFL) continue;
    action.sa_handler = remove_and_end;
    ::sigaction(number, &action, nullptr);
  }
}

}  // namespace

AtomicFile::AtomicFile(std::string out) : out_(std::move(out)), part_(out_) {
  std::error_code error;
  if (out_ == "-" || (fs::exists(out_, error) && !fs::is_regular_file(out_, error))) return;
  target_ = fs::is_symlink(out_, error) ? fs::weakly_canonical(out_, error).string() : out_;
  part_ = fmt::format("{}.{}.part", target_, ::getpid());  // another process may write the same
  fs::remove(part_, error);                                // of a process that was killed
  const int file = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0)
    throw std::runtime_error(fmt::format("{} can't be written: {}", out_, std::strerror(errno)));
  ::close(file);
  unfinished = part_.c_str();
  handle_interruptions();
}

AtomicFile::~AtomicFile() {
  if (target_.empty() || unfinished.exchange(nullptr) == nullptr) return;
  std::error_code error;
  fs::remove(part_, error);
}

void AtomicFile::commit() {
  if (target_.empty()) return;
  std::error_code error;
  fs::rename(part_, target_, error);
  if (error)
    throw std::runtime_error(fmt::format("{} can't be written: {}", out_, error.message()));
  unfinished = nullptr;
}

}  // namespace ziggurat::cli
