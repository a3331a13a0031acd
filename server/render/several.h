// SPDX-License-Identifier: MIT
#pragma once
// Pictures of several states on several threads, each with a renderer of its own.

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "render/renderer.h"

namespace ziggurat::render {

/// Pictures are those of a Renderer, bit by bit. They are given away in the order in which they
/// were asked for, whatever the number of threads.
class Several {
 public:
  using Take = std::function<void(const Picture& picture)>;

  /// @param scene, entities, layout  as of a Renderer; are copied
  /// @throws std::system_error if the system allows no more threads
  Several(const scene::Scene& scene, std::vector<scene::Entity> entities, world::Layout layout,
          unsigned threads);
  /// Pictures that were not begun are not drawn.
  ~Several();
  Several(const Several&) = delete;
  Several& operator=(const Several&) = delete;

  /// Waits while as many pictures as there are threads wait for one.
  /// @param rays  that are drawn instead of those of the state
  /// @param take  gets the picture, on a thread of these, one at a time
  /// @throws once what drawing an earlier picture or an earlier take() threw; none is taken after
  /// that
  void draw(const world::State& state, std::span<const world::Ray> rays, const View& view,
            Take take);

  /// Waits until all pictures were taken. @throws as draw()
  void finish();

 private:
  struct Job {
    std::uint64_t number = 0;
    world::State state;
    View view;
    Take take;
  };
  void work(Renderer renderer);
  void do_job(Job& job, Renderer& renderer, Picture& picture);
  void end();
  void rethrow();

  const world::Layout layout_;
  std::mutex mutex_;  // of all below
  std::condition_variable news_;
  std::deque<Job> waiting_;
  std::vector<Job> spare_;  // their memory is used again
  std::uint64_t next_ = 0, taken_ = 0;
  bool is_over_ = false;
  std::exception_ptr failure_;  // not thrown yet
  bool has_failed_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace ziggurat::render
