// SPDX-License-Identifier: MIT
#include "layout.h"
#include "text/printable.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

/// Markers that the robots of a session draw.
class Markers final : public Channel {
 public:
  explicit Markers(std::size_t robots) : counts_(robots) {}

  /// A new marker of a robot. @throws std::length_error
  v1::Marker& add(const std::string& robot, std::uint32_t position) {
    if (counts_[position] == Robot::max_markers) {
      throw std::length_error("robot '" + text::printable_part(robot) + "' draws more than " +
                              std::to_string(Robot::max_markers) + " markers at this tick");
    }
    ++counts_[position];
    v1::Marker& marker = *drawn_.Add();
    marker.set_robot(position);
    return marker;
  }

  void write(v1::Command& to) override { to.mutable_markers()->Swap(&drawn_); }
  void sent() override { reset(); }
  void reset() override {
    drawn_.Clear();
    std::fill(counts_.begin(), counts_.end(), 0);
  }

 private:
  google::protobuf::RepeatedPtrField<v1::Marker> drawn_;  // long-lived: keeps its memory
  std::vector<std::size_t> counts_;                       // by robot
};

namespace {

using Place = std::array<double, 3>;

void check_place(const Place& place) {
  constexpr double largest = 1e6;  // [m]
  for (const double value : place) {
    if (std::abs(value) <= largest) continue;
    throw std::invalid_argument("places of markers must lie within -1e6 and 1e6");
  }
}

void add_place(const Place& place, google::protobuf::RepeatedField<double>& to) {
  for (const double value : place) to.Add(value);
}

}  // namespace

void Layout::add_markers() {
  auto& markers = add(Markers(robots.size()));
  each_robot([&](const v1::RobotDescription& from, Robot& to) {
    to.markers_ = from.draws_markers() ? &markers : nullptr;
  });
}

Markers& Robot::markers() {
  if (markers_ != nullptr) return *markers_;
  throw std::logic_error("robot '" + text::printable_part(id_) +
                         "' does not draw: the controller's <actuators> have no debug");
}

void Robot::draw_arrow(const std::array<double, 3>& from, const std::array<double, 3>& to,
                       Color color) {
  check_place(from);
  check_place(to);
  v1::Marker& marker = markers().add(id_, position_);
  add_place(from, *marker.mutable_at());
  add_place(to, *marker.mutable_to());
  marker.set_color(packed(color));
}

void Robot::draw_ring(const std::array<double, 3>& center, double radius, Color color) {
  check_place(center);
  check_place({radius, 0, 0});
  if (!(radius > 0)) throw std::invalid_argument("the radius of a ring must be above 0");
  v1::Marker& marker = markers().add(id_, position_);
  add_place(center, *marker.mutable_at());
  marker.set_radius(radius);
  marker.set_color(packed(color));
}

void Robot::draw_text(const std::array<double, 3>& at, std::string_view text, Color color) {
  check_place(at);
  std::string valid = v1::valid_utf8(text);
  if (valid.empty() || valid.size() > max_marker_text_bytes) {
    throw std::invalid_argument("the text of a marker must have 1 to " +
                                std::to_string(max_marker_text_bytes) + " bytes");
  }
  v1::Marker& marker = markers().add(id_, position_);
  add_place(at, *marker.mutable_at());
  marker.set_text(std::move(valid));
  marker.set_color(packed(color));
}

}  // namespace ziggurat
