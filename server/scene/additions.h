#pragma once
// What is added to a scene after it was read: one element at a time, as it may stand in <arena>.

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/problem.h"
#include "scene/scene.h"

namespace ziggurat::scene {

struct Reading;

/// An entity that was read by itself.
struct Addition {
  Entity entity;  ///< complete only if no problem is a fault; what it says itself is
                  ///< in the file number Scene::files.size()
  std::vector<Problem> problems;  ///< in the order of the text
  std::size_t size = 0;           ///< as written, its model written out [bytes]
  bool ok() const;                ///< no fault
};

/// What a scene knows for later elements beyond the plain data of Scene: its models, what its
/// engine says for all bodies, what its controllers need.
class Additions {
 public:
  /// Of no scene. All that can be done with it is to assign another.
  Additions();
  /// Takes what a reading has found out.
  explicit Additions(Reading& reading);
  ~Additions();
  Additions(Additions&&) noexcept;
  Additions& operator=(Additions&&) noexcept;

  /// Reads one <box>, <cylinder>, <sphere>, <prototype>, <foot-bot> or <e-puck>. Problems are those
  /// of a scene's, in a file called `spawn`.
  /// @param scene     the one that this came with
  /// @param room      for the text with its model written out [bytes]
  /// @param is_taken  whether an id is that of another entity
  Addition read(std::string text, const Scene& scene, std::size_t room,
                const std::function<bool(const std::string&)>& is_taken) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A scene, and what it knows for those who add to it.
struct OpenScene {
  Scene scene;
  Additions additions;
};

/// The name of the file that a location in a scene, or in what was added to it, counts.
std::string file_of(const Scene& scene, const Location& where);

}  // namespace ziggurat::scene
