// SPDX-License-Identifier: MIT
#include <ziggurat/ziggurat.h>

#include <cstdio>

// Exits with 0 if the library links, runs and reports that no server answers.
int main() {
  ziggurat::Options options;
  options.endpoint = "ipc://@ziggurat-no-server";
  options.connect_timeout = std::chrono::milliseconds{20};
  try {
    ziggurat::Session session(options);
  } catch (const ziggurat::ConnectionError& error) {
    std::puts(error.what());
    return 0;
  }
  return 1;
}
