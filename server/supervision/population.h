// SPDX-License-Identifier: MIT
#pragma once
// Entities that are added to the world and removed from it while it runs (docs/protocol.md, V9 and
// V13).

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "network/server.h"
#include "processes/controllers.h"
#include "processes/spawned_scripts.h"
#include "reports/console.h"
#include "scene/additions.h"
#include "scene/files.h"
#include "supervision/callers.h"
#include "supervision/world.h"
#include "supervision/world_change.h"

namespace ziggurat::supervision {

/// The fault of an act on an entity that is not there.
/// @param field  of the request
/// @param world  an entity of it is suggested; null: none
wire::Fault no_entity(std::string field, const std::string& id,
                      const simulation::Simulation* world = nullptr);

/// The entity of that id that is in the world, into Layout::entities.
std::optional<std::size_t> entity_named(const simulation::Simulation& world, const std::string& id);

/// Spawns that precede another one in the same tick.
struct EarlierSpawns {
  std::size_t count = 0;  ///< entities
  std::size_t size = 0;   ///< of their elements, models written out [bytes]
};

class Population {
 public:
  struct Settings {
    std::size_t max_size = 0;       ///< of all spawned elements, models written out [bytes]
    bool with_controllers = true;   ///< otherwise spawned robots have no controller either
    bool leaves_libraries = false;  ///< robots whose controller is a library have none
    std::vector<std::string> script_folders;  ///< whose files spawned robots may use, too
  };

  /// All must outlive this. Notices on spawned entities go to the console.
  Population(const Settings& settings, World& world, network::Server& server, Callers& callers,
             processes::Controllers& controllers, reports::Console& console);

  /// An element that may be added, if its place is free.
  struct Candidate {
    scene::Addition addition;
    processes::SpawnedScript script;
    Spawned spawned;
  };
  /// Reads an element. @param is_taken  whether an id is that of an entity that will be there then
  std::variant<Candidate, wire::Fault> read(const std::string& xml,
                                            const std::function<bool(const std::string&)>& is_taken,
                                            const EarlierSpawns& earlier = {}) const;

  /// The first entity that the one, or the element, of a request would overlap at its pose: its id,
  /// empty if the place is free; or what is wrong with the request.
  std::variant<std::string, wire::Fault> overlapped(const wire::Request& request) const;

  // Each returns why it can't be done; then nothing has changed.
  std::optional<wire::Fault> spawn(const std::string& xml);
  std::optional<wire::Fault> remove(const std::string& id);

  /// The world has begun anew or gone back. @param robots  the first ones, which are the same as
  /// before
  void restart(std::size_t robots);

  /// Files that spawned elements may name.
  const processes::AllowedFiles& allowed() const { return allowed_; }

 private:
  std::size_t size_of(const std::string& xml) const;
  void add_controllers(std::size_t first, std::span<const std::string> scripts);

  const Settings settings_;
  const processes::AllowedFiles allowed_;
  World& world_;
  network::Server& server_;
  Callers& callers_;
  processes::Controllers& controllers_;
  reports::Console& console_;
  std::size_t spawned_ = 0;  ///< entities, since the start or the last reset
  std::size_t size_left_;    ///< for more entities [bytes]
  std::unordered_map<std::string, std::size_t> sizes_;  ///< of the elements spawned [bytes]
};

/// Opens files below the allowed folders: as an element of the scene file would name them,
/// otherwise relative to one of these folders.
/// @param allowed  must outlive what is returned
/// @param spawned  gets the files, and must outlive it, too; may be null
scene::OpenFile opener(const processes::AllowedFiles& allowed, const std::string& scene_file,
                       Spawned* spawned = nullptr);

}  // namespace ziggurat::supervision
