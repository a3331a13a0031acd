#include "wire/leave.h"

#include "wire/command.h"
#include "wire/fault.h"
#include "wire/positions.h"

namespace ziggurat::wire {

std::optional<Fault> check(const v1::Leave& leave, const Roster& roster,
                           const world::Layout& layout) {
  if (leave.reason() != v1::Leave::DONE && leave.reason() != v1::Leave::FAILED) {
    return make_fault(ErrorCode::bad_value, "reason", "A Leave says DONE or FAILED as its reason.");
  }
  if (auto found = check_positions(leave.robots(), roster, layout)) return found;
  return check(leave.log(), roster);
}

}  // namespace ziggurat::wire
