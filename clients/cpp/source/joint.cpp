#include "ziggurat/joint.h"

#include <cmath>
#include <stdexcept>

namespace ziggurat {

void Joint::set_target(double target) {
  if (target_ == nullptr) {
    throw std::logic_error("joint '" + id_ + "' has no motor: the controller's <actuators> do " +
                           "not list it");
  }
  if (!std::isfinite(target)) {
    throw std::invalid_argument("the target of joint '" + id_ + "' is " + std::to_string(target) +
                                "; it must be finite");
  }
  *target_ = target;
  *changed_ = true;
}

}  // namespace ziggurat
