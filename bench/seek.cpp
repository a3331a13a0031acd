// SPDX-License-Identifier: MIT
// Time to open a recording and to read the poses at a moment, the exact state included: bench_seek
// FILE.mcap [TIMES]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "recording/mcap/messages.h"

int main(int count, char** arguments) {
  using namespace ziggurat::mcap;
  using clock = std::chrono::steady_clock;
  if (count < 2) return 1;
  const int times = count > 2 ? std::atoi(arguments[2]) : 100;
  std::mt19937_64 random(1);
  std::vector<double> seconds;
  for (int i = 0; i < times; ++i) {
    const auto begin = clock::now();
    const Reader reader(open_file(arguments[1]));
    const Contents& all = reader.contents();
    const std::uint64_t end = all.statistics.end_time, moment = random() % (end + 1);
    const Channel *poses = all.channel_of("/poses"), *state = all.channel_of("/state");
    if (!poses || !state) return 1;
    // The first state of the chunk is complete, the others say what changed.
    const auto chunk = std::find_if(all.chunks.rbegin(), all.chunks.rend(),
                                    [&](const auto& each) { return each.start_time <= moment; });
    if (chunk == all.chunks.rend()) return 1;
    Messages messages(reader, {{poses->id, state->id}, chunk->start_time, moment});
    std::size_t bytes = 0;
    while (const auto message = messages.next()) bytes += message->data.size();
    if (bytes == 0) return 1;
    seconds.push_back(std::chrono::duration<double>(clock::now() - begin).count());
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("%d seeks: median %.1f ms, longest %.1f ms\n", times,
              1e3 * seconds[seconds.size() / 2], 1e3 * seconds.back());
}
