// SPDX-License-Identifier: MIT
#include "program/turn.h"

#include <signal.h>

#include <mutex>

namespace ziggurat::lua {
namespace {

std::mutex scripts;

void change_mask(int how) {
  sigset_t timer;
  ::sigemptyset(&timer);
  ::sigaddset(&timer, SIGPROF);
  ::pthread_sigmask(how, &timer, nullptr);
}

bool is_blocked_outside = false;  // set before other threads begin

}  // namespace

Turn::Turn() {
  scripts.lock();
  change_mask(SIG_UNBLOCK);
}

Turn::~Turn() {
  if (is_blocked_outside) change_mask(SIG_BLOCK);
  scripts.unlock();
}

void block_script_signals() {
  change_mask(SIG_BLOCK);
  is_blocked_outside = true;
}

}  // namespace ziggurat::lua
