#include "run/until_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/mcap/source.h"
#include "recording/replay/recording_error.h"
#include "text/numbers.h"

namespace ziggurat::run {

void check_until(const replay::RecordingFile& file, std::uint64_t until) {
  std::uint64_t least = 0, greatest = 0;
  try {
    replay::States states(file);
    const v1::Inputs* next = states.next();
    if (next == nullptr) return;
    for (least = greatest = next->tick(); next != nullptr; next = states.next()) {
      if (next->tick() == until) return;
      least = std::min<std::uint64_t>(least, next->tick());
      greatest = std::max<std::uint64_t>(greatest, next->tick());
    }
  } catch (const replay::RecordingError&) {
    return;
  } catch (const mcap::Damaged&) {
    return;
  }
  throw text::UsageError(fmt::format(
      "--until is {}, and {} has the ticks {} to {}; write one of them, or leave it out", until,
      file.path(), least, greatest));
}

}  // namespace ziggurat::run
