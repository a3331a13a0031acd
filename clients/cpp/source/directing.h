// SPDX-License-Identifier: MIT
#pragma once
// The part of a director: the world, and what is done to it.

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "part.h"
#include "world.h"
#include "ziggurat/director.h"

namespace ziggurat {

class Directing final : public Part {
 public:
  /// @param options  outlive this
  explicit Directing(const DirectorOptions& options) : options_(options) {}

  void ask(v1::Hello& hello) const override;
  void begin(const v1::Welcome& welcome) override;
  void go_on(const v1::Welcome& welcome, std::vector<v1::Leave>& failures) override;
  std::optional<Moment> moment(Connection::Kind kind, const Connection& from) const override;
  void read(const Connection& from) override;
  void hear(Connection::Kind kind, const v1::ServerMessage& message) override;
  void write(v1::ClientMessage& answer, const Moment& moment) override;
  void write(v1::Leave& leave) override;
  void warn(const v1::Error& error) override;
  void reset() override;

  /// A fresh act. @throws std::length_error if there are too many
  /// @param bytes  of its texts
  v1::DirectorAct& add_act(std::size_t bytes);
  enum class Severity { info, error };
  void add_line(Severity severity, std::string_view text);
  void set_metric(std::string_view name, double value);
  void finish(std::string_view result);
  bool wants_finish() const { return draft_.has_finish(); }

  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }
  const World& world() const { return world_; }
  const std::string& id() const { return id_; }
  const std::vector<std::pair<std::string, std::string>>& params() const { return params_; }
  const std::string& script() const { return script_; }

 private:
  void move_metrics_to(google::protobuf::RepeatedPtrField<v1::Metric>& to);

  const DirectorOptions& options_;
  std::string id_, script_;
  std::vector<std::pair<std::string, std::string>> params_;
  World world_;
  std::vector<std::string> warnings_;
  std::string layout_fault_;  // told with the next state

  v1::Direction draft_;  // acts, log and finish since the last answer
  std::size_t act_bytes_ = 0, log_bytes_ = 0;
  std::map<std::string, double, std::less<>> metrics_;  // likewise
  std::set<std::string, std::less<>> metric_names_;     // ever
};

}  // namespace ziggurat
