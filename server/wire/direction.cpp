// SPDX-License-Identifier: MIT
#include "wire/direction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wire/command.h"
#include "wire/messages.h"
#include "wire/response.h"
#include "world/commands.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::wire {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

Fault fault_of(ErrorCode code, std::size_t act, std::string_view field, std::string message) {
  return make_fault(code, fmt::format("acts[{}].{}", act, field), std::move(message));
}

/// Whether it is empty or a bounded vector.
bool is_vector(const Numbers& values) {
  const auto is_bounded = [](double value) { return std::abs(value) <= world::largest_push; };
  return values.empty() || (values.size() == 3 && std::ranges::all_of(values, is_bounded));
}

std::optional<Fault> check_push(const v1::Push& push, std::size_t act) {
  for (const auto& [values, name] :
       {std::pair(&push.force(), "force"), {&push.torque(), "torque"}}) {
    if (is_vector(*values)) continue;
    return fault_of(ErrorCode::bad_value, act, fmt::format("push.{}", name),
                    fmt::format("A {} must be empty or three numbers from -1e6 to 1e6.", name));
  }
  return std::nullopt;
}

std::optional<Fault> check_show(const v1::Show& show, std::size_t act) {
  const auto is_color = [](std::uint32_t value) { return value <= 0xFFFFFF; };
  if (!std::ranges::all_of(show.led_colors(), is_color) ||
      !std::ranges::all_of(show.directional_led_colors(), is_color)) {
    return fault_of(ErrorCode::bad_value, act, "show", "A colour must be 0xRRGGBB.");
  }
  for (const std::string& payload : show.tag_payloads()) {
    if (payload.size() <= world::most_tag_payload_bytes) continue;
    return fault_of(ErrorCode::too_large, act, "show.tag_payloads",
                    fmt::format("The payload has {} bytes; at most {} are allowed.", payload.size(),
                                world::most_tag_payload_bytes));
  }
  return std::nullopt;
}

/// A region without size, which is not valid, if its lists have wrong lengths.
world::FloorPaint region_of(const v1::PaintFloor& from) {
  world::FloorPaint region{.is_disc = from.size_size() == 1, .color = from.color()};
  if (from.center_size() != 2 || from.size_size() < 1 || from.size_size() > 2) return region;
  region.center = {from.center(0), from.center(1)};
  region.half_size = region.is_disc ? std::array{from.size(0), from.size(0)}
                                    : std::array{from.size(0) / 2, from.size(1) / 2};
  return region;
}

std::optional<Fault> check_paint(const v1::PaintFloor& paint, std::size_t act) {
  if (!paint.image().empty()) {
    if (!paint.center().empty() || !paint.size().empty() || paint.color() != 0) {
      return fault_of(ErrorCode::bad_value, act, "paint_floor",
                      "An image covers the floor of the arena; leave center, size and color out.");
    }
    if (paint.image().size() <= world::longest_floor_image) return std::nullopt;
    return fault_of(ErrorCode::too_large, act, "paint_floor.image",
                    fmt::format("The image has {} bytes; at most {} are allowed.",
                                paint.image().size(), world::longest_floor_image));
  }
  if (is_valid(region_of(paint))) return std::nullopt;
  return fault_of(ErrorCode::bad_value, act, "paint_floor",
                  "A painted region has a center of two numbers from -1e6 to 1e6, a size of two "
                  "numbers (a rectangle) or one (the radius of a disc) above 0, and a color "
                  "0xRRGGBB; or it has an image alone.");
}

std::optional<Fault> check_act(const v1::DirectorAct& act, std::size_t number) {
  if (act.has_push()) return check_push(act.push(), number);
  if (act.has_show()) return check_show(act.show(), number);
  if (act.has_paint_floor()) return check_paint(act.paint_floor(), number);
  if (act.act_case() != v1::DirectorAct::ACT_NOT_SET) return std::nullopt;
  return make_fault(ErrorCode::bad_value, fmt::format("acts[{}]", number),
                    "The act has no kind that this server knows.");
}

std::array<double, 3> vector_of(const Numbers& from) {
  std::array<double, 3> to{};
  std::ranges::copy(from, to.begin());
  return to;
}

DirectorAct read(const v1::DirectorAct& from) {
  if (from.has_show()) {
    const v1::Show& show = from.show();
    return Show{show.entity(),
                {show.led_colors().begin(), show.led_colors().end()},
                {show.directional_led_colors().begin(), show.directional_led_colors().end()},
                {show.tag_payloads().begin(), show.tag_payloads().end()}};
  }
  if (from.has_push()) {
    const v1::Push& push = from.push();
    return Push{push.entity(), push.link(), vector_of(push.force()), vector_of(push.torque())};
  }
  if (from.has_paint_floor() && !from.paint_floor().image().empty())
    return LayImage{from.paint_floor().image()};
  if (from.has_paint_floor()) return region_of(from.paint_floor());
  if (from.has_move()) return wire::read(from.move());
  if (from.has_set_joint()) return wire::read(from.set_joint());
  Request request;
  if (from.has_spawn()) {
    request.kind = Request::Kind::spawn;
    request.text = from.spawn().xml();
  } else {
    request.kind = Request::Kind::remove;
    request.text = from.remove().entity();
  }
  return request;
}

/// Acts that take longer than others: there are fewer of them.
std::optional<Fault> check_slow_acts(const v1::Direction& direction) {
  std::size_t spawns = 0, images = 0;
  for (const v1::DirectorAct& act : direction.acts()) {
    spawns += act.has_spawn() ? 1 : 0;
    images += act.has_paint_floor() && !act.paint_floor().image().empty() ? 1 : 0;
  }
  if (spawns > most_spawns) {
    return make_fault(
        ErrorCode::too_many, "acts",
        fmt::format(
            "A Direction spawns {} entities; {} are allowed: spawn the others at later ticks.",
            spawns, most_spawns));
  }
  if (images > world::most_floor_images) {
    return make_fault(ErrorCode::too_many, "acts",
                      fmt::format("A Direction lays {} images on the floor; {} is allowed.", images,
                                  world::most_floor_images));
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> check(const v1::Direction& direction) {
  const auto acts = static_cast<std::size_t>(direction.acts_size());
  if (acts > most_acts) {
    return make_fault(ErrorCode::too_many, "acts",
                      fmt::format("A Direction has {} acts; {} are allowed.", acts, most_acts));
  }
  if (static_cast<std::size_t>(direction.log_size()) > most_direction_logs) {
    return make_fault(ErrorCode::too_many, "log",
                      fmt::format("A Direction has {} log lines; {} are allowed.",
                                  direction.log_size(), most_direction_logs));
  }
  if (auto fault = check_slow_acts(direction)) return fault;
  for (std::size_t i = 0; i < acts; ++i) {
    if (auto fault = check_act(direction.acts(static_cast<int>(i)), i)) return fault;
  }
  if (direction.finish().result().size() > longest_result) {
    return make_fault(ErrorCode::too_large, "finish.result",
                      fmt::format("The result has {} bytes; at most {} are allowed.",
                                  direction.finish().result().size(), longest_result));
  }
  return check_names_and_values(direction.metrics());
}

Direction read(const v1::Direction& from) {
  Direction direction;
  direction.acts.reserve(static_cast<std::size_t>(from.acts_size()));
  for (const v1::DirectorAct& act : from.acts()) direction.acts.push_back(read(act));
  for (const v1::Metric& metric : from.metrics()) {
    direction.metrics.push_back({0, metric.name(), metric.value()});
  }
  for (const v1::LogLine& line : from.log()) {
    direction.log.push_back({0, line.error(), line.text()});
  }
  if (from.has_finish()) direction.finish = from.finish().result();
  return direction;
}

}  // namespace ziggurat::wire
