// SPDX-License-Identifier: MIT
#include "fleet.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "convert.h"
#include "layout.h"

namespace ziggurat {

Fleet::Fleet(const v1::Welcome& welcome) : robots_(size(welcome.robots_size())) {
  // Limit that every server allows at least (T4); half of smaller messages.
  log_.max_bytes =
      std::min<std::size_t>(welcome.max_message_bytes() / 2,
                            (std::size_t{256} << 10) + robots_.size() * (std::size_t{2} << 10));
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const v1::RobotDescription& from = welcome.robots(static_cast<int>(i));
    Robot& robot = robots_[i];
    robot.id_ = from.id();
    robot.controller_ = from.controller();
    robot.script_ = from.script();
    for (const v1::Parameter& param : from.params()) {
      robot.params_.emplace_back(param.name(), param.value());
    }
    robot.position_ = static_cast<std::uint32_t>(i);
    robot.log_ = &log_;
  }
  Layout{welcome, robots_, channels_}.add_all();
}

void Fleet::read(const v1::Observation& observation) {
  for (const auto& channel : channels_) channel->check(observation);
  for (const auto& channel : channels_) channel->read(observation);
}

void Fleet::write(v1::Command& command) {
  for (const auto& channel : channels_) channel->write(command);
  move_log_to(*command.mutable_log());
  move_metrics_to(*command.mutable_metrics());
}

void Fleet::sent() {
  for (const auto& channel : channels_) channel->sent();
}

void Fleet::repeat() {
  for (const auto& channel : channels_) channel->repeat();
}

void Fleet::reset() {
  for (const auto& channel : channels_) channel->reset();
}

void Fleet::resume(v1::Command commanded) {
  for (const auto& channel : channels_) channel->load(commanded);
}

void Fleet::remove(const google::protobuf::RepeatedField<std::uint32_t>& robots) {
  for (const std::uint32_t position : robots) {
    if (position < robots_.size()) robots_[position].is_gone_ = true;
  }
}

void Fleet::remove(std::string_view id) {
  if (by_id_.empty()) {
    for (Robot& robot : robots_) by_id_.emplace(robot.id_, &robot);
  }
  if (const auto found = by_id_.find(id); found != by_id_.end()) found->second->is_gone_ = true;
}

void Fleet::move_metrics_to(google::protobuf::RepeatedPtrField<v1::Metric>& metrics) {
  for (const auto& [key, value] : log_.metrics) {
    v1::Metric& metric = *metrics.Add();
    metric.set_robot(key.first);
    metric.set_name(key.second);
    metric.set_value(value);
  }
  log_.metrics.clear();
}

void check_metric(std::string_view name, double value) {
  constexpr std::size_t longest = 64;
  const bool is_name =
      !name.empty() && name.size() <= longest && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-' || c == '.';
      });
  if (!is_name) {
    throw std::invalid_argument("the name of a metric must have 1 to " + std::to_string(longest) +
                                " letters, digits, '_', '-' or '.', not '" +
                                std::string(name.substr(0, longest)) + "'");
  }
  check_finite(value, "the value of metric", name);
}

void Fleet::move_log_to(google::protobuf::RepeatedPtrField<v1::LogLine>& lines) {
  for (Robot::Line& from : log_.lines) {
    v1::LogLine& line = *lines.Add();
    line.set_robot(from.robot);
    line.set_error(from.severity == Robot::Severity::error);
    line.set_text(std::move(from.text));
  }
  log_.lines.clear();
  log_.bytes = 0;
}

std::vector<v1::Leave> Fleet::take_failures() {
  std::vector<v1::Leave> failures;
  for (Robot& robot : robots_) {
    if (robot.failure_.empty()) continue;
    v1::Leave& leave = failures.emplace_back();
    leave.add_robots(robot.position_);
    leave.set_reason(v1::Leave::FAILED);
    leave.set_message(std::exchange(robot.failure_, {}));
  }
  return failures;
}

void check_finite(double value, std::string_view what, std::string_view id) {
  if (std::isfinite(value)) return;
  std::string whose(what);
  if (!id.empty()) whose.append(" '").append(id).append("'");
  throw std::invalid_argument(whose + " is " + std::to_string(value) + "; it must be finite");
}

void check_drives(bool drives, const char* device) {
  if (drives) return;
  throw std::logic_error(std::string("the robot does not drive its ") + device +
                         ": the controller's <actuators> do not list it");
}

}  // namespace ziggurat
