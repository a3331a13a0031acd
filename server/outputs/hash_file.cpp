#include "outputs/hash_file.h"

#include <fmt/format.h>

#include "math/hash.h"

namespace ziggurat::outputs {

std::string hash_line(std::uint64_t tick, std::uint64_t hash) {
  return fmt::format("hash {} {}", tick, math::to_hex(hash));
}

void HashFile::write(std::uint64_t tick, std::uint64_t hash) {
  file_.buffer().append(hash_line(tick, hash));
  file_.buffer().push_back('\n');
  file_.written();
}

}  // namespace ziggurat::outputs
