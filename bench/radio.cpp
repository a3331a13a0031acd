// Radios at constant density: µs per radio and tick, for building the index and for delivery.
//
// usage: bench_radio [flat|full]
//
// Every radio sends one message of 8 bytes in every second tick and listens in the others, so that
// each tick has as many senders as receivers. About ten radios are within the range of each.

#include "media/radio.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

#include "media/devices_index.h"

namespace {

using namespace ziggurat;

constexpr double range = 1.0;      // [m]
constexpr double neighbours = 10;  // within range, on average

struct Crowd {
  world::Layout layout;
  world::State state;
};

Crowd make_crowd(std::size_t count, bool flat) {
  constexpr double pi = std::numbers::pi;
  const double per_radio =
      flat ? pi * range * range / neighbours : 4.0 / 3 * pi * range * range * range / neighbours;
  const double edge = flat ? std::sqrt(per_radio * static_cast<double>(count))
                           : std::cbrt(per_radio * static_cast<double>(count));
  std::mt19937_64 random(1);
  const auto draw = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 * edge; };
  Crowd crowd;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = draw(), y = draw(), z = flat ? 0 : draw();
    crowd.state.origins.push_back({{x, y, z}, math::Quaternion::Identity()});
    world::RadioLayout radio;
    radio.mount.entity = i;
    radio.range = range;
    radio.sends = radio.receives = true;
    crowd.layout.radios.push_back(radio);
  }
  return crowd;
}

/// Processor time of this thread [µs]; independent of other programs.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) / 1e3;
}

double median(std::vector<double>& values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void measure(std::size_t count, bool flat) {
  Crowd crowd = make_crowd(count, flat);
  media::DevicesIndex index(crowd.layout);
  media::RadioMedium medium;
  world::RadioMessages sent, received;
  const std::vector<std::uint8_t> payload(8, 42);
  std::vector<double> builds, deliveries;
  std::size_t messages = 0, ticks = 0;
  const std::size_t repetitions = std::max<std::size_t>(20, 400'000 / count);
  for (std::size_t tick = 0; tick < repetitions; ++tick) {
    for (std::size_t i = tick % 2; i < count; i += 2) sent.add(i, payload);
    const double start = now();
    index.build(crowd.state);
    const double built = now();
    medium.deliver(crowd.layout, index, sent, received);
    const double end = now();
    if (tick < 2) continue;  // buffers still grow
    builds.push_back((built - start) / static_cast<double>(count));
    deliveries.push_back((end - built) / static_cast<double>(count));
    messages += received.entries.size();
    ++ticks;
  }
  const double build = median(builds), delivery = median(deliveries);
  fmt::print("{:>8} {:>10.3f} {:>10.3f} {:>10.3f} {:>14.2f}\n", count, build + delivery, build,
             delivery, static_cast<double>(messages) / static_cast<double>(ticks * count));
}

}  // namespace

int main(int argument_count, char** arguments) {
  const bool full = argument_count > 1 && std::string_view(arguments[1]) == "full";
  fmt::print("{}, µs per radio and tick (median)\n", full ? "in a cube" : "on a plane");
  fmt::print("{:>8} {:>10} {:>10} {:>10} {:>14}\n", "radios", "together", "index", "delivery",
             "received each");
  for (const std::size_t count : {1'000, 3'000, 10'000, 30'000, 100'000}) measure(count, !full);
}
