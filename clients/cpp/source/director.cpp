// SPDX-License-Identifier: MIT
#include "ziggurat/director.h"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "asked_place.h"
#include "directing.h"
#include "layout.h"
#include "session_core.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

struct Director::State {
  explicit State(const DirectorOptions& from) : options(from), part(options), core(options, part) {}

  /// Who finishes the run need not wait for a further tick: the present one is answered before the
  /// Leave.
  void answer_with_finish() {
    if (part.wants_finish() && core.owes && !core.is_over && !core.ending) core.answer();
  }

  DirectorOptions options;
  Directing part;
  SessionCore core;
};

namespace {

constexpr std::size_t longest_image = std::size_t{2} << 20;  // of the floor [bytes]

template <typename Numbers>
void add_numbers(const Numbers& from, const char* what, std::string_view entity,
                 google::protobuf::RepeatedField<double>& to) {
  for (const double number : from) {
    check_finite(number, what, entity);
    to.Add(number);
  }
}

template <typename Size>
void add_paint(Directing& to, const std::array<double, 2>& center, const Size& size, Color color) {
  for (const double length : size) {
    if (!(length > 0)) throw std::invalid_argument("a painted region must have a size above 0");
  }
  v1::PaintFloor paint;
  add_numbers(center, "the center of a region of", "the floor", *paint.mutable_center());
  add_numbers(size, "the size of a region of", "the floor", *paint.mutable_size());
  paint.set_color(packed(color));
  to.add_act(0).mutable_paint_floor()->Swap(&paint);
}

/// @throws std::invalid_argument without an id
const DirectorOptions& checked(const DirectorOptions& options) {
  if (!options.director.empty() || !options.session_token.empty()) return options;
  throw std::invalid_argument(
      "DirectorOptions::director is empty; it is the id of a director in the scene");
}

}  // namespace

DirectorOptions DirectorOptions::from_environment() {
  DirectorOptions options;
  options.read_environment();
  if (const char* director = std::getenv("ZIGGURAT_DIRECTOR")) options.director = director;
  return options;
}

Director::Director(const DirectorOptions& options)
    : state_(std::make_unique<State>(checked(options))) {
  state_->core.open();
}

Director::~Director() {
  try {
    if (std::uncaught_exceptions() <= state_->core.exceptions) state_->answer_with_finish();
  } catch (const std::exception&) {  // the server is gone
  }
  state_->core.leave_at_the_end();
}

bool Director::next() { return state_->core.next(); }
void Director::leave() {
  state_->answer_with_finish();
  state_->core.leave(v1::Leave::DONE, {});
}
void Director::leave_failed(std::string_view message) {
  state_->core.leave(v1::Leave::FAILED, message);
}

Event Director::event() const noexcept { return state_->core.event; }
std::uint64_t Director::tick() const noexcept { return state_->core.now.tick; }
std::chrono::nanoseconds Director::time() const noexcept {
  return std::chrono::nanoseconds(state_->core.now.time_ns);
}
const std::optional<Ending>& Director::ending() const noexcept { return state_->core.ending; }
std::uint64_t Director::missed() const noexcept { return state_->core.missed; }
std::uint64_t Director::resumes() const noexcept { return state_->core.resumes; }
std::vector<std::string> Director::take_warnings() { return state_->part.take_warnings(); }
const std::string& Director::id() const noexcept { return state_->part.id(); }
const std::vector<std::pair<std::string, std::string>>& Director::params() const noexcept {
  return state_->part.params();
}
const std::string& Director::script() const noexcept { return state_->part.script(); }
std::uint64_t Director::seed() const noexcept { return state_->core.seed; }
std::chrono::nanoseconds Director::tick_length() const noexcept { return state_->core.tick_length; }
const std::string& Director::token() const noexcept { return state_->core.token; }

std::span<Entity* const> Director::entities() const noexcept {
  return state_->part.world().present();
}
bool Director::entities_have_changed() const noexcept { return state_->part.world().has_changed(); }
const Entity* Director::find(std::string_view id) const noexcept {
  return state_->part.world().find(id);
}
const Entity& Director::entity(std::string_view id) const {
  if (const Entity* found = find(id)) return *found;
  throw std::out_of_range("the director is told of no entity '" + std::string(id) +
                          "' in the world");
}
std::span<const Contact> Director::contacts() const noexcept {
  return state_->part.world().contacts();
}
std::span<const RadioMessage> Director::radio_messages() const noexcept {
  return state_->part.world().radio_messages();
}

std::optional<std::string> Director::overlapped(
    std::string_view what, const std::array<double, 3>& position,
    const std::optional<std::array<double, 4>>& orientation) {
  v1::ClientMessage question;
  ask_for_place(what, position, orientation, *question.mutable_request()->mutable_is_free());
  return overlapped_in(state_->core.ask(question));
}

void Director::move(std::string_view entity, const std::array<double, 3>& position,
                    const std::optional<std::array<double, 4>>& orientation, Onto onto) {
  v1::MoveRequest move;
  move.set_entity(v1::valid_utf8(entity));
  add_numbers(position, "the position of", entity, *move.mutable_position());
  if (orientation)
    add_numbers(*orientation, "the orientation of", entity, *move.mutable_orientation());
  move.set_may_overlap(onto == Onto::others);
  state_->part.add_act(entity.size()).mutable_move()->Swap(&move);
}

void Director::set_joint(std::string_view entity, std::string_view joint, double position,
                         double velocity) {
  if (!std::isfinite(position) || !std::isfinite(velocity)) {
    throw std::invalid_argument("joint '" + std::string(joint) + "' of '" + std::string(entity) +
                                "' must have a position and a velocity that are finite");
  }
  v1::SetJointRequest& set =
      *state_->part.add_act(entity.size() + joint.size()).mutable_set_joint();
  set.set_entity(v1::valid_utf8(entity));
  set.set_joint(v1::valid_utf8(joint));
  set.set_position(position);
  set.set_velocity(velocity);
}

void Director::spawn(std::string_view xml) {
  state_->part.add_act(xml.size()).mutable_spawn()->set_xml(v1::valid_utf8(xml));
}

void Director::remove(std::string_view entity) {
  state_->part.add_act(entity.size()).mutable_remove()->set_entity(v1::valid_utf8(entity));
}

void Director::push(std::string_view entity, const std::array<double, 3>& force,
                    const std::array<double, 3>& torque, std::string_view link) {
  v1::Push push;
  push.set_entity(v1::valid_utf8(entity));
  push.set_link(v1::valid_utf8(link));
  add_numbers(force, "the force on", entity, *push.mutable_force());
  add_numbers(torque, "the torque on", entity, *push.mutable_torque());
  state_->part.add_act(entity.size() + link.size()).mutable_push()->Swap(&push);
}

void Director::paint_floor(const std::array<double, 2>& center, const std::array<double, 2>& size,
                           Color color) {
  add_paint(state_->part, center, size, color);
}

void Director::paint_floor(const std::array<double, 2>& center, double radius, Color color) {
  add_paint(state_->part, center, std::array{radius}, color);
}

void Director::lay_floor_image(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(longest_image + 1, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad() || !stream.is_open() || stream.gcount() == 0)
    throw std::runtime_error("the image '" + file.string() + "' can't be read");
  lay_floor_image_bytes({bytes.data(), static_cast<std::size_t>(stream.gcount())});
}

void Director::lay_floor_image_bytes(std::string_view bytes) {
  if (bytes.empty()) throw std::invalid_argument("an image of the floor has no bytes");
  if (bytes.size() > longest_image)
    throw std::length_error("an image of the floor has at most 2 MiB; save it with fewer pixels");
  state_->part.add_act(bytes.size()).mutable_paint_floor()->set_image(std::string(bytes));
}

void Director::set_leds(std::string_view entity, std::span<const Color> colors) {
  v1::Show& show = *state_->part.add_act(entity.size() + 4 * colors.size()).mutable_show();
  show.set_entity(v1::valid_utf8(entity));
  for (const Color color : colors) show.add_led_colors(packed(color));
}

void Director::set_directional_leds(std::string_view entity, std::span<const Color> colors) {
  v1::Show& show = *state_->part.add_act(entity.size() + 4 * colors.size()).mutable_show();
  show.set_entity(v1::valid_utf8(entity));
  for (const Color color : colors) show.add_directional_led_colors(packed(color));
}

void Director::set_tags(std::string_view entity, std::span<const std::string> payloads) {
  std::size_t bytes = entity.size();
  for (const std::string& payload : payloads) bytes += payload.size();
  v1::Show& show = *state_->part.add_act(bytes).mutable_show();
  show.set_entity(v1::valid_utf8(entity));
  for (const std::string& payload : payloads) show.add_tag_payloads(payload);
}

void Director::metric(std::string_view name, double value) { state_->part.set_metric(name, value); }
void Director::log(std::string_view text) {
  state_->part.add_line(Directing::Severity::info, text);
}
void Director::log_error(std::string_view text) {
  state_->part.add_line(Directing::Severity::error, text);
}
void Director::finish(std::string_view result) { state_->part.finish(result); }

}  // namespace ziggurat
