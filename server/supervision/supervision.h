#pragma once
// What supervisors and observers ask for, done between ticks (docs/protocol.md, section 9).

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "network/latencies.h"
#include "network/server.h"
#include "processes/controllers.h"
#include "reports/console.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace ziggurat::supervision {

/// Parts of a tick's wall time.
enum class Phase { exchange, physics, recording, pacing };

class Supervision {
 public:
  using clock = std::chrono::steady_clock;

  struct Subject {
    const scene::Scene& scene;
    const scene::Additions& additions;  ///< to the scene
    std::size_t room = 0;               ///< of what is spawned, models written out [bytes]
    std::string path;                   ///< of the scene
    std::string scene_hash;        ///< 16 hexadecimal digits
    std::uint64_t seed = 0;
    std::optional<scene::Clock> clock;  ///< overrides the scene's
    std::uint64_t last_tick = 0;   ///< 0: until stopped
    bool is_hardware_in_the_loop = false;
    simulation::Simulation& simulation;
    network::Server& server;
    bool with_controllers = true;  ///< else nobody drives robots, those that are spawned neither
    std::vector<processes::ControllerProcess>& processes;
    std::optional<processes::Surroundings> surroundings;  ///< of Lua processes that the run starts
    reports::Console& console;                            ///< for notices on what is spawned
  };

  explicit Supervision(const Subject& subject);

  /// Answers what can be answered now; the rest waits for its tick. Due whenever the server wakes,
  /// and never while physics runs.
  void serve();

  void gathered() { is_gathered_ = true; }
  /// A tick was published.
  void published();
  /// Charges wall time to a phase of the tick that ends.
  void charge(Phase phase, double seconds);

  /// The seed of a reset that is asked for: the world is to be destroyed and built anew.
  std::optional<std::uint64_t> reset_wanted() const;
  /// It was done: tick 0 is about to be published.
  void reset_done();
  bool shutdown_wanted() const { return shutdown_; }
  std::uint64_t seed() const { return subject_.seed; }
  /// For how long the world has stood, in all: a paced schedule shifts by it.
  clock::duration paused_for() const;

  wire::Status status() const;

 private:
  enum class Reply { given, later };
  Reply try_to(const network::Call& call);
  Reply pause(const network::Call& call);
  Reply step(const network::Call& call);
  Reply reset(const network::Call& call);
  Reply read(const network::Call& call);
  Reply move(const network::Call& call);
  Reply spawn(const network::Call& call);
  Reply remove(const network::Call& call);
  void employ(const scene::Entity& entity);
  void forget_spawned();
  Reply fail(const network::Call& call, wire::ErrorCode code, std::string field,
             std::string message);
  Reply done(const network::Call& call);
  std::optional<std::size_t> entity_named(const std::string& id) const;
  void note_standing();

  Subject subject_;
  std::vector<network::Call> waiting_;  // unanswered, in order of arrival
  std::optional<network::Call> stepping_, resetting_;
  std::uint64_t steps_left_ = 0;
  std::size_t spawned_ = 0;   // entities, since the start or the last reset
  std::size_t room_;          // that is left for more [bytes]
  std::size_t launched_ = 0;  // Lua processes for them, ever
  bool is_gathered_ = false, shutdown_ = false;
  clock::time_point start_ = clock::now();
  std::optional<clock::time_point> standing_since_;
  clock::duration stood_{};
  std::array<network::Latencies, 4> budget_;  // by Phase
};

}  // namespace ziggurat::supervision
