// SPDX-License-Identifier: MIT
#include "wire/response.h"

#include <google/protobuf/util/json_util.h>

#include "ziggurat/v1/envelope.h"

namespace ziggurat::wire {
namespace {

void fill(const Latency& from, v1::Latency& to) {
  to.set_p50(from.p50);
  to.set_p99(from.p99);
  to.set_max(from.max);
}

void fill(const SessionStatus& from, v1::SessionStatus& to) {
  to.set_client(v1::valid_utf8(from.client));
  to.set_role(static_cast<v1::Role>(from.role));
  to.set_state(static_cast<v1::SessionStatus::State>(from.state));
  for (const std::string& robot : from.robots) to.add_robots(v1::valid_utf8(robot));
  to.set_tick(from.tick);
  to.set_wall_waiting_s(from.wall_waiting_s);
  to.set_wall_last_message_s(from.wall_last_message_s);
  fill(from.latency, *to.mutable_wall_latency());
  to.set_misses(from.misses);
  v1::DeadlinePolicy& deadline = *to.mutable_deadline_policy();
  deadline.set_action(static_cast<v1::DeadlinePolicy::Action>(from.deadline.action));
  deadline.set_wall_deadline_ms(from.deadline.wall_deadline_ms);
  deadline.set_miss_budget(from.deadline.miss_budget);
  to.set_director(v1::valid_utf8(from.director));
}

void add(const math::Vector3& from, google::protobuf::RepeatedField<double>& to) {
  for (const double value : from) to.Add(value);
}

void add(const math::Quaternion& from, google::protobuf::RepeatedField<double>& to) {
  for (const double value : {from.w(), from.x(), from.y(), from.z()}) to.Add(value);
}

}  // namespace

Request read(const v1::MoveRequest& from) {
  Request request;
  request.kind = Request::Kind::move;
  request.text = from.entity();
  request.position.assign(from.position().begin(), from.position().end());
  request.orientation.assign(from.orientation().begin(), from.orientation().end());
  request.may_overlap = from.may_overlap();
  return request;
}

Request read(const v1::SetJointRequest& from) {
  Request request;
  request.kind = Request::Kind::set_joint;
  request.text = from.entity();
  request.joint = from.joint();
  request.joint_position = from.position();
  request.joint_velocity = from.velocity();
  return request;
}

Request read(const v1::Request& from) {
  Request request = from.has_move()        ? read(from.move())
                    : from.has_set_joint() ? read(from.set_joint())
                                           : Request();
  request.id = from.id();
  // The numbers of the fields from 2 on are those of Kind from 1 on.
  request.kind = from.request_case() == v1::Request::REQUEST_NOT_SET
                     ? Request::Kind::none
                     : static_cast<Request::Kind>(from.request_case() - 1);
  request.ticks = from.step().ticks();
  if (from.reset().has_seed()) request.seed = from.reset().seed();
  if (from.has_spawn()) request.text = from.spawn().xml();
  if (from.has_shutdown()) request.text = from.shutdown().reason();
  if (from.has_remove()) request.text = from.remove().entity();
  if (from.has_snapshot()) request.text = from.snapshot().name();
  if (from.has_restore()) request.text = from.restore().name();
  request.entities.assign(from.read().entities().begin(), from.read().entities().end());
  request.held_up.assign(from.held_up().begin(), from.held_up().end());
  if (from.has_is_free()) {
    const v1::IsFreeRequest& place = from.is_free();
    request.is_element = place.has_xml();
    request.text = place.has_xml() ? place.xml() : place.entity();
    request.position.assign(place.position().begin(), place.position().end());
    request.orientation.assign(place.orientation().begin(), place.orientation().end());
  }
  return request;
}

void fill(const Status& from, v1::Status& to) {
  to.set_tick(from.tick);
  to.set_time_ns(from.time_ns);
  to.set_phase(static_cast<v1::Status::Phase>(from.phase));
  to.set_mode(from.is_hardware_in_the_loop ? v1::MODE_HARDWARE_IN_THE_LOOP : v1::MODE_LOCK_STEP);
  to.set_seed(from.seed);
  to.set_scene(v1::valid_utf8(from.scene));
  to.set_scene_hash(from.scene_hash);
  to.set_last_tick(from.last_tick);
  for (const SessionStatus& session : from.sessions) fill(session, *to.add_sessions());
  for (const std::string& robot : from.free_robots) to.add_free_robots(v1::valid_utf8(robot));
  for (const std::string& robot : from.gone_robots) to.add_gone_robots(v1::valid_utf8(robot));
  for (const std::string& director : from.free_directors)
    to.add_free_directors(v1::valid_utf8(director));
  for (const Status::PhaseBudget& phase : from.budget) {
    v1::PhaseBudget& budget = *to.add_budget();
    budget.set_phase(phase.phase);
    fill(phase.wall, *budget.mutable_wall());
  }
  to.set_wall_uptime_s(from.wall_uptime_s);
  if (from.solver.islands > 0) {
    v1::SolverStatus& solver = *to.mutable_solver();
    solver.set_islands(from.solver.islands);
    solver.set_not_converged(from.solver.not_converged);
    solver.set_worst_residual(from.solver.worst_residual);
  }
}

void fill(const world::Layout& layout, const world::State& state,
          std::span<const std::size_t> entities, v1::States& to) {
  for (const std::size_t index : entities) {
    const world::EntityLayout& entity = layout.entities[index];
    v1::States::Entity& written = *to.add_entities();
    written.set_id(v1::valid_utf8(entity.id));
    add(state.origins[index].position, *written.mutable_position());
    add(state.origins[index].orientation, *written.mutable_orientation());
    for (std::size_t i = entity.links.begin; i < entity.links.end(); ++i) {
      v1::States::Link& link = *written.add_links();
      link.set_id(v1::valid_utf8(layout.links[i].id));
      add(state.links[i].pose.position, *link.mutable_position());
      add(state.links[i].pose.orientation, *link.mutable_orientation());
      add(state.links[i].velocity, *link.mutable_velocity());
      add(state.links[i].angular_velocity, *link.mutable_angular_velocity());
    }
    for (std::size_t i = entity.leds.begin; i < entity.leds.end(); ++i) {
      written.add_led_colors(state.led_colors[i]);
    }
  }
}

std::string to_json(const Status& status) {
  v1::Status message;
  fill(status, message);
  std::string text;
  google::protobuf::util::MessageToJsonString(message, &text);
  return text;
}

}  // namespace ziggurat::wire
