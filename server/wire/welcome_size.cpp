#include "wire/welcome_size.h"

#include "wire/devices.h"
#include "ziggurat/v1/extent.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

// Beside descriptions a Welcome has up to 1 MiB of commanded values, and of each robot a deadline's
// policy and whether it is gone.
constexpr std::size_t other_bytes = std::size_t{2} << 20, other_fields = std::size_t{1} << 17;
constexpr std::size_t policy_bytes = 24, policy_fields = 4;

struct Extent {
  std::size_t bytes = other_bytes;
  std::size_t fields = other_fields;

  bool is_decoded() const {
    return bytes <= v1::longest_sent_once && fields <= v1::most_fields_sent_once;
  }
};

}  // namespace

bool are_decoded(const Run& run, std::span<const std::size_t> robots) {
  if (robots.size() > v1::most_robots) return false;
  Extent extent;
  v1::RobotDescription description;
  for (const std::size_t robot : robots) {
    description.Clear();
    describe(run, robot, description);
    const std::string bytes = description.SerializeAsString();
    extent.bytes += bytes.size() + policy_bytes;
    extent.fields +=
        1 + policy_fields +
        v1::count_fields(bytes, *description.GetDescriptor(), v1::most_fields_sent_once);
    if (!extent.is_decoded()) return false;
  }
  return true;
}

bool is_decoded(const scene::Director& director) {
  constexpr std::size_t header = 16;  // of each, and more than that [bytes]
  Extent extent;
  for (const auto& [name, value] : director.params) {
    const std::size_t text = name.size() + value.size();
    extent.bytes += text + header;
    extent.fields += 3 + text / v1::bytes_per_field;
  }
  return extent.is_decoded();
}

}  // namespace ziggurat::wire
