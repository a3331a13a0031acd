#include <ziggurat/ziggurat.h>

#include <cstdio>

// Exits with 0 if the library links, runs and says what is missing.
int main() {
  ziggurat::Options options;
  options.endpoint = "ipc://@ziggurat-nobody-listens-here";
  options.connect_timeout = std::chrono::milliseconds{20};
  try {
    ziggurat::Session session(options);
  } catch (const ziggurat::ConnectionError& error) {
    std::puts(error.what());
    return 0;
  }
  return 1;
}
