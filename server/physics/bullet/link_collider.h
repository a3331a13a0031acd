#pragma once
// The colliders of multi-bodies. Bullet knows one for each of its bodies, at the centre of mass.
// Where links are welded together there are several, each at the centre of its link's shape.

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

namespace ziggurat::physics {

class LinkCollider final : public btMultiBodyLinkCollider {
 public:
  /// @param index    of the part in the multi-body; -1 = its base
  /// @param in_part  X_PS of the shape's centre
  LinkCollider(btMultiBody* multi, int index, const btTransform& in_part)
      : btMultiBodyLinkCollider(multi, index),
        in_part_(in_part),
        centred_(in_part == btTransform::getIdentity()) {}

  /// Makes it follow the collider of its part that Bullet moves.
  void follow(const LinkCollider& leader) { leader_ = &leader; }
  const LinkCollider* leader() const { return leader_; }

  /// Whether its place is another than Bullet's.
  bool displaced() const { return leader_ != this || !centred_; }
  /// X_WP of the part. Leaders only.
  const btTransform& part() const { return centred_ ? getWorldTransform() : part_; }

  /// Takes the pose to which Bullet has moved a leader as that of its part.
  void note() { part_ = getWorldTransform(); }
  /// Goes where the shape is. The leader must have noted its part before.
  void settle() { setWorldTransform(leader_->part() * in_part_); }

 private:
  const LinkCollider* leader_ = this;
  btTransform in_part_;
  bool centred_;
  btTransform part_ = btTransform::getIdentity();  // X_WP, of a leader that is not centred
};

/// The collider behind one of Bullet's pointers.
inline LinkCollider* link_collider(btMultiBodyLinkCollider* collider) {
  return static_cast<LinkCollider*>(collider);
}

}  // namespace ziggurat::physics
