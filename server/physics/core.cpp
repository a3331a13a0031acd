#include "physics/core.h"

#include "math/archive.h"

#include "physics/bullet/core.h"
#include "physics/newton/core.h"

namespace ziggurat::physics {
namespace {

/// Calls a function with the core that the scene chose.
template <class Cores, class Function>
decltype(auto) with(Cores& core, Function function) {
  return std::visit([&](auto& chosen) -> decltype(auto) { return function(*chosen); }, core);
}

}  // namespace

Core::Core(const scene::Physics& physics) {
  if (physics.solver == scene::Solver::newton) {
    core_ = std::make_unique<NewtonCore>(physics);
  } else {
    core_ = std::make_unique<SweepsCore>(physics);
  }
}

Core::~Core() = default;

void Core::add_floor(const scene::Surface& surface) {
  with(core_, [&](auto& core) { core.add_floor(surface); });
}

Body Core::add(const scene::Entity& entity, std::size_t number) {
  return with(core_, [&](auto& core) { return core.add(entity, number); });
}

void Core::remove(Body& body) {
  with(core_, [&](auto& core) { core.remove(body); });
}

/// Newton's core ends with its bodies in it: they are places in its lists.
void Core::take_apart(std::span<Body> bodies) {
  const auto* sweeps = std::get_if<std::unique_ptr<SweepsCore>>(&core_);
  if (!sweeps) return;
  for (Body& body : bodies) {
    if (body.present()) (*sweeps)->remove(body);
  }
}

void Core::take_back(Body& body) {
  with(core_, [&](auto& core) { core.take_back(body); });
}

void Core::move(Body& body) {
  with(core_, [&](auto& core) { core.move(body); });
}

std::optional<std::size_t> Core::overlapped_by(std::span<const PlacedCollider> colliders,
                                               std::size_t except) const {
  return with(core_, [&](const auto& core) { return core.overlapped_by(colliders, except); });
}

JointIndex Core::joint(std::size_t entity, std::size_t joint) const {
  return with(core_, [&](const auto& core) { return core.joint(entity, joint); });
}

void Core::add_motor(JointIndex joint, scene::JointMode mode, double max_impulse) {
  with(core_, [&](auto& core) { core.add_motor(joint, mode, max_impulse); });
}

void Core::set_target(JointIndex joint, double target) {
  with(core_, [&](auto& core) { core.set_target(joint, target); });
}

void Core::set_joint(JointIndex joint, double position, double velocity) {
  physics::set_joint(*std::get<std::unique_ptr<NewtonCore>>(core_), joint, position, velocity);
}

double Core::position(JointIndex joint) const {
  return with(core_, [&](const auto& core) { return core.position(joint); });
}

double Core::velocity(JointIndex joint) const {
  return with(core_, [&](const auto& core) { return core.velocity(joint); });
}

void Core::substep(std::span<Body> bodies, double length, int splits, Plugin* stiff) {
  if (auto* newton = std::get_if<std::unique_ptr<NewtonCore>>(&core_)) {
    (*newton)->substep(bodies, length, splits, stiff);
  } else {
    std::get<std::unique_ptr<SweepsCore>>(core_)->substep(bodies, length, splits);
  }
}

void Core::contacts(std::vector<LinkContact>& out) const {
  with(core_, [&](const auto& core) { core.contacts(out); });
}

Convergence Core::convergence() const {
  return with(core_, [](const auto& core) { return core.convergence(); });
}

void Core::archive(math::Archive& archive) {
  archive("newton", *std::get<std::unique_ptr<NewtonCore>>(core_));
}

}  // namespace ziggurat::physics
