// SPDX-License-Identifier: MIT
#include "directing.h"

#include <stdexcept>

#include "convert.h"
#include "text/printable.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {
namespace {

// As the server allows, in one answer.
constexpr int most_acts = 10'000;
constexpr std::size_t most_act_bytes =
    std::size_t{2} << 20;  // of texts; the rest of 4 MiB is for numbers and the log
constexpr int most_lines = 1000;
constexpr std::size_t most_log_bytes = std::size_t{1} << 20;
constexpr std::size_t longest_result = 1024;
constexpr std::size_t most_metrics = 100;

}  // namespace

void Directing::ask(v1::Hello& hello) const {
  hello.set_role(v1::ROLE_DIRECTOR);
  hello.set_director(v1::valid_utf8(options_.director));
  hello.set_takeover(options_.takeover);
  if (options_.name.empty()) hello.set_client_name("director");
  v1::Subscription& subscription = *hello.mutable_subscription();
  for (const std::string& each : options_.entities) subscription.add_entities(v1::valid_utf8(each));
  for (const auto group : options_.groups) {
    subscription.add_groups(static_cast<v1::Subscription::Group>(group));
  }
}

void Directing::begin(const v1::Welcome& welcome) {
  id_ = welcome.director().id();
  script_ = welcome.director().script();
  for (const v1::Parameter& param : welcome.director().params()) {
    params_.emplace_back(param.name(), param.value());
  }
}

void Directing::go_on(const v1::Welcome& welcome, std::vector<v1::Leave>&) {
  if (welcome.director().id() == id_) return;
  throw ProtocolError("the resumed session has another director than before", {});
}

std::optional<Moment> Directing::moment(Connection::Kind kind, const Connection& from) const {
  if (kind != Connection::Kind::kWorldState) return std::nullopt;
  const v1::WorldState& state = from.world_state();
  Moment moment{state.tick(), state.time_ns(), {}};
  if (state.has_epoch()) moment.epoch = state.epoch();
  return moment;
}

void Directing::read(const Connection& from) {
  if (!layout_fault_.empty()) throw std::runtime_error(layout_fault_);
  world_.read(from.world_state());
}

void Directing::hear(Connection::Kind kind, const v1::ServerMessage& message) {
  if (kind != Connection::Kind::kWorldLayout) return;
  try {
    world_.read(message.world_layout());
  } catch (const std::runtime_error& error) {
    layout_fault_ = error.what();
  }
}

void Directing::write(v1::ClientMessage& answer, const Moment& moment) {
  v1::Direction& direction = *answer.mutable_direction();
  direction.Clear();
  direction.Swap(&draft_);
  direction.set_tick(moment.tick);
  if (moment.epoch) direction.set_epoch(*moment.epoch);
  move_metrics_to(*direction.mutable_metrics());
  act_bytes_ = log_bytes_ = 0;
}

void Directing::write(v1::Leave& leave) {
  leave.mutable_log()->Swap(draft_.mutable_log());
  move_metrics_to(*leave.mutable_metrics());
}

void Directing::move_metrics_to(google::protobuf::RepeatedPtrField<v1::Metric>& to) {
  for (const auto& [name, value] : metrics_) {
    v1::Metric& metric = *to.Add();
    metric.set_name(name);
    metric.set_value(value);
  }
  metrics_.clear();
}

void Directing::warn(const v1::Error& error) {
  constexpr std::size_t most = 1000;  // a client that does not ask for them keeps no more
  if (warnings_.size() == most) return;
  const std::string where = error.field().empty() ? "" : error.field() + ": ";
  warnings_.push_back(text::printable_part(where + error.message()));
}

/// Drops acts that were not sent yet: they were for the world before.
void Directing::reset() {
  draft_.clear_acts();
  draft_.clear_finish();
  act_bytes_ = 0;
}

v1::DirectorAct& Directing::add_act(std::size_t bytes) {
  if (draft_.acts_size() == most_acts || act_bytes_ + bytes > most_act_bytes) {
    throw std::length_error("a director does at most " + std::to_string(most_acts) +
                            " things at one tick, with texts of 2 MiB together");
  }
  act_bytes_ += bytes;
  return *draft_.add_acts();
}

void Directing::add_line(Severity severity, std::string_view text) {
  if (draft_.log_size() == most_lines || log_bytes_ + text.size() > most_log_bytes) {
    throw std::length_error("a director logs at most " + std::to_string(most_lines) +
                            " lines of 1 MiB together at one tick");
  }
  log_bytes_ += text.size();
  v1::LogLine& line = *draft_.add_log();
  line.set_error(severity == Severity::error);
  line.set_text(v1::valid_utf8(text));
}

void Directing::set_metric(std::string_view name, double value) {
  check_metric(name, value);
  if (!metric_names_.contains(name)) {
    if (metric_names_.size() == most_metrics) {
      throw std::length_error("the director has " + std::to_string(most_metrics) +
                              " metrics already; '" + std::string(name) + "' would be one more");
    }
    metric_names_.emplace(name);
  }
  metrics_.insert_or_assign(std::string(name), value);
}

void Directing::finish(std::string_view result) {
  if (result.size() > longest_result) {
    throw std::length_error("the result of a run has at most 1024 bytes");
  }
  draft_.mutable_finish()->set_result(v1::valid_utf8(result));
}

}  // namespace ziggurat
