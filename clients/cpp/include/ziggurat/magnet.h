#pragma once
// A magnet of a robot with an electromagnetic part.

#include <string>

namespace ziggurat {

/// A handle into its session, valid while the session lives.
class Magnet {
 public:
  const std::string& id() const noexcept { return id_; }
  /// The magnet's field is passive + current × active field, both from the scene; any sign.
  /// Sent with the answer to this tick; stays until changed.
  /// @throws std::invalid_argument if not finite
  void set_current(double current);
  /// The last current set; before that, 0.
  double current() const noexcept { return *current_; }

 private:
  friend struct Layout;
  std::string id_;
  double* current_ = nullptr;  // into the session's packed command
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
