// SPDX-License-Identifier: MIT
#include "ziggurat/robot.h"

#include <stdexcept>

#include "convert.h"
#include "find.h"
#include "text/printable.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

Joint& Robot::joint(std::string_view id) {
  return find(joints_, id, "robot '" + id_ + "'", "joint");
}
Radio& Robot::radio(std::string_view id) {
  return find(radios_, id, "robot '" + id_ + "'", "radio");
}
Led& Robot::led(std::string_view id) { return find(leds_, id, "robot '" + id_ + "'", "LED"); }
Led& Robot::directional_led(std::string_view id) {
  return find(directional_leds_, id, "robot '" + id_ + "'", "directional LED");
}
Tag& Robot::tag(std::string_view id) { return find(tags_, id, "robot '" + id_ + "'", "tag"); }
const Camera& Robot::camera(std::string_view id) const {
  return find(cameras_, id, "robot '" + id_ + "'", "camera");
}
Magnet& Robot::magnet(std::string_view id) {
  return find(magnets_, id, "robot '" + id_ + "'", "magnet");
}

void Robot::log(std::string_view text) { add_line(Severity::info, text); }
void Robot::log_error(std::string_view text) { add_line(Severity::error, text); }

void Robot::add_line(Severity severity, std::string_view text) {
  constexpr std::size_t overhead = 64;  // of a line, besides its text: it has four fields [bytes]
  std::string line = v1::valid_utf8(text);
  if (log_->bytes + line.size() + overhead > log_->max_bytes) {
    throw std::length_error("the session logs more than " + std::to_string(log_->max_bytes) +
                            " bytes at one tick");
  }
  log_->bytes += line.size() + overhead;
  log_->lines.push_back({position_, severity, std::move(line)});
}

void Robot::metric(std::string_view name, double value) {
  check_metric(name, value);
  constexpr std::size_t most_names = 100;  // as the server allows
  if (!metric_names_.contains(name)) {
    if (metric_names_.size() == most_names) {
      throw std::length_error("robot '" + text::printable_part(id_) + "' has " +
                              std::to_string(most_names) + " metrics already; '" +
                              std::string(name) + "' would be one more");
    }
    metric_names_.emplace(name);
  }
  log_->metrics.insert_or_assign({position_, std::string(name)}, value);
}

void Robot::fail(std::string_view message) {
  if (failed_) return;
  failed_ = true;
  failure_ = message.empty() ? "failed" : v1::valid_utf8(message);
}

}  // namespace ziggurat
