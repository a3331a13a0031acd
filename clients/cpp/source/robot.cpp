#include "ziggurat/robot.h"

#include <algorithm>
#include <stdexcept>

#include "ziggurat/v1/envelope.h"

namespace ziggurat {

Joint& Robot::joint(std::string_view id) {
  const auto found =
      std::find_if(joints_.begin(), joints_.end(), [&](const Joint& j) { return j.id() == id; });
  if (found != joints_.end()) return *found;
  std::string message = "robot '" + id_ + "' has no joint '" + std::string(id) + "' with an " +
                        "encoder or a motor; it has ";
  if (joints_.empty()) message += "none";
  for (const Joint& joint : joints_) {
    message += (&joint == joints_.data() ? "'" : ", '") + joint.id() + "'";
  }
  throw std::out_of_range(message);
}

void Robot::log(std::string_view text) { add_line(false, text); }
void Robot::log_error(std::string_view text) { add_line(true, text); }

void Robot::add_line(bool error, std::string_view text) {
  constexpr std::size_t overhead = 16;  // bytes around a line's text, at most
  if (log_->bytes + text.size() + overhead > log_->max_bytes) {
    throw std::length_error("the session logs more than " + std::to_string(log_->max_bytes) +
                            " bytes at one tick");
  }
  log_->lines.push_back({position_, error, v1::valid_utf8(text)});
  log_->bytes += log_->lines.back().text.size() + overhead;
}

void Robot::fail(std::string_view message) {
  if (failed_) return;
  failed_ = true;
  failure_ = message.empty() ? "failed" : v1::valid_utf8(message);
}

}  // namespace ziggurat
