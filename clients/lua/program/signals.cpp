// SPDX-License-Identifier: MIT
#include "program/signals.h"

#include <signal.h>
#include <unistd.h>

#include <initializer_list>

#include "script/interrupt.h"

namespace ziggurat::lua {
namespace {

constexpr unsigned patience_s = 3;  // wall time

volatile sig_atomic_t arrived = 0;

void handle(int number) {
  if (number == SIGALRM || arrived != 0) ::_exit(128 + (arrived != 0 ? arrived : number));
  arrived = number;
  interrupt_scripts();
  ::alarm(patience_s);  // a coroutine or a library function may never return
}

}  // namespace

void handle_signals() {
  struct sigaction action = {};
  action.sa_handler = handle;
  ::sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGALRM}) ::sigaction(number, &action, nullptr);
}

int arrived_signal() noexcept { return arrived; }

}  // namespace ziggurat::lua
