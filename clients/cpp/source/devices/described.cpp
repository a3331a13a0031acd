// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "find.h"
#include "layout.h"
#include "text/printable.h"
#include "ziggurat/device.h"

namespace ziggurat {

/// Readings of all described devices of a session at a tick.
struct DeviceValues {
  std::vector<double> readings;
  std::vector<double> rows;         // of all devices with rows
  std::vector<std::size_t> begins;  // of each: its first value in `rows`; then their end
  std::vector<std::size_t> widths;  // of a row of each
};

namespace {

class DescribedReadings final : public Channel {
 public:
  DeviceValues& values() { return *values_; }

  void check(const v1::Observation& from) const override {
    const std::size_t lists = values_->widths.size();
    expect(size(from.device_readings_size()), values_->readings.size(), "readings of devices");
    expect(size(from.device_rows_size()), lists, "numbers of rows of devices");
    std::size_t rows = 0;
    for (std::size_t i = 0; i < lists; ++i) {
      rows += from.device_rows(static_cast<int>(i)) * values_->widths[i];
    }
    expect(size(from.device_row_values_size()), rows, "values in rows of devices");
  }
  void read(const v1::Observation& from) override {
    std::ranges::copy(from.device_readings(), values_->readings.begin());
    values_->rows.assign(from.device_row_values().begin(), from.device_row_values().end());
    for (std::size_t i = 0; i < values_->widths.size(); ++i) {
      values_->begins[i + 1] =
          values_->begins[i] + from.device_rows(static_cast<int>(i)) * values_->widths[i];
    }
  }

 private:
  std::unique_ptr<DeviceValues> values_ = std::make_unique<DeviceValues>();
};

void copy(const google::protobuf::RepeatedPtrField<v1::DeviceField>& from,
          std::vector<DeviceField>& to) {
  for (const v1::DeviceField& field : from) to.push_back({field.name(), field.unit()});
}

DeviceKind kind_of(const v1::DeviceKind& from) {
  DeviceKind kind;
  kind.name = from.name();
  kind.reads_rows = from.most_rows() > 0;
  copy(from.readings(), kind.readings);
  copy(from.properties(), kind.properties);
  for (const v1::DeviceCommand& field : from.commands()) {
    kind.commands.push_back(
        {{field.name(), field.unit()}, field.least(), field.most(), field.initial()});
  }
  if (kind.reads_rows && kind.readings.empty()) {
    throw std::runtime_error("the server describes rows of '" + text::printable_part(kind.name) +
                             "' without readings");
  }
  return kind;
}

/// Place of a field of that name. @throws std::out_of_range
template <class Fields>
std::size_t find_field(const Fields& fields, std::string_view name, const Device& device,
                       const char* what) {
  const auto found = std::ranges::find(
      fields, name, [](const auto& field) -> std::string_view { return field.name; });
  if (found != fields.end()) return static_cast<std::size_t>(found - fields.begin());
  std::string message = device.kind().name + " has no " + what + " '" + std::string(name) +
                        "'; it has " + (fields.empty() ? "none" : "");
  for (const auto& field : fields) {
    message += (&field == fields.data() ? "'" : ", '") + field.name + "'";
  }
  throw std::out_of_range(text::printable_part(message));
}

}  // namespace

void Layout::add_described() {
  DeviceValues& values = add(DescribedReadings()).values();
  auto& commands = add(Settings<double>(&v1::Command::mutable_device_commands));
  values.begins.push_back(0);
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.device_kinds_.reserve(size(robot.device_kinds_size()));
    for (const v1::DeviceKind& from : robot.device_kinds()) {
      const DeviceKind& kind = to.device_kinds_.emplace_back(kind_of(from));
      for (const v1::DescribedDevice& described : from.devices()) {
        Device& device = to.devices_.emplace_back();
        device.kind_ = &kind;
        device.id_ = described.id();
        device.anchor_ = described.anchor();
        copy(described.position(), device.position_);
        copy(described.orientation(), device.orientation_);
        device.properties_.assign(described.properties().begin(), described.properties().end());
        device.properties_.resize(kind.properties.size());
        device.values_ = &values;
        device.place_ = kind.reads_rows ? values.widths.size() : values.readings.size();
        if (kind.reads_rows) {
          values.widths.push_back(kind.readings.size());
          values.begins.push_back(0);
        } else {
          values.readings.resize(values.readings.size() + kind.readings.size());
        }
        for (const DeviceCommand& command : kind.commands) {
          device.commands_.push_back(&commands.add(command.initial));
        }
        device.changed_ = &commands.changed();
      }
    }
  });
}

std::span<const double> Device::readings() const noexcept {
  if (kind_->reads_rows) return {};
  return std::span(values_->readings).subspan(place_, kind_->readings.size());
}

double Device::reading(std::string_view name) const {
  const std::size_t field = find_field(kind_->readings, name, *this, "reading");
  if (kind_->reads_rows) {
    throw std::out_of_range(text::printable_part(kind_->name) +
                            " reads rows; use row_count() and row(index)");
  }
  return readings()[field];
}

double Device::property(std::string_view name) const {
  return properties_[find_field(kind_->properties, name, *this, "property")];
}

std::size_t Device::row_count() const noexcept {
  if (!kind_->reads_rows) return 0;
  return (values_->begins[place_ + 1] - values_->begins[place_]) / kind_->readings.size();
}

std::span<const double> Device::row(std::size_t index) const noexcept {
  const std::size_t width = kind_->readings.size();
  return std::span(values_->rows).subspan(values_->begins[place_] + index * width, width);
}

void Device::set(std::string_view name, double value) {
  const std::size_t field = find_field(kind_->commands, name, *this, "command");
  check_finite(value, name, kind_->name);
  const DeviceCommand& command = kind_->commands[field];
  if (value < command.least || value > command.most) {
    throw std::invalid_argument(text::printable_part(command.name + " of " + kind_->name + " is " +
                                                     std::to_string(value) + "; it must be from " +
                                                     std::to_string(command.least) + " to " +
                                                     std::to_string(command.most)));
  }
  *commands_[field] = value;
  *changed_ = true;
}

double Device::commanded(std::string_view name) const {
  return *commands_[find_field(kind_->commands, name, *this, "command")];
}

// --- of a robot ---------------------------------------------------------------------------------

std::span<Device> Robot::devices(std::string_view kind) noexcept {
  const auto is_of_kind = [&](const Device& device) { return device.kind().name == kind; };
  const auto begin = std::ranges::find_if(devices_, is_of_kind);
  return {begin, std::find_if_not(begin, devices_.end(), is_of_kind)};
}

Device& Robot::device(std::string_view kind, std::string_view id) {
  auto all = devices(kind);
  return find(all, id, "robot '" + id_ + "'", std::string(kind));
}

}  // namespace ziggurat
