// Devices that are set: LEDs, tags, magnets, the data of range and bearing.

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ziggurat/led.h"
#include "ziggurat/magnet.h"
#include "ziggurat/range_and_bearing.h"
#include "ziggurat/tag.h"

namespace ziggurat {

void Led::set_color(Color color) noexcept {
  *color_ = static_cast<std::uint32_t>(color.red) << 16 |
            static_cast<std::uint32_t>(color.green) << 8 | color.blue;
  *changed_ = true;
}

Color Led::color() const noexcept {
  return {static_cast<std::uint8_t>(*color_ >> 16), static_cast<std::uint8_t>(*color_ >> 8),
          static_cast<std::uint8_t>(*color_)};
}

void Tag::set_payload(std::string_view payload) {
  if (payload.size() > max_payload_bytes) {
    throw std::length_error("the payload of tag '" + id_ + "' has " +
                            std::to_string(payload.size()) + " bytes; " +
                            std::to_string(max_payload_bytes) + " are the most");
  }
  payload_->assign(payload);
  *changed_ = true;
}

void Magnet::set_current(double current) {
  if (!std::isfinite(current)) {
    throw std::invalid_argument("the current of magnet '" + id_ + "' is " +
                                std::to_string(current) + "; it must be finite");
  }
  *current_ = current;
  *changed_ = true;
}

namespace {

void check_sends(const RangeAndBearing& device) {
  if (device.sends()) return;
  throw std::logic_error(
      "the robot has no range-and-bearing actuator: the controller's <actuators> do not list it");
}

}  // namespace

void RangeAndBearing::set_data(Bytes data) {
  check_sends(*this);
  if (data.size() != data_size_) {
    throw std::invalid_argument("range-and-bearing data of " + std::to_string(data.size()) +
                                " bytes; this robot sends packets of " +
                                std::to_string(data_size_));
  }
  std::copy(data.begin(), data.end(), data_.begin());
  *changed_ = true;
}

void RangeAndBearing::clear_data() {
  check_sends(*this);
  std::fill(data_.begin(), data_.end(), std::uint8_t{0});
  *changed_ = true;
}

}  // namespace ziggurat
