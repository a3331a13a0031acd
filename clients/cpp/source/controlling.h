// SPDX-License-Identifier: MIT
#pragma once
// The part of a controller: robots, their readings and commands.

#include <optional>
#include <vector>

#include "fleet.h"
#include "part.h"
#include "ziggurat/session.h"

namespace ziggurat {

class Controlling final : public Part {
 public:
  /// @param options  outlive this
  explicit Controlling(const Options& options) : options_(options) {}

  void ask(v1::Hello& hello) const override;
  void begin(const v1::Welcome& welcome) override;
  void go_on(const v1::Welcome& welcome, std::vector<v1::Leave>& failures) override;
  std::optional<Moment> moment(Connection::Kind kind, const Connection& from) const override;
  void read(const Connection& from) override { fleet_->read(from.observation()); }
  void hear(Connection::Kind kind, const v1::ServerMessage& message) override;
  std::vector<v1::Leave> take_failures() override { return fleet_->take_failures(); }
  void write(v1::ClientMessage& answer, const Moment& moment) override;
  void sent() override { fleet_->sent(); }
  void repeat() override { fleet_->repeat(); }
  void write(v1::Leave& leave) override;
  void reset() override { fleet_->reset(); }
  void restore(const v1::Command& commanded) override { fleet_->resume(commanded); }
  void warn(const v1::Error& error) override;
  void remove(const google::protobuf::RepeatedField<std::uint32_t>& robots) override {
    fleet_->remove(robots);
  }

  std::span<Robot> robots() { return fleet_->robots(); }
  std::vector<SpawnedRobot> take_spawned() { return std::exchange(spawned_, {}); }

 private:
  const Options& options_;
  std::optional<Fleet> fleet_;  // from Welcome on
  std::vector<SpawnedRobot> spawned_;
};

}  // namespace ziggurat
