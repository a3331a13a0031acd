// SPDX-License-Identifier: MIT
#pragma once
// A director: it is told of the whole world at each tick, and may change it before the next.

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ziggurat/entity.h"
#include "ziggurat/session.h"

namespace ziggurat {

/// Options of a director: the parts of the world that it is sent.
struct DirectorOptions : SessionOptions {
  /// Properties of entities that a director can be sent; the numbers are the protocol's.
  enum class Group { poses = 1, links, joints, leds, tags, magnets, radio_messages, contacts };
  static constexpr std::array all_groups = {Group::poses,          Group::links,   Group::joints,
                                            Group::leds,           Group::tags,    Group::magnets,
                                            Group::radio_messages, Group::contacts};

  std::string director;   ///< its id in the scene, or with --allow-director any other; required
  bool takeover = false;  ///< also if another session is this director
  std::vector<std::string> entities;           ///< ids or globs, also of later ones; none: all
  std::vector<Group> groups = {Group::poses};  ///< fewer cost less

  /// As read_environment(); the director is ZIGGURAT_DIRECTOR.
  static DirectorOptions from_environment();
};

/// Directs a world in lock-step: the world waits for it, as for a controller. What it does takes
/// effect between this tick and the next, in the order of the calls. The server checks it whole: if
/// anything is wrong with it, as an entity that is not there, nothing of it is done and next()
/// throws ProtocolError. Leaves the run when destroyed: as failed if an exception is the cause,
/// otherwise as done. Not thread-safe.
class Director {
 public:
  /// Connects and waits for the server's welcome.
  /// @throws ConnectionError, ProtocolError, std::invalid_argument for an unusable endpoint
  explicit Director(const DirectorOptions& options);
  ~Director();
  Director(const Director&) = delete;
  Director& operator=(const Director&) = delete;

  /// Sends what was asked for since the last call, and waits for the next tick. False after the
  /// last one. The first call delivers Event::init, at tick 0 before any physics. If the connection
  /// is lost meanwhile, the session is resumed (SessionOptions::resume_timeout).
  /// @throws ConnectionError, ProtocolError
  bool next();

  Event event() const noexcept;
  std::uint64_t tick() const noexcept;             ///< whose state is told
  std::chrono::nanoseconds time() const noexcept;  ///< simulated
  /// Set when next() has returned false at the end of the run.
  const std::optional<Ending>& ending() const noexcept;
  std::uint64_t missed() const noexcept;   ///< ticks that did not wait for this director's answer
  std::uint64_t resumes() const noexcept;  ///< how often a lost connection was replaced

  /// Acts since the last call that failed, such as a spawn at a place that is taken; all other acts
  /// were done.
  std::vector<std::string> take_warnings();

  const std::string& id() const noexcept;  ///< in the scene
  /// All attributes of its <params>, in document order.
  const std::vector<std::pair<std::string, std::string>>& params() const noexcept;
  const std::string& script() const noexcept;  ///< resolved path of its Lua script; may be empty
  std::uint64_t seed() const noexcept;         ///< of the run; after a reset, the new one
  std::chrono::nanoseconds tick_length() const noexcept;  ///< simulated
  const std::string& token() const noexcept;  ///< for SessionOptions::session_token; any bytes

  // --- The world after the tick ---

  /// Entities that are in the world, in scene order; spawned ones behind.
  std::span<Entity* const> entities() const noexcept;
  /// Whether that list is not what it was at the tick before.
  bool entities_have_changed() const noexcept;
  /// Null if none of this id is in the world.
  const Entity* find(std::string_view id) const noexcept;
  /// @throws std::out_of_range
  const Entity& entity(std::string_view id) const;
  std::span<const Contact> contacts() const noexcept;
  std::span<const RadioMessage> radio_messages() const noexcept;

  // --- Acts before the next tick: at most 10 000, with texts of 2 MiB together, else
  // std::length_error.
  // --- Numbers that are not finite are std::invalid_argument.

  /// The entity is at rest at the pose, its joints in their initial positions; no orientation = the
  /// present one. Where others are then it is left out (take_warnings), unless it may overlap them:
  /// they are pushed apart.
  void move(std::string_view entity, const std::array<double, 3>& position,
            const std::optional<std::array<double, 4>>& orientation = std::nullopt,
            Onto onto = Onto::free_place);
  /// A revolute or prismatic joint is put to a position [m, rad] from the assembled pose, within
  /// its limits, and a velocity [m/s, rad/s]. What hangs on it follows; other joints and the root
  /// of the entity stay, and motors keep their targets.
  void set_joint(std::string_view entity, std::string_view joint, double position,
                 double velocity = 0);
  /// The overlap of an entity, or an element as in <arena>, now at a pose of its origin: the first
  /// other entity's id, or nothing where the place is free. Asks the server and waits for its
  /// answer; acts that were asked for since the last next() are not done yet. The floor does not
  /// count, nor does the entity itself.
  /// @param what  an id, or an element, which begins with '<': of a single body its extents are
  /// enough, as in
  ///              <box size="1,1,1"/>
  /// @throws ConnectionError, ProtocolError for what the server refuses; std::logic_error between
  /// two ticks
  std::optional<std::string> overlapped(
      std::string_view what, const std::array<double, 3>& position,
      const std::optional<std::array<double, 4>>& orientation = std::nullopt);
  /// Whether that is nothing.
  bool is_free(std::string_view what, const std::array<double, 3>& position,
               const std::optional<std::array<double, 4>>& orientation = std::nullopt) {
    return !overlapped(what, position, orientation);
  }
  /// @param xml  one element, as in <arena>
  void spawn(std::string_view xml);
  void remove(std::string_view entity);
  /// A force at the centre of mass of a link and a torque, in the world's axes, during the next
  /// tick only.
  /// @param force   [N]
  /// @param torque  [N m]
  /// @param link    its id; empty: the entity's first
  void push(std::string_view entity, const std::array<double, 3>& force,
            const std::array<double, 3>& torque = {}, std::string_view link = {});
  /// A rectangle of the floor along the world's axes, or a disc, gets a colour, which stays. Ground
  /// sensors read it from the next tick on.
  /// @param center  x, y [m];  @param size  along x and y [m], > 0;  @param radius  [m], > 0
  void paint_floor(const std::array<double, 2>& center, const std::array<double, 2>& size,
                   Color color);
  void paint_floor(const std::array<double, 2>& center, double radius, Color color);
  /// An image covers the floor of the arena, in place of the scene's image and of what was painted:
  /// its right is +x, its top +y.
  /// @param file  a PNG file, or a PPM or PGM file of bytes
  /// @throws std::runtime_error for a file that can't be read, std::length_error above 2 MiB
  void lay_floor_image(const std::filesystem::path& file);
  /// The same with the file's bytes.
  void lay_floor_image_bytes(std::string_view bytes);
  /// Colours of all LEDs of an entity, which stay until changed. A controller's actuators win.
  void set_leds(std::string_view entity, std::span<const Color> colors);
  void set_directional_leds(std::string_view entity, std::span<const Color> colors);
  void set_tags(std::string_view entity, std::span<const std::string> payloads);

  /// As Robot::metric, in `--summary` under `DIRECTOR/name`.
  void metric(std::string_view name, double value);
  /// As Robot::log. @throws std::length_error for more than 1000 lines or 1 MiB at one tick
  void log(std::string_view text);
  void log_error(std::string_view text);

  /// The run ends with this tick: what was asked for besides has no effect.
  /// @param result  why, at most 1 KiB
  void finish(std::string_view result = {});

  /// Leaves the run now; see Session::leave().
  void leave();
  void leave_failed(std::string_view message);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ziggurat
