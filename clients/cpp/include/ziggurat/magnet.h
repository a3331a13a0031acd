#pragma once
// A magnet of a robot with an electromagnetic part.

#include <string>

namespace ziggurat {

/// A handle into its session, valid as long as that lives.
class Magnet {
 public:
  const std::string& id() const noexcept { return id_; }
  /// The magnet's field is passive + current × active field, as the scene gives them; any sign.
  /// Sent with the answer to this tick; stays until changed.
  /// @throws std::invalid_argument if not finite
  void set_current(double current);
  /// The last one set; 0 before the first.
  double current() const noexcept { return *current_; }

 private:
  friend struct Layout;
  std::string id_;
  double* current_ = nullptr;  // into the session's packed command
  bool* changed_ = nullptr;
};

}  // namespace ziggurat
