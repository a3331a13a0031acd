// SPDX-License-Identifier: MIT
#pragma once
// A robot of a session.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ziggurat/actuators.h"
#include "ziggurat/camera.h"
#include "ziggurat/device.h"
#include "ziggurat/joint.h"
#include "ziggurat/radio.h"
#include "ziggurat/range_and_bearing.h"
#include "ziggurat/sensors.h"
#include "ziggurat/turret.h"
#include "ziggurat/wheels.h"

namespace ziggurat {

class Markers;

/// A handle into its session, valid while the session lives. Look up devices by id once, before
/// the loop, and keep the references.
class Robot : public Sensors {
 public:
  const std::string& id() const noexcept { return id_; }
  /// Id of its controller in the scene.
  const std::string& controller() const noexcept { return controller_; }
  /// All attributes of the controller's <params>, in document order.
  const std::vector<std::pair<std::string, std::string>>& params() const noexcept {
    return params_;
  }
  /// Resolved path of the Lua script; empty for other controllers.
  const std::string& script() const noexcept { return script_; }

  /// All joints with an encoder or a motor: first those with an encoder in the order of the
  /// scene's <sensors>, then the others in the order of <actuators>.
  std::span<Joint> joints() noexcept { return joints_; }
  /// @throws std::out_of_range, listing the ids that exist
  Joint& joint(std::string_view id);

  // The other devices that the controller has a sensor or an actuator for, in scene order. An
  // unknown id is std::out_of_range, listing the ids that exist.
  std::span<Radio> radios() noexcept { return radios_; }
  Radio& radio(std::string_view id);
  std::span<Led> leds() noexcept { return leds_; }
  Led& led(std::string_view id);
  std::span<Led> directional_leds() noexcept { return directional_leds_; }
  Led& directional_led(std::string_view id);
  std::span<Tag> tags() noexcept { return tags_; }
  Tag& tag(std::string_view id);
  std::span<Magnet> magnets() noexcept { return magnets_; }
  Magnet& magnet(std::string_view id);
  std::span<const Camera> cameras() const noexcept { return cameras_; }
  const Camera& camera(std::string_view id) const;
  // These are null if the robot has no such device.
  RangeAndBearing* range_and_bearing() noexcept {
    return range_and_bearing_ ? &*range_and_bearing_ : nullptr;
  }
  Wheels* wheels() noexcept { return wheels_ ? &*wheels_ : nullptr; }
  Turret* turret() noexcept { return turret_ ? &*turret_ : nullptr; }
  /// Devices that describe themselves (protocol 1.5), kind by kind, for each in scene order.
  std::span<Device> devices() noexcept { return devices_; }
  /// Devices of a kind, by the name of its element in the scene; empty if it has none.
  std::span<Device> devices(std::string_view kind) noexcept;
  Device& device(std::string_view kind, std::string_view id);

  /// Its controller has the actuator `debug`: it may draw markers for people, which pages and
  /// recordings show for one tick.
  bool draws() const noexcept { return markers_ != nullptr; }
  static constexpr std::size_t max_markers = 1000;           ///< of a robot at one tick
  static constexpr std::size_t max_marker_text_bytes = 100;  ///< at least 1
  // Places are x, y, z in the frame of the robot's origin, each within ±1e6 [m]. Markers are sent
  // with the answer to this tick.
  // @throws std::logic_error if it does not draw; std::length_error beyond max_markers;
  // std::invalid_argument if a place, a radius or a text is not as it must be
  void draw_arrow(const std::array<double, 3>& from, const std::array<double, 3>& to, Color color);
  /// @param radius  above 0 [m]; the ring lies in the xy plane
  void draw_ring(const std::array<double, 3>& center, double radius, Color color);
  void draw_text(const std::array<double, 3>& at, std::string_view text, Color color);

  /// Adds a line to the server's log, without a line feed at its end; sent with the answer to this
  /// tick. `log` goes to the server's standard output, `log_error` to its standard error.
  /// @throws std::length_error if the session logs more at one tick than a message can hold
  void log(std::string_view text);
  void log_error(std::string_view text);

  /// Sets a figure of the run, which the server keeps for each tick, with the last value as the
  /// final one: in `--summary` under `ROBOT/name`, in readings, recordings and `--metrics`. Sent
  /// with the answer to this tick; of two values for one tick the last counts. Servers before
  /// protocol version 1.3 ignore it.
  /// @param name  1 to 64 letters, digits, `_`, `-`, `.`; at most 100 names a robot
  /// @throws std::invalid_argument if the name has something else or the value is not finite
  /// @throws std::length_error if the robot would have more names
  void metric(std::string_view name, double value);

  /// Reports that the controller of this robot failed: with the answer to this tick the robot
  /// leaves the run forever and its commands become zero. The session's other robots continue.
  void fail(std::string_view message);
  bool failed() const noexcept { return failed_; }
  /// The robot has left the run, or this session: answers were missing (Deadline), it was removed
  /// from the world, or another client has taken it over. Its values have no effect any more. A
  /// server of protocol version 1.0 does not tell the first.
  bool gone() const noexcept { return is_gone_; }

 private:
  friend class Fleet;
  friend struct Layout;
  enum class Severity { info, error };
  struct Line {
    std::uint32_t robot;  // position in the session
    Severity severity;
    std::string text;
  };
  struct Log {  // of a session, not yet sent
    std::vector<Line> lines;
    std::size_t bytes = 0;
    std::size_t max_bytes = 0;
    std::map<std::pair<std::uint32_t, std::string>, double>
        metrics;  // by position in the session and name
  };
  void add_line(Severity severity, std::string_view text);
  Markers& markers();

  std::string id_;
  std::string controller_;
  std::vector<std::pair<std::string, std::string>> params_;
  std::string script_;
  std::vector<Joint> joints_;
  std::vector<Radio> radios_;
  std::vector<Led> leds_;
  std::vector<Led> directional_leds_;
  std::vector<Tag> tags_;
  std::vector<Magnet> magnets_;
  std::vector<Camera> cameras_;
  std::optional<RangeAndBearing> range_and_bearing_;
  std::optional<Wheels> wheels_;
  std::optional<Turret> turret_;
  std::vector<DeviceKind> device_kinds_;
  std::vector<Device> devices_;
  Markers* markers_ = nullptr;  // the session's
  std::uint32_t position_ = 0;  // in the session
  bool failed_ = false;
  bool is_gone_ = false;
  std::string failure_;                              // not yet sent; empty if none
  Log* log_ = nullptr;                               // the session's
  std::set<std::string, std::less<>> metric_names_;  // used so far
};

}  // namespace ziggurat
