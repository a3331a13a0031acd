// SPDX-License-Identifier: MIT
#pragma once
// Entities that are added to a scene after it was read: one element at a time, as in <arena>.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "scene/files.h"
#include "scene/problem.h"
#include "scene/scene.h"

namespace ziggurat::scene {

struct Draft;
class Element;

/// An entity that was read by itself.
struct Addition {
  Entity entity;  ///< complete only if no problem is a fault; what it says itself is
                  ///< in the file number Scene::files.size()
  std::vector<Problem> problems;  ///< in the order of the text
  std::size_t size = 0;           ///< as written, its model written out [bytes]
  bool ok() const;                ///< no fault
};

/// Context to read later elements, beyond the plain data of Scene: models, the engine's defaults
/// for all bodies, and needs of controllers.
class Additions {
 public:
  /// Makes an empty context, only to be assigned another.
  Additions();
  /// Takes from a scene that has been read what later elements need.
  explicit Additions(Draft& draft);
  ~Additions();
  Additions(Additions&&) noexcept;
  Additions& operator=(Additions&&) noexcept;

  /// Reads one <box>, <cylinder>, <sphere>, <prototype>, <foot-bot> or <e-puck>. Problems are those
  /// of a scene's, in a file called `spawn`.
  /// @param scene     the one that this came with
  /// @param max_size  of the text with its model written out [bytes]
  /// @param is_taken  whether an id is that of another entity
  /// @param open      opens the files that the element names
  Addition read(std::string text, const Scene& scene, std::size_t max_size,
                const std::function<bool(const std::string&)>& is_taken,
                const OpenFile& open = open_no_file) const;

  /// The same for what is looked at only: its id and <body> have no meaning and may be missing, and
  /// of a <box>, <cylinder> or <sphere> its extents are enough.
  Addition read_shape(std::string text, const Scene& scene, std::size_t max_size,
                      const OpenFile& open = open_no_file) const;

 private:
  struct Parts;
  /// @param read  reads the element that the document consists of
  Addition read_element(std::string text, const Scene& scene, std::size_t max_size,
                        const OpenFile& open,
                        const std::function<void(Draft&, Element&, Entity&)>& read) const;
  std::unique_ptr<Parts> parts_;
};

/// Reads elements of entities that were spawned in a world before, which a snapshot has: all of
/// them together at most 64 MiB, with their models written out. It throws SceneError for an element
/// with faults.
/// @param additions, scene  must outlive it
std::function<Entity(const std::string& xml)> reader_of_spawned(const Additions& additions,
                                                                const Scene& scene, OpenFile open);

/// A scene, and what is needed to add elements to it.
struct OpenScene {
  Scene scene;
  Additions additions;
};

/// The folder that paths in an element are relative to: that of the file it is written in; for an
/// element that was added, that of the scene file.
std::filesystem::path folder_of(const Scene& scene, const Location& where);

/// The name of the file of a location, in a scene or in an element that was added to it.
std::string file_of(const Scene& scene, const Location& where);

}  // namespace ziggurat::scene
